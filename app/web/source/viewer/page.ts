import type { Corner } from "./camera.ts";
import { HELP } from "./keyboard.ts";
import { DARK, STILL } from "./options.ts";
import { STYLES } from "./styles.ts";

/** What the element is made of. */
export interface Parts {
  stage: HTMLElement;
  canvas: HTMLCanvasElement;
  labels: HTMLElement;
  progress: HTMLElement;
  status: HTMLElement;
  toolbar: HTMLElement;
  list: HTMLElement;
  live: HTMLElement;
}

/** Fills the element's shadow tree. */
export function build(shadow: ShadowRoot): Parts {
  const sheet = new CSSStyleSheet();
  sheet.replaceSync(STYLES);
  shadow.adoptedStyleSheets = [sheet];
  const canvas = make("canvas", { "aria-hidden": "true" });
  const labels = make("div", { id: "labels", part: "labels", "aria-hidden": "true" });
  const stage = make("div", {
    id: "stage",
    part: "stage",
    role: "application",
    "aria-roledescription": "3D picture",
    "aria-label": "Tubeloom",
    "aria-describedby": "help",
    tabindex: "0",
  });
  stage.append(canvas, labels);
  const progress = make("div", { id: "progress", role: "progressbar", "aria-label": "Loading" });
  const status = make("div", { id: "status", part: "status", role: "status" });
  const toolbar = make("div", {
    id: "toolbar",
    part: "toolbar",
    role: "toolbar",
    "aria-label": "Picture",
  });
  for (const each of [progress, status, toolbar]) each.hidden = true;
  const list = make("div", { id: "list", part: "list", role: "listbox", tabindex: "0" });
  const help = make("p", { id: "help", class: "unseen" });
  help.textContent = HELP;
  const live = make("p", { id: "live", class: "unseen", "aria-live": "polite" });
  shadow.replaceChildren(stage, progress, status, toolbar, list, help, live);
  return { stage, canvas, labels, progress, status, toolbar, list, live };
}

/** What of the picture is under the toolbar. */
export function coveredBy({ toolbar, canvas }: Parts): Corner | undefined {
  if (toolbar.hidden || canvas.clientHeight === 0) return undefined;
  const bottom = toolbar.offsetTop + toolbar.offsetHeight;
  return { left: toolbar.offsetLeft / canvas.clientWidth, bottom: bottom / canvas.clientHeight };
}

/** Tells of another size, and of other preferences of whoever looks, until `signal` is aborted. */
export function surroundings(element: Element, signal: AbortSignal, resized: () => void, preferred: () => void): void {
  const sizes = new ResizeObserver(resized);
  sizes.observe(element);
  signal.addEventListener("abort", () => sizes.disconnect());
  for (const preference of [STILL, DARK]) matchMedia(preference).addEventListener("change", preferred, { signal });
}

function make<Tag extends "div" | "p" | "canvas">(
  tag: Tag,
  attributes: Record<string, string>,
): HTMLElementTagNameMap[Tag] {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  return made;
}
