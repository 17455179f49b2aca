import { Client, Problem, type Happening } from "tubeloom-client";
import { Refusal, type Asker, type Detail, type Loaded } from "./loading.ts";

/** Told of what comes of a stored program, in order. */
export interface Follower {
  /** The whole program, at first or when it must be shown anew. */
  whole(loaded: Loaded): void;
  /** What one or more revisions have changed. */
  part(loaded: Loaded): void;
  /** The program was deleted. */
  gone(): void;
  /** There is no answer; it goes on by itself as soon as there is one. */
  away(): void;
  /** All is shown that is known. */
  live(): void;
}

const FIRST_PAUSE = 250;
const LONGEST_PAUSE = 4000;

/**
 * Shows a stored program and each of its revisions, until `signal` is aborted. Revisions that come
 * while one is loaded are loaded together. Throws what waiting cannot mend.
 */
export async function follow(
  id: string,
  asker: Asker,
  detail: () => Detail,
  follower: Follower,
  signal: AbortSignal,
): Promise<void> {
  let shown: number | undefined;
  let pause = FIRST_PAUSE;
  const options = asker.key === undefined ? {} : { key: asker.key };

  const load = async (since: number | undefined): Promise<void> => {
    const loaded = await asker.stored(id, detail(), since, signal);
    if (loaded.revision !== undefined && shown !== undefined && loaded.revision < shown) return;
    shown = loaded.revision;
    if (loaded.gltf.scene.userData["delta"] === undefined) follower.whole(loaded);
    else follower.part(loaded);
  };

  while (!signal.aborted) {
    try {
      if (shown === undefined) await load(undefined);
      follower.live();
      const program = new Client(asker.base, { ...options, patience: 0 }).program(id);
      const after = shown === undefined ? {} : { after: shown };
      const news = new Latest(program.watch({ ...after, signal }));
      for (let heard = await news.next(); heard; heard = await news.next()) {
        pause = FIRST_PAUSE;
        if (heard.kind === "deleted") {
          follower.gone();
          return;
        }
        if (heard.kind === "reset") await load(undefined);
        else if (heard.revision > (shown ?? 0)) await load(shown);
        follower.live();
      }
    } catch (error) {
      if (signal.aborted) return;
      if (isFinal(error)) throw error;
      follower.away();
    }
    await new Promise((resolve) => setTimeout(resolve, pause));
    pause = Math.min(2 * pause, LONGEST_PAUSE);
  }
}

/** Whether to ask again would be of no use. */
function isFinal(error: unknown): boolean {
  if (error instanceof Refusal) return error.isFinal;
  return error instanceof Problem && error.status < 500 && error.status !== 429;
}

/** What was heard last: what came before it while nobody asked is left out, but for the end. */
class Latest {
  #heard: Happening | undefined;
  #end: { error?: unknown } | undefined;
  #wake: () => void = () => undefined;

  constructor(source: AsyncIterable<Happening>) {
    void this.#listen(source);
  }

  /** Waits for the next; undefined at the end. Throws what broke it. */
  async next(): Promise<Happening | undefined> {
    while (this.#heard === undefined && this.#end === undefined) {
      await new Promise<void>((resolve) => (this.#wake = resolve));
    }
    const heard = this.#heard;
    this.#heard = undefined;
    if (heard !== undefined) return heard;
    if (this.#end && "error" in this.#end) throw this.#end.error;
    return undefined;
  }

  async #listen(source: AsyncIterable<Happening>): Promise<void> {
    try {
      for await (const happening of source) {
        if (this.#heard?.kind !== "reset" || happening.kind === "deleted") this.#heard = happening;
        this.#wake();
      }
      this.#end = {};
    } catch (error) {
      this.#end = { error };
    }
    this.#wake();
  }
}
