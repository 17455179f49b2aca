import type { Status } from "./events.ts";
import type { Parts } from "./page.ts";

export const NO_WEBGL = "This browser does not show 3D pictures: WebGL 2 is missing or switched off.";

/** How things stand, over the picture and as an attribute that pages can go by. */
export class StatusNote {
  readonly #host: HTMLElement;
  readonly #parts: Parts;
  readonly #told: (status: Status, detail: string) => void;
  #status: Status = "empty";

  constructor(host: HTMLElement, parts: Parts, told: (status: Status, detail: string) => void) {
    [this.#host, this.#parts, this.#told] = [host, parts, told];
  }

  get status(): Status {
    return this.#status;
  }

  tell(status: Status, detail: string): void {
    const { progress, status: note } = this.#parts;
    progress.hidden = status !== "loading";
    note.hidden = detail === "";
    if (note.textContent !== detail) note.textContent = detail;
    if (status === this.#status && status !== "refused") return;
    this.#status = status;
    this.#host.dataset["status"] = status;
    this.#told(status, detail);
  }
}
