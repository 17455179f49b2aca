import { EventReader, type ServerEvent } from "./events.js";
import { Problem, problemOf } from "./problems.js";

/** What a call sends. */
export interface Call {
  method: string;
  path: string;
  query?: Readonly<Record<string, unknown>> | undefined;
  headers?: Record<string, string> | undefined;
  body?: string | Uint8Array<ArrayBuffer> | undefined;
  signal?: AbortSignal | undefined;
}

/** How to reach the service. */
export interface ConnectionOptions {
  /** An API key, where the service wants one. */
  key?: string;
  /** Seconds to try again where nobody answers, or where the service is busy and says so. */
  patience?: number;
}

const FIRST_PAUSE_SECONDS = 0.1;
const LONGEST_PAUSE_SECONDS = 5;
/** The service says something every ten seconds; a stream that does not is broken. */
const SILENCE_SECONDS = 30;

/** Sends calls, and sends them again where that may help. */
export class Connection {
  readonly #url: string;
  readonly #key: string | undefined;
  readonly #patience: number;

  constructor(url: string, options: ConnectionOptions = {}) {
    this.#url = new URL(url).href.replace(/\/+$/, "");
    this.#key = options.key;
    this.#patience = options.patience ?? 30;
  }

  /** The response to `call`, which is a success; otherwise throws `Problem`. */
  async send(call: Call): Promise<Response> {
    const patience = new Patience(this.#patience);
    for (;;) {
      try {
        return await this.#once(call);
      } catch (error) {
        await patience.after(error, call.signal);
      }
    }
  }

  /** Server-sent events, those after the one with the id `after`; goes on by itself. */
  async *events(path: string, after?: string, signal?: AbortSignal): AsyncGenerator<ServerEvent> {
    const patience = new Patience(this.#patience);
    const reader = new EventReader(after);
    for (;;) {
      try {
        for await (const events of this.#stream(path, reader, signal)) {
          patience.takeHeart();
          for (const event of events) {
            patience.restore();
            yield event;
          }
        }
        throw new TypeError("The stream of events has ended.");
      } catch (error) {
        reader.interrupted();
        await patience.after(error, signal);
      }
    }
  }

  async #once(call: Call): Promise<Response> {
    const response = await fetch(this.#url + call.path + queryOf(call.query ?? {}), {
      method: call.method,
      headers: { ...this.#authorization(), ...call.headers },
      body: call.body ?? null,
      signal: call.signal ?? null,
    });
    if (!response.ok) throw await problemOf(response);
    return response;
  }

  async *#stream(
    path: string,
    reader: EventReader,
    signal: AbortSignal | undefined,
  ): AsyncGenerator<Iterable<ServerEvent>> {
    const silence = new AbortController();
    const stop = () => silence.abort(signal?.reason);
    signal?.addEventListener("abort", stop);
    signal?.throwIfAborted();
    let timer = setTimeout(stop, SILENCE_SECONDS * 1000);
    try {
      const headers: Record<string, string> = { Accept: "text/event-stream" };
      if (reader.lastId !== undefined) headers["Last-Event-ID"] = reader.lastId;
      const response = await this.#once({ method: "GET", path, headers, signal: silence.signal });
      const decoder = new TextDecoder();
      for await (const piece of piecesOf(response)) {
        clearTimeout(timer);
        timer = setTimeout(stop, SILENCE_SECONDS * 1000);
        yield reader.feed(decoder.decode(piece, { stream: true }));
      }
    } finally {
      clearTimeout(timer);
      signal?.removeEventListener("abort", stop);
      stop();
    }
  }

  #authorization(): Record<string, string> {
    return this.#key === undefined ? {} : { Authorization: `Bearer ${this.#key}` };
  }
}

/** So many seconds to try again; pauses double, unless the service says how long to wait. */
class Patience {
  readonly #seconds: number;
  #end: number | undefined;
  #pause = FIRST_PAUSE_SECONDS;

  constructor(seconds: number) {
    this.#seconds = seconds;
  }

  /** Start anew: something has gone well. */
  restore(): void {
    this.takeHeart();
    this.#pause = FIRST_PAUSE_SECONDS;
  }

  /** Be as patient as in the beginning: somebody has answered, if only that. */
  takeHeart(): void {
    this.#end = undefined;
  }

  /** Waits before the next try; throws `error` where patience has run out or waiting is of no use. */
  async after(error: unknown, signal: AbortSignal | undefined): Promise<void> {
    signal?.throwIfAborted();
    const now = performance.now() / 1000;
    this.#end ??= now + this.#seconds;
    let wait = this.#pause;
    if (error instanceof Problem) {
      if (error.retryAfter === undefined) throw error;
      wait = error.retryAfter;
    } else if (!isBroken(error)) {
      throw error;
    } else {
      this.#pause = Math.min(2 * this.#pause, LONGEST_PAUSE_SECONDS);
    }
    if (now + wait > this.#end) throw error;
    await new Promise((resolve) => setTimeout(resolve, wait * 1000));
  }
}

/**
 * A header that lets a call whose answer got lost be sent again without being done twice. Pages
 * that do not come over TLS have no `randomUUID`.
 */
export function once(): Record<string, string> {
  const bytes = [...crypto.getRandomValues(new Uint8Array(16))];
  return { "Idempotency-Key": bytes.map((byte) => byte.toString(16).padStart(2, "0")).join("") };
}

/** Whether there was no answer, or not a whole one: so `fetch` tells it. */
function isBroken(error: unknown): boolean {
  return error instanceof TypeError || (error instanceof DOMException && error.name === "AbortError");
}

/** A response's body, piece by piece; browsers cannot iterate over it everywhere yet. */
async function* piecesOf(response: Response): AsyncGenerator<Uint8Array> {
  const reader = response.body?.getReader();
  if (!reader) return;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) return;
    yield value;
  }
}

function queryOf(parameters: Readonly<Record<string, unknown>>): string {
  const query = new URLSearchParams();
  for (const [name, value] of Object.entries(parameters)) {
    for (const each of Array.isArray(value) ? value : [value]) {
      if (each !== undefined && each !== null) query.append(name, String(each));
    }
  }
  const text = query.toString();
  return text && `?${text}`;
}
