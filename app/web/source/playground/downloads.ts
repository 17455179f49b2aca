import { fileOf } from "./curl.ts";
import { make, say } from "./page.ts";
import { AS_JSON, formats, service, troubleOf } from "./service.ts";
import { sizeOf } from "./verdict.ts";

/** What is to be had now. */
export interface Wanted {
  text: string;
  name: unknown;
  /** The query of a picture as one sees it, or would. */
  picture: string;
}

interface Format {
  name: string;
  title: string;
  url: string | undefined;
  ending: string;
}

/** A list of all formats that the service writes, each a button. */
export class Downloads {
  readonly #host: HTMLElement;
  readonly #wanted: () => Wanted;
  readonly #trouble = make("p", { className: "trouble" });
  #isListed = false;

  constructor(host: HTMLElement, wanted: () => Wanted) {
    this.#host = host;
    this.#wanted = wanted;
    this.#trouble.setAttribute("role", "alert");
    host.addEventListener("beforetoggle", () => void this.list());
  }

  /** Ask the service what it writes. */
  async list(): Promise<void> {
    if (this.#isListed) return;
    this.#isListed = true;
    try {
      const { documents, scenes } = await formats();
      const written = documents.filter(({ writes }) => writes);
      this.#host.replaceChildren(
        section("Picture and scene", scenes.map(({ name, title }) => this.#button({ name, title, url: `/v1/render?format=${name}`, ending: name }))),
        section("Document", written.map(({ name, title }) => this.#button({ name, title, ...documentOf(name) }))),
        this.#trouble,
      );
    } catch (error) {
      this.#isListed = false;
      this.#trouble.textContent = troubleOf(error) ?? "";
      this.#host.replaceChildren(this.#trouble);
    }
  }

  #button(format: Format): HTMLButtonElement {
    const note = make("span", { className: "note", text: `.${format.ending}` });
    const button = make("button", {}, make("span", { text: format.title }), note);
    button.type = "button";
    // The button is called as the format is; how large a file was is said when it is there.
    note.setAttribute("aria-hidden", "true");
    button.addEventListener("click", () => void this.#save(format, button, note));
    return button;
  }

  async #save(format: Format, button: HTMLButtonElement, note: HTMLElement): Promise<void> {
    if (button.getAttribute("aria-busy") === "true") return;
    const { text, name, picture } = this.#wanted();
    this.#trouble.textContent = "";
    button.setAttribute("aria-busy", "true");
    say(`${format.title} is being made.`);
    try {
      const made = format.url === undefined ? new Blob([text]) : await this.#made(format, text, picture);
      offer(made, fileOf(name, format.ending));
      note.textContent = sizeOf(made.size);
      say(`${format.title} is there: ${sizeOf(made.size)}.`);
    } catch (error) {
      this.#trouble.textContent = `${format.title}: ${troubleOf(error) ?? "called off"}`;
    } finally {
      button.removeAttribute("aria-busy");
    }
  }

  async #made({ name, url }: Format, text: string, picture: string): Promise<Blob> {
    const asked = name === "png" ? `/v1/render?${picture}` : (url ?? "");
    const response = await service.ask(asked, { method: "POST", body: text, headers: AS_JSON });
    return response.blob();
  }
}

/** The program is there already; others are made of it. */
function documentOf(name: string): Pick<Format, "url" | "ending"> {
  if (name === "tubeloom") return { url: undefined, ending: "json" };
  return { url: `/v1/convert?to=${name}`, ending: `${name}.json` };
}

function section(title: string, buttons: HTMLElement[]): HTMLElement {
  const made = make("div", { className: "section" }, make("h2", { text: title }), ...buttons);
  made.setAttribute("role", "group");
  made.setAttribute("aria-label", title);
  return made;
}

function offer(blob: Blob, name: string): void {
  const link = make("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
