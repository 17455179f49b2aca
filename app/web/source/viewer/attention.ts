import type { Emphasis } from "./emphasis.ts";
import type { TubeEvents } from "./events.ts";
import type { Narration } from "./narration.ts";
import type { Scene } from "./scene.ts";
import type { Thing, ThingKey } from "./things.ts";

/** Told of what whoever looks does. */
export interface AttentionListener {
  /** What stands out has changed. */
  changed(): void;
  hovered(detail: TubeEvents["tube-hover"]): void;
  selected(detail: TubeEvents["tube-select"]): void;
}

/** What whoever looks points at, and what they have selected. */
export class Attention {
  readonly #scene: Scene;
  readonly #emphasis: Emphasis;
  readonly #narration: Narration;
  readonly #listener: AttentionListener;

  constructor(scene: Scene, emphasis: Emphasis, narration: Narration, listener: AttentionListener) {
    [this.#scene, this.#emphasis] = [scene, emphasis];
    [this.#narration, this.#listener] = [narration, listener];
  }

  get selection(): Thing[] {
    const found = [...this.#emphasis.selected].map((key) => this.#scene.things.get(key));
    return found.filter((thing) => thing !== undefined);
  }

  /** The pointer or the keyboard is at this one now, or at none. */
  hover(key: ThingKey | undefined): void {
    if (key === this.#emphasis.hovered) return;
    this.#emphasis.hovered = key;
    this.#listener.changed();
    this.#listener.hovered({ thing: key && this.#scene.things.get(key) });
  }

  /** Somebody chooses this one, in place of what was selected or besides it. */
  choose(key: ThingKey | undefined, isMore: boolean): void {
    const chosen = new Set(isMore ? this.#emphasis.selected : []);
    if (key !== undefined && !(isMore && chosen.delete(key))) chosen.add(key);
    this.select(chosen, true);
    const sentence = key === undefined ? "Nothing is selected." : `Selected: ${this.#narration.sentenceOf(key)}`;
    this.#narration.say(sentence);
  }

  /** Select these of what is shown; whether somebody is told. */
  select(wished: Iterable<ThingKey>, isTold: boolean): void {
    const keys = new Set([...wished].filter((key) => this.#scene.things.has(key)));
    const before = this.#emphasis.selected;
    if (keys.size === before.size && [...keys].every((key) => before.has(key))) return;
    this.#emphasis.selected = keys;
    this.#narration.selected = keys;
    this.#listener.changed();
    if (isTold) this.#listener.selected({ things: this.selection });
  }

  /** Another scene is shown: what is not in it any more is not selected either. */
  revise(): void {
    this.select(this.#emphasis.selected, true);
    const { hovered } = this.#emphasis;
    if (hovered !== undefined && !this.#scene.things.has(hovered)) this.hover(undefined);
  }
}
