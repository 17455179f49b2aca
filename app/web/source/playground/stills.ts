import { Refusal, type ProblemDetails } from "../viewer/loading.ts";
import { AS_JSON, service, troubleOf } from "./service.ts";
import { eventsOf } from "./stream.ts";

/** How the picture is made: in the browser, or by the service. */
export type Quality = "interactive" | "draft" | "final";

/** The elements that show a picture and its making. */
export interface StillParts {
  image: HTMLImageElement;
  drawing: HTMLElement;
  doing: HTMLElement;
  share: HTMLProgressElement;
  cancel: HTMLButtonElement;
  again: HTMLButtonElement;
}

const UNHURRIED_MILLISECONDS = 300;

/** Pictures that the service draws, over the one that people can turn. */
export class Stills {
  readonly #parts: StillParts;
  readonly #told: (text: string | undefined) => void;
  #quality: Quality = "interactive";
  #work = new AbortController();
  #address: string | undefined;

  /** `told` hears of trouble, and of its end; `redraw` is asked for by a button. */
  constructor(parts: StillParts, redraw: () => void, told: (text: string | undefined) => void) {
    this.#parts = parts;
    this.#told = told;
    parts.cancel.addEventListener("click", () => {
      this.#work.abort();
      this.#rest("Cancelled");
      parts.again.focus();
    });
    parts.again.addEventListener("click", redraw);
  }

  get quality(): Quality {
    return this.#quality;
  }

  set quality(quality: Quality) {
    this.#quality = quality;
    if (quality !== "interactive") return;
    this.#work.abort();
    this.#parts.drawing.hidden = true;
    this.#show(undefined);
  }

  /** The query of the picture at this size, in CSS pixels. */
  query(width: number, height: number): string {
    const ratio = this.#quality === "final" ? 1 : Math.min(devicePixelRatio, 2);
    const size = `width=${Math.round(width * ratio)}&height=${Math.round(height * ratio)}`;
    return this.#quality === "interactive" ? `format=glb&${size}` : `format=png&quality=${this.#quality}&${size}`;
  }

  /** Draw this document anew. What is being drawn is given up. */
  async draw(document: string, width: number, height: number): Promise<void> {
    this.#work.abort();
    if (this.#quality === "interactive") return;
    const { signal } = (this.#work = new AbortController());
    const url = `/v1/render?${this.query(width, height)}`;
    const init = { method: "POST", body: document, signal };
    try {
      if (this.#quality === "draft") {
        const slow = setTimeout(() => this.#begin("Drawing"), UNHURRIED_MILLISECONDS);
        signal.addEventListener("abort", () => clearTimeout(slow));
        const response = await service.ask(url, { ...init, headers: AS_JSON }).finally(() => clearTimeout(slow));
        this.#show(await response.blob());
      } else {
        await this.#trace(url, init);
      }
      signal.throwIfAborted();
      this.#parts.drawing.hidden = true;
      this.#told(undefined);
    } catch (error) {
      if (signal.aborted) return;
      this.#rest("Not drawn");
      // What is wrong with the text is told beside the text.
      const isOfText = error instanceof Refusal && error.problem.errors !== undefined && error.problem.status < 500;
      this.#told(isOfText ? undefined : troubleOf(error));
    }
  }

  async #trace(url: string, init: RequestInit): Promise<void> {
    this.#begin("Waiting");
    const response = await service.ask(url, { ...init, headers: { ...AS_JSON, Accept: "text/event-stream" } });
    for await (const { name, data } of eventsOf(response)) {
      init.signal?.throwIfAborted();
      if (name === "progress") {
        const { stage, share } = JSON.parse(data) as { stage: string; share: number };
        this.#tell(stage, share);
      } else if (name === "preview" || name === "answer") {
        const { media_type: type, base64 } = JSON.parse(data) as { media_type: string; base64: string };
        this.#show(new Blob([Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0))], { type }));
        if (name === "answer") return;
      } else if (name === "problem") {
        throw new Refusal(JSON.parse(data) as ProblemDetails);
      }
    }
    throw new Error("The service has broken off.");
  }

  #begin(doing: string): void {
    this.#parts.drawing.hidden = false;
    this.#parts.cancel.hidden = false;
    this.#parts.again.hidden = true;
    this.#parts.share.hidden = false;
    this.#parts.share.removeAttribute("value");
    this.#parts.doing.textContent = doing;
  }

  #tell(stage: string, share: number): void {
    this.#parts.share.value = share;
    const name = stage.charAt(0).toUpperCase() + stage.slice(1);
    this.#parts.doing.textContent = `${name}, ${Math.round(share * 100)} %`;
  }

  #rest(doing: string): void {
    this.#begin(doing);
    this.#parts.share.hidden = true;
    this.#parts.cancel.hidden = true;
    this.#parts.again.hidden = false;
  }

  #show(picture: Blob | undefined): void {
    const before = this.#address;
    this.#address = picture && URL.createObjectURL(picture);
    this.#parts.image.hidden = picture === undefined;
    if (this.#address) this.#parts.image.src = this.#address;
    else this.#parts.image.removeAttribute("src");
    if (before) setTimeout(() => URL.revokeObjectURL(before), 1000);
  }
}
