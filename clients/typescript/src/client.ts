import { Connection, once, type ConnectionOptions } from "./connection.js";
import { Job, type JobState } from "./job.js";
import { Program } from "./program.js";
import { bodyOf, JSON_TYPE, type Document, type Layout, type RenderOptions } from "./types.js";

/** A client of the service at `url`. */
export class Client {
  readonly #connection: Connection;

  constructor(url = "http://127.0.0.1:8000", options: ConnectionOptions = {}) {
    this.#connection = new Connection(url, options);
  }

  /** The scene of `document` as a file; without a format, glTF. */
  async render(
    document: Document,
    options: RenderOptions = {},
    signal?: AbortSignal,
  ): Promise<Uint8Array<ArrayBuffer>> {
    const body = bodyOf(document);
    const call = { method: "POST", path: "/v1/render", headers: JSON_TYPE, body, signal };
    const response = await this.#connection.send({ ...call, query: options });
    return new Uint8Array(await response.arrayBuffer());
  }

  /** The numbers: where items stand, and the control points of every hyperedge's curves. */
  async layout(
    document: Document,
    options: { from?: RenderOptions["from"]; patches?: boolean } = {},
    signal?: AbortSignal,
  ): Promise<Layout> {
    const body = bodyOf(document);
    const call = { method: "POST", path: "/v1/layout", headers: JSON_TYPE, body, signal };
    const response = await this.#connection.send({ ...call, query: options });
    return (await response.json()) as Layout;
  }

  /** The stored program of this name, which need not exist yet. Nothing is sent. */
  program(id: string): Program {
    return new Program(this.#connection, id);
  }

  /** The job of this name. Nothing is sent. */
  job(id: string): Job {
    return new Job(this.#connection, id);
  }

  /** Make a job of a render, and do not wait for it. */
  async start(document: Document, options: RenderOptions = {}): Promise<Job> {
    const headers = { ...JSON_TYPE, ...once() };
    const body = bodyOf(document);
    const call = { method: "POST", path: "/v1/jobs", query: options, headers, body };
    const { id } = (await (await this.#connection.send(call)).json()) as JobState;
    return this.job(id);
  }

  /**
   * Make a job of a render, and wait for what it makes. `progress` hears how it goes on; an abort
   * of `signal`, or an exception of `progress`, cancels the job.
   */
  async run(
    document: Document,
    options: RenderOptions = {},
    progress?: (state: JobState) => void,
    signal?: AbortSignal,
  ): Promise<Uint8Array<ArrayBuffer>> {
    const job = await this.start(document, options);
    try {
      return await job.wait(progress, signal);
    } catch (error) {
      await job.cancel().catch(() => undefined);
      throw error;
    }
  }
}
