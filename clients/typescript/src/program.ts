import { once, type Connection } from "./connection.js";
import type { components } from "./schema.js";
import {
  bodyOf,
  JSON_TYPE,
  type Document,
  type Edit,
  type Layout,
  type ProgramDocument,
  type StoredRenderOptions,
} from "./types.js";

/** One state of a stored program, and what led to it. */
export type Revision = components["schemas"]["RevisionModel"];

/**
 * What a watcher of a program hears. `current`: watching begins. `reset`: some revisions are not
 * kept any more, so load the program anew. `deleted` is the last.
 */
export type Happening =
  | { kind: "current" | "reset" | "deleted"; revision: number }
  | ({ kind: "revision" } & Revision);

const KINDS: readonly string[] = ["current", "revision", "reset", "deleted"];

/**
 * The stored program called `id`.
 *
 * `etag` is the revision that was last seen here: every change is made only if the program is still
 * as it was then, and throws a `Problem` of status 412 otherwise. Undefined makes changes without
 * condition.
 */
export class Program {
  readonly id: string;
  etag: string | undefined;
  readonly #connection: Connection;
  readonly #path: string;

  constructor(connection: Connection, id: string) {
    this.#connection = connection;
    this.id = id;
    this.#path = `/v1/programs/${encodeURIComponent(id)}`;
  }

  /** The document; of an older revision, if that is still kept. */
  async get(options: { revision?: number } = {}): Promise<ProgramDocument> {
    const response = await this.#connection.send({ method: "GET", path: this.#path, query: options });
    if (options.revision === undefined) this.#see(response);
    return (await response.json()) as ProgramDocument;
  }

  /** Store `document`, in place of what there was. */
  put(document: Document): Promise<Revision> {
    return this.#change("PUT", "", document, JSON_TYPE);
  }

  /** Store `document`, unless there is such a program: that throws a `Problem` of status 412. */
  create(document: Document): Promise<Revision> {
    this.etag = undefined;
    return this.#change("PUT", "", document, { ...JSON_TYPE, "If-None-Match": "*" });
  }

  /** Carry out edits, all or none; what they do not concern stays where it is. */
  edit(...edits: Edit[]): Promise<Revision> {
    return this.#change("POST", "/edits", { edits }, JSON_TYPE);
  }

  /** Carry out edits that are one change to undo with the edits before, such as each step of a drag. */
  amend(...edits: Edit[]): Promise<Revision> {
    return this.#change("POST", "/edits?amend=true", { edits }, JSON_TYPE);
  }

  /** Change the document by a JSON Patch (an array) or a JSON Merge Patch (anything else). */
  patch(change: readonly object[] | Record<string, unknown>): Promise<Revision> {
    const kind = Array.isArray(change) ? "json-patch" : "merge-patch";
    return this.#change("PATCH", "", change, { "Content-Type": `application/${kind}+json` });
  }

  /** Take the last change back. */
  undo(): Promise<Revision> {
    return this.#change("POST", "/undo");
  }

  /** Make a change again that was taken back. */
  redo(): Promise<Revision> {
    return this.#change("POST", "/redo");
  }

  /** Remove the program. */
  async delete(): Promise<void> {
    const headers = this.#conditions();
    await this.#connection.send({ method: "DELETE", path: this.#path, headers });
    this.etag = undefined;
  }

  /** The revisions that are kept, the newest first. */
  async revisions(): Promise<readonly Revision[]> {
    const path = `${this.#path}/revisions`;
    const response = await this.#connection.send({ method: "GET", path });
    return ((await response.json()) as components["schemas"]["RevisionList"]).revisions;
  }

  /** The scene; with `since`, as glTF of only what has changed after that revision. */
  async render(
    options: StoredRenderOptions = {},
    signal?: AbortSignal,
  ): Promise<Uint8Array<ArrayBuffer>> {
    const call = { method: "GET", path: `${this.#path}/render`, query: options, signal };
    const response = await this.#connection.send(call);
    return new Uint8Array(await response.arrayBuffer());
  }

  /** The numbers of the layout. */
  async layout(options: { patches?: boolean; revision?: number } = {}): Promise<Layout> {
    const call = { method: "GET", path: `${this.#path}/layout`, query: options };
    return (await (await this.#connection.send(call)).json()) as Layout;
  }

  /**
   * What happens to the program: from now on, after an event `current`, or from what came after a
   * revision. Goes on by itself where the connection breaks, without missing a revision; ends when
   * the program is deleted. An abort of `signal` throws its reason.
   */
  async *watch(
    options: { after?: number; signal?: AbortSignal } = {},
  ): AsyncGenerator<Happening, void, undefined> {
    const after = options.after?.toString();
    const events = this.#connection.events(`${this.#path}/events`, after, options.signal);
    for await (const { name, data } of events) {
      if (!KINDS.includes(name)) continue;
      yield { kind: name, ...(data as object) } as Happening;
      if (name === "deleted") return;
    }
  }

  async #change(
    method: string,
    part: string,
    body?: Document | object,
    headers: Record<string, string> = {},
  ): Promise<Revision> {
    const response = await this.#connection.send({
      method,
      path: this.#path + part,
      headers: { ...headers, ...this.#conditions() },
      body: body === undefined ? undefined : bodyOf(body),
    });
    this.#see(response);
    return (await response.json()) as Revision;
  }

  /** The revision that is meant; and that it be changed once, even if it is asked twice. */
  #conditions(): Record<string, string> {
    return this.etag === undefined ? once() : { ...once(), "If-Match": this.etag };
  }

  #see(response: Response): void {
    this.etag = response.headers.get("etag") ?? undefined;
  }
}
