import type { Connection } from "./connection.js";
import { JobCancelled, Problem } from "./problems.js";
import type { components } from "./schema.js";

/** How a job is; `share` goes from 0 to 1, `problem` says why it failed. */
export type JobState = components["schemas"]["JobModel"];

/** The job called `id`. */
export class Job {
  readonly id: string;
  readonly #connection: Connection;
  readonly #path: string;

  constructor(connection: Connection, id: string) {
    this.#connection = connection;
    this.id = id;
    this.#path = `/v1/jobs/${encodeURIComponent(id)}`;
  }

  /** How far it is. */
  async state(signal?: AbortSignal): Promise<JobState> {
    const response = await this.#connection.send({ method: "GET", path: this.#path, signal });
    return (await response.json()) as JobState;
  }

  /** How it goes on, until it is over; goes on by itself where the connection breaks. */
  async *follow(signal?: AbortSignal): AsyncGenerator<JobState> {
    let state = await this.state(signal);
    yield state;
    if (isOver(state)) return;
    for await (const event of this.#connection.events(`${this.#path}/events`, undefined, signal)) {
      if (event.name === "progress") {
        state = { ...state, ...(event.data as Pick<JobState, "stage" | "share">), state: "running" };
      } else if (event.name !== "waiting") {
        state = event.data as JobState;
      }
      yield state;
      if (isOver(state)) return;
    }
  }

  /**
   * What it makes, once it is done; `progress` hears how it goes on. Throws `JobCancelled`, and the
   * job's `Problem` where it fails.
   */
  async wait(
    progress?: (state: JobState) => void,
    signal?: AbortSignal,
  ): Promise<Uint8Array<ArrayBuffer>> {
    for await (const state of this.follow(signal)) {
      progress?.(state);
      if (state.state === "cancelled") throw new JobCancelled(`Job ${this.id} has been cancelled.`);
      if (state.problem) throw new Problem(state.problem);
    }
    return this.result(signal);
  }

  /** What it has made. Throws `Problem` while it is not done. */
  async result(signal?: AbortSignal): Promise<Uint8Array<ArrayBuffer>> {
    const path = `${this.#path}/result`;
    const response = await this.#connection.send({ method: "GET", path, signal });
    return new Uint8Array(await response.arrayBuffer());
  }

  /** End it, and free what it works with. */
  async cancel(): Promise<void> {
    await this.#connection.send({ method: "DELETE", path: this.#path });
  }
}

function isOver(state: JobState): boolean {
  return state.state === "done" || state.state === "failed" || state.state === "cancelled";
}
