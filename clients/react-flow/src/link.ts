import { Problem, type Client, type Program, type ProgramDocument, type Revision } from "tubeloom-client";
import { editsBetween } from "./edits-between.js";
import { isLost, wait } from "./waiting.js";

/**
 * How things stand between an editor and the service. `refused`: the service does not take what was
 * last sent, and `detail` says why; it is tried again with the next change.
 */
export type LinkStatus = "connecting" | "saved" | "sending" | "offline" | "refused";

export interface LinkState {
  status: LinkStatus;
  detail: string;
  revision: number;
  canUndo: boolean;
  canRedo: boolean;
}

/** Who hears of a link. */
export interface LinkListener {
  /** Things stand otherwise. */
  state(state: LinkState): void;
  /** The program is another one than was sent: after undo and redo, or because others changed it. */
  program(program: ProgramDocument): void;
}

/** More are not done as one; then the whole program is sent. */
const MOST_EDITS = 1000;
/** While something is dragged: each sending makes a revision. */
const PAUSE_IN_GESTURE = 60;
const FIRST_PAUSE = 250;
const LONGEST_PAUSE = 4000;

/**
 * Keeps a stored program like an editor's: sends edits, one request at a time, and together what
 * comes meanwhile. What could not be sent is kept and sent later.
 */
export class Link {
  readonly #program: Program;
  readonly #follower: Program;
  readonly #listener: LinkListener;
  readonly #end = new AbortController();
  #state: LinkState = { status: "connecting", detail: "", revision: 0, canUndo: false, canRedo: false };
  #sent: ProgramDocument | undefined;
  #wanted: ProgramDocument | undefined;
  #refused: ProgramDocument | undefined;
  #steps: ("undo" | "redo")[] = [];
  #heard = 0;
  #isRunning = false;
  #isGesture = false;
  /** The number of the change that is wanted. */
  #change = 0;
  /** The number of the change that made the newest revision, if one of ours did. */
  #made: number | undefined;

  /** A client without patience lets the link tell sooner that the service does not answer. */
  constructor(client: Client, id: string, listener: LinkListener) {
    this.#program = client.program(id);
    this.#follower = client.program(id);
    this.#listener = listener;
  }

  get state(): LinkState {
    return this.#state;
  }

  /**
   * Open the program of this id; where there is none, put `otherwise`. Waits as long as it takes.
   * `isNew` spares the question whether there is one, where the id was just made up.
   */
  async open(otherwise: ProgramDocument, isNew = false): Promise<void> {
    let mayExist = !isNew;
    for (let pause = FIRST_PAUSE; !this.#end.signal.aborted; pause = Math.min(2 * pause, LONGEST_PAUSE)) {
      try {
        const [latest] = mayExist ? await this.#revisions() : [];
        if (latest) {
          const program = await this.#program.get();
          this.#take(latest);
          this.#see(program);
        } else {
          const first = this.#wanted ?? otherwise;
          this.#take(await this.#program.create(first));
          this.#sent = first;
          this.#wanted ??= first;
        }
        void this.#listen();
        void this.#run();
        return;
      } catch (error) {
        if (isLost(error)) this.#tell({ status: "offline", detail: "The service does not answer." });
        else if (!(error instanceof Problem) || error.status !== 412) {
          this.#tell({ status: "refused", detail: String(error) });
          return;
        }
        mayExist = true;
      }
      await wait(pause);
    }
  }

