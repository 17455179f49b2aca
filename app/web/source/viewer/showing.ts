import type { Clearance } from "./clearance.ts";
import type { Status } from "./events.ts";
import { follow } from "./following.ts";
import { Asker, Refusal, type Detail, type Loaded, type ProblemDetails } from "./loading.ts";

/** What is to be shown. */
export type Source = { stored: string } | { document: string } | { src: string };

/** Told of what is to be drawn, and of how things stand. */
export interface Screen {
  detail(): Detail;
  whole(loaded: Loaded): void;
  part(loaded: Loaded): void;
  status(status: Status, detail: string): void;
  problem(problem: ProblemDetails): void;
  clearance(clearance: Clearance): void;
}

const RETRY_MILLISECONDS = 1500;
const CLEARANCE_MILLISECONDS = 250;
const AWAY = "The service does not answer. This is the last picture; trying again …";
const DELETED = "The program was deleted; this is the last picture of it.";

/** Fetches what is to be shown, goes on with what changes, and tries again where nobody answers. */
export class Showing {
  readonly asker: Asker;
  /** Whether to ask what is proven of distances. */
  isJudged = false;
  readonly #screen: Screen;
  #work = new AbortController();
  #timer: ReturnType<typeof setTimeout> | undefined;

  constructor(screen: Screen, base: string) {
    this.#screen = screen;
    this.asker = new Asker(base);
  }

  /** Show this, in place of what was shown before. */
  async show(source: Source | undefined): Promise<void> {
    this.end();
    const { signal } = (this.#work = new AbortController());
    if (source === undefined) {
      this.#screen.status("empty", "");
      return;
    }
    this.#screen.status("loading", "");
    try {
      if ("stored" in source) await this.#follow(source.stored, signal);
      else await this.#once(source, signal);
    } catch (error) {
      if (!signal.aborted) this.#fail(error, source, signal);
    }
  }

  /** Ask nothing any more. */
  end(): void {
    this.#work.abort();
    clearTimeout(this.#timer);
  }

  async #once(source: { document: string } | { src: string }, signal: AbortSignal): Promise<void> {
    const loaded = await ("document" in source
      ? this.asker.render(source.document, this.#screen.detail(), signal)
      : this.asker.scene(source.src, signal));
    this.#screen.whole(loaded);
    this.#screen.status("live", "");
    if ("document" in source) this.#judge(source, signal);
  }

  async #follow(id: string, signal: AbortSignal): Promise<void> {
    const screen = this.#screen;
    await follow(
      id,
      this.asker,
      () => screen.detail(),
      {
        whole: (loaded) => {
          screen.whole(loaded);
          this.#judge({ stored: id }, signal);
        },
        part: (loaded) => {
          screen.part(loaded);
          this.#judge({ stored: id }, signal);
        },
        gone: () => screen.status("deleted", DELETED),
        away: () => screen.status("offline", AWAY),
        live: () => screen.status("live", ""),
      },
      signal,
    );
  }

  #fail(error: unknown, source: Source, signal: AbortSignal): void {
    const isRefused = error instanceof Refusal && error.isFinal;
    if (isRefused || !(error instanceof Refusal || error instanceof TypeError)) {
      this.#screen.status("refused", error instanceof Error ? error.message : String(error));
      if (isRefused) this.#screen.problem(error.problem);
      return;
    }
    this.#screen.status("offline", AWAY);
    this.#timer = setTimeout(() => {
      if (!signal.aborted) void this.show(source);
    }, RETRY_MILLISECONDS);
  }

  /** Ask what is proven of distances, once nothing has changed for a moment. */
  #judge(what: { document: string } | { stored: string }, signal: AbortSignal): void {
    clearTimeout(this.#timer);
    if (!this.isJudged) return;
    this.#timer = setTimeout(() => {
      this.asker.layout(what, signal).then(
        ({ clearance }) => {
          if (clearance && !signal.aborted) this.#screen.clearance(clearance);
        },
        // The picture is right without; trouble with the service shows where the picture is asked.
        () => undefined,
      );
    }, CLEARANCE_MILLISECONDS);
  }
}
