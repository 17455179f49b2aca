import "./key.css";
import type { ProblemDetails } from "./viewer/loading.ts";

const KEPT = "tubeloom.key";
const heeding: ((key: string | undefined) => void)[] = [];
let asked: Promise<boolean> | undefined;

/** The API key that the service is asked with, as long as this tab is open. */
export function keyOf(): string | undefined {
  return sessionStorage.getItem(KEPT) || undefined;
}

/** Ask with this key from now on. */
export function keepKey(key: string): void {
  sessionStorage.setItem(KEPT, key.trim());
  for (const act of heeding) act(keyOf());
}

/** Tells of the key that the service is asked with, now and when another one is given. */
export function heedKey(act: (key: string | undefined) => void): void {
  heeding.push(act);
  act(keyOf());
}

/** The header that carries the key. */
export function authorization(): Record<string, string> {
  const key = keyOf();
  return key === undefined ? {} : { Authorization: `Bearer ${key}` };
}

/** Asks whoever is here for a key wherever a viewer on this page is told that one is wanted. */
export function askWhereWanted(): void {
  addEventListener("tube-problem", (event) => {
    const { problem } = (event as CustomEvent<{ problem: ProblemDetails }>).detail;
    if (problem.status === 401) void askForKey();
  });
}

/** Once the service lets this page in, or nobody has a key for it. */
export async function admitted(): Promise<void> {
  for (;;) {
    const response = await fetch("/v1/programs?limit=1", { headers: authorization() }).catch(() => undefined);
    if (response?.status !== 401 || !(await askForKey())) return;
  }
}

/** Ask for a key, and keep it. False where none is given. */
export function askForKey(): Promise<boolean> {
  asked ??= ask().finally(() => (asked = undefined));
  return asked;
}

function ask(): Promise<boolean> {
  const before = keyOf();
  const dialog = document.createElement("dialog");
  dialog.className = "key";
  dialog.setAttribute("aria-labelledby", "key-title");
  dialog.innerHTML = `
    <form method="dialog">
      <h2 id="key-title"></h2>
      <p>It stays in this tab, and is sent to this service alone.</p>
      <label>API key <input type="password" name="key" autocomplete="off" required spellcheck="false" /></label>
      <div class="acts">
        <button type="button">Without</button>
        <button type="submit" value="given">Go on</button>
      </div>
    </form>`;
  const [title, input, without] = [dialog.querySelector("h2"), dialog.querySelector("input"), dialog.querySelector("button")];
  if (title) title.textContent = before ? "The service does not take this key" : "This service wants an API key";
  without?.addEventListener("click", () => dialog.close());
  document.body.append(dialog);
  dialog.showModal();
  return new Promise((resolve) => {
    dialog.addEventListener("close", () => {
      dialog.remove();
      const isGiven = dialog.returnValue === "given";
      if (isGiven && input) keepKey(input.value);
      resolve(isGiven);
    });
  });
}