  /** Let the stored program become this one. */
  send(program: ProgramDocument): void {
    this.#wanted = program;
    if (!this.#isGesture) this.#change += 1;
    void this.#run();
  }

  /** What is sent from now on, until `endGesture`, is one change to undo. */
  beginGesture(): void {
    this.#isGesture = true;
    this.#change += 1;
  }

  endGesture(): void {
    this.#isGesture = false;
  }

  /** Take the last change back, once all is sent. */
  undo(): void {
    this.#steps.push("undo");
    void this.#run();
  }

  redo(): void {
    this.#steps.push("redo");
    void this.#run();
  }

  /** Nothing is sent or told any more. */
  close(): void {
    this.#end.abort();
  }

  /** One request after another, until there is nothing to do. */
  async #run(): Promise<void> {
    if (this.#isRunning || this.#sent === undefined) return;
    this.#isRunning = true;
    let pause = FIRST_PAUSE;
    while (!this.#end.signal.aborted) {
      const task = this.#next();
      if (task === undefined) break;
      if (this.#state.status !== "offline") this.#tell({ status: "sending", detail: "" });
      try {
        await task();
        pause = FIRST_PAUSE;
        if (this.#state.status === "offline") this.#tell({ status: "sending", detail: "" });
        if (this.#isGesture) await wait(PAUSE_IN_GESTURE);
      } catch (error) {
        if (isLost(error)) {
          this.#tell({ status: "offline", detail: "The service does not answer; your changes are kept." });
          await wait(pause);
          pause = Math.min(2 * pause, LONGEST_PAUSE);
        } else {
          this.#refused = this.#wanted;
          this.#tell({ status: "refused", detail: error instanceof Error ? error.message : String(error) });
        }
      }
    }
    this.#isRunning = false;
    if (this.#state.status !== "refused") this.#tell({ status: "saved" });
  }

  #next(): (() => Promise<void>) | undefined {
    const [sent, wanted] = [this.#sent, this.#wanted];
    if (sent && wanted && wanted !== sent && wanted !== this.#refused) return () => this.#send(sent, wanted);
    const step = this.#steps[0];
    if (step !== undefined) return () => this.#step(step);
    if (this.#heard > this.#state.revision) return () => this.#fetch();
    return undefined;
  }

  async #send(sent: ProgramDocument, wanted: ProgramDocument): Promise<void> {
    const edits = editsBetween(sent, wanted);
    const change = this.#change;
    if (edits.length === 0) {
      this.#sent = wanted;
      return;
    }
    try {
      const whole = edits.length > MOST_EDITS;
      const way = change === this.#made ? "amend" : "edit";
      const revision = await (whole ? this.#program.put(wanted) : this.#program[way](...edits));
      this.#sent = wanted;
      if (revision.revision > this.#state.revision) this.#made = change;
      this.#take(revision);
    } catch (error) {
      if (!(error instanceof Problem)) throw error;
      if (error.status === 404) await this.#putAnew(wanted);
      else if (error.status === 412) await this.#reconcile(sent, wanted, change);
      else throw error;
    }
  }

  /** Somebody was quicker: what they did stays, and ours is done upon it, if that is possible. */
  async #reconcile(sent: ProgramDocument, wanted: ProgramDocument, change: number): Promise<void> {
    const theirs = await this.#program.get();
    const ours = editsBetween(sent, wanted);
    // An answer that got lost: it was ourselves.
    if (editsBetween(theirs, wanted).length === 0) {
      this.#sent = wanted;
      this.#made = change;
      return;
    }
    this.#made = undefined;
    try {
      this.#take(await this.#program.edit(...ours));
      this.#made = change;
      const both = await this.#program.get();
      if (this.#wanted === wanted) this.#see(both);
      else this.#sent = wanted;
    } catch (error) {
      if (!(error instanceof Problem) || isLost(error) || error.status === 412) throw error;
      this.#see(theirs);
      this.#tell({ status: "refused", detail: "Somebody else has changed the same; theirs is shown." });
    }
  }

  async #putAnew(wanted: ProgramDocument): Promise<void> {
    this.#program.etag = undefined;
    this.#made = undefined;
    this.#take(await this.#program.put(wanted));
    this.#sent = wanted;
  }

  async #step(step: "undo" | "redo"): Promise<void> {
    this.#made = undefined;
    try {
      if (step === "undo" ? this.#state.canUndo : this.#state.canRedo) this.#take(await this.#program[step]());
    } catch (error) {
      // Where somebody else's change has come between, it is not ours to take back.
      if (!(error instanceof Problem) || isLost(error)) throw error;
    }
    this.#steps.shift();
    this.#see(await this.#program.get());
  }

  async #fetch(): Promise<void> {
    const heard = this.#heard;
    const [latest] = await this.#revisions();
    const program = await this.#program.get();
    if (latest) this.#take(latest);
    this.#state = { ...this.#state, revision: Math.max(this.#state.revision, heard) };
    this.#made = undefined;
    this.#see(program);
  }

  async #revisions(): Promise<readonly Revision[]> {
    try {
      return await this.#follower.revisions();
    } catch (error) {
      if (error instanceof Problem && error.status === 404) return [];
      throw error;
    }
  }

  /** Hear of what others do. */
  async #listen(): Promise<void> {
    const { signal } = this.#end;
    while (!signal.aborted) {
      try {
        for await (const heard of this.#follower.watch({ after: this.#state.revision, signal })) {
          if (heard.kind === "deleted") return;
          this.#heard = Math.max(this.#heard, heard.revision);
          void this.#run();
        }
      } catch (error) {
        if (!isLost(error)) return;
      }
      await wait(LONGEST_PAUSE / 2);
    }
  }

  /** Take note of a revision. */
  #take({ revision, can_undo, can_redo }: Revision): void {
    this.#tell({ revision: Math.max(revision, this.#state.revision), canUndo: can_undo, canRedo: can_redo });
  }

  /** The service has this program, and so shall the editor. */
  #see(program: ProgramDocument): void {
    this.#sent = this.#wanted = program;
    this.#refused = undefined;
    if (!this.#end.signal.aborted) this.#listener.program(program);
  }

  #tell(news: Partial<LinkState>): void {
    this.#state = { ...this.#state, ...news };
    if (!this.#end.signal.aborted) this.#listener.state(this.#state);
  }
}
