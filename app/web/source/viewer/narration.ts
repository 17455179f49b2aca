import type { Scene } from "./scene.ts";
import { describe, keyOf, titleOf, type Thing, type ThingKey } from "./things.ts";

/** Asked when somebody goes through the list by keyboard. */
export interface Listener {
  /** This one is looked at now; undefined: none. */
  highlight(key: ThingKey | undefined): void;
  /** This one is chosen; undefined: nothing is any more. */
  choose(key: ThingKey | undefined, isMore: boolean): void;
}

/**
 * The picture as a list, for ears and for the keyboard: hyperedges, then items. However many there
 * are, only the one that is spoken of is in the page.
 */
export class Narration {
  readonly #scene: Scene;
  readonly #list: HTMLElement;
  readonly #option: HTMLElement;
  readonly #live: HTMLElement;
  readonly #listener: Listener;
  #order: Thing[] = [];
  #at = 0;
  #selected: ReadonlySet<ThingKey> = new Set();
  #typed = "";
  #typedAt = 0;

  constructor(scene: Scene, list: HTMLElement, live: HTMLElement, listener: Listener) {
    this.#scene = scene;
    this.#list = list;
    this.#live = live;
    this.#listener = listener;
    this.#option = document.createElement("div");
    this.#option.id = "option";
    this.#option.setAttribute("role", "option");
    list.append(this.#option);
    list.addEventListener("keydown", this.#onKey);
    list.addEventListener("focus", () => this.#go(this.#at));
    list.addEventListener("blur", () => listener.highlight(undefined));
  }

  /** Another scene, or another state of it, is shown. */
  refresh(): void {
    const before = this.#order[this.#at];
    const all = [...this.#scene.things.values()];
    const hyperedges = all.filter(({ shows }) => shows === "hyperedge");
    const items = all.filter(({ shows }) => shows === "item");
    this.#order = [...hyperedges, ...items];
    const found = before ? this.#order.findIndex((each) => keyOf(each) === keyOf(before)) : 0;
    this.#at = Math.max(found, 0);
    const count = `${plural(hyperedges.length, "hyperedge")} and ${plural(items.length, "item")}`;
    this.#list.setAttribute("aria-label", `In this picture: ${count}`);
    this.#list.hidden = this.#order.length === 0;
    this.#tell();
  }

  set selected(keys: ReadonlySet<ThingKey>) {
    this.#selected = keys;
    this.#tell();
  }

  /** Have a sentence read out. */
  say(sentence: string): void {
    this.#live.textContent = sentence;
  }

  sentenceOf(key: ThingKey): string {
    const thing = this.#scene.things.get(key);
    return thing ? describe(thing, this.#scene.titleOfItem) : "";
  }

  #onKey = (event: KeyboardEvent): void => {
    const last = this.#order.length - 1;
    const steps: Record<string, number> = {
      ArrowDown: Math.min(this.#at + 1, last),
      ArrowRight: Math.min(this.#at + 1, last),
      ArrowUp: Math.max(this.#at - 1, 0),
      ArrowLeft: Math.max(this.#at - 1, 0),
      PageDown: Math.min(this.#at + 10, last),
      PageUp: Math.max(this.#at - 10, 0),
      Home: 0,
      End: last,
    };
    const step = steps[event.key];
    const thing = this.#order[this.#at];
    if (step !== undefined) this.#go(step);
    else if (event.key === "Escape") this.#listener.choose(undefined, false);
    else if ((event.key === "Enter" || event.key === " ") && thing) {
      this.#listener.choose(keyOf(thing), event.shiftKey || event.ctrlKey || event.metaKey);
    } else if (event.key.length === 1 && !event.ctrlKey && !event.metaKey) this.#search(event.key);
    else return;
    event.preventDefault();
    event.stopPropagation();
  };

  #go(place: number): void {
    this.#at = place;
    const thing = this.#order[place];
    this.#tell();
    if (thing) this.#listener.highlight(keyOf(thing));
  }

  /** To the next thing whose name begins with the letters that were typed just now. */
  #search(letter: string): void {
    const now = performance.now();
    this.#typed = now - this.#typedAt < 800 ? this.#typed + letter : letter;
    this.#typedAt = now;
    const wanted = this.#typed.toLowerCase();
    const first = this.#typed.length === 1 ? this.#at + 1 : this.#at;
    for (let step = 0; step < this.#order.length; step += 1) {
      const place = (first + step) % this.#order.length;
      const thing = this.#order[place];
      if (thing && titleOf(thing).toLowerCase().startsWith(wanted)) {
        this.#go(place);
        return;
      }
    }
  }

  #tell(): void {
    const thing = this.#order[this.#at];
    if (thing === undefined) {
      this.#list.removeAttribute("aria-activedescendant");
      this.#option.textContent = "";
      return;
    }
    this.#list.setAttribute("aria-activedescendant", "option");
    this.#option.textContent = describe(thing, this.#scene.titleOfItem);
    this.#option.setAttribute("aria-posinset", String(this.#at + 1));
    this.#option.setAttribute("aria-setsize", String(this.#order.length));
    this.#option.setAttribute("aria-selected", String(this.#selected.has(keyOf(thing))));
  }
}

function plural(count: number, word: string): string {
  return `${count === 0 ? "no" : count} ${word}${count === 1 ? "" : "s"}`;
}
