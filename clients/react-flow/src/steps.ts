/** Which revisions belong together: what was one change to whoever made it is undone at once. */
export class Steps {
  #done: number[] = [];
  #undone: number[] = [];
  #last: number | undefined;

  /** A revision was made, as a part of the change of this number. */
  made(change: number): void {
    this.#undone = [];
    const count = this.#done.at(-1);
    if (change === this.#last && count !== undefined) this.#done.splice(-1, 1, count + 1);
    else this.#done.push(1);
    this.#last = change;
  }

  /** How many revisions the next step takes back, or makes again. */
  count(step: "undo" | "redo"): number {
    return (step === "undo" ? this.#done : this.#undone).at(-1) ?? 1;
  }

  /** A step was taken, of so many revisions. */
  taken(step: "undo" | "redo", count: number): void {
    const [from, to] = step === "undo" ? [this.#done, this.#undone] : [this.#undone, this.#done];
    from.pop();
    if (count > 0) to.push(count);
    this.#last = undefined;
  }

  /** Others have made revisions too: each is a step of its own. */
  forget(): void {
    this.#done = [];
    this.#undone = [];
    this.#last = undefined;
  }
}
