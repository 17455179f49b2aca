import type { Diagnostic } from "@codemirror/lint";
import type { Edit } from "jsonc-parser";
import type { Range } from "./places.ts";
import { PlainText } from "./plain-text.ts";

/** What the page does when something happens to the text. */
export interface TextEvents {
  /** The text is another one; `isTyped` unless the page itself has changed it. */
  change(text: string, isTyped: boolean): void;
  /** People have moved the cursor, or cursors. */
  cursor(offsets: number[]): void;
}

/** Where somebody is in a text, to go on from there. */
export interface Standing {
  range: Range;
  isFocused: boolean;
  /** How far it is scrolled, in pixels. */
  top: number;
}

/** What holds the text. */
export interface TextBox {
  /** Setting it puts another text in place of this one. */
  text: string;
  readonly cursors: number[];
  set isDark(isDark: boolean);
  /** Change some places of the text, as if they had been typed. */
  apply(edits: readonly Edit[]): void;
  /** Select these stretches, the last one foremost, and show it. The focus stays where it is. */
  select(ranges: readonly Range[]): void;
  /** Go to a place, to write there. */
  visit(range: Range): void;
  /** Underline what is wrong. */
  mark(diagnostics: readonly Diagnostic[]): void;
  lineOf(offset: number): number;
}

/**
 * The text on the left: plain at first, which is there at once and can be written in; in an editor
 * from `enrich` on. It stands in a shadow tree, where styles need no permission.
 */
export class ProgramText implements TextBox {
  readonly #root: ShadowRoot;
  readonly #events: TextEvents;
  readonly #plain: PlainText;
  #box: TextBox;
  #marks: readonly Diagnostic[] = [];
  #isDark = false;
  #coming: Promise<void> | undefined;

  constructor(host: HTMLElement, events: TextEvents) {
    this.#root = host.attachShadow({ mode: "open" });
    this.#events = events;
    this.#box = this.#plain = new PlainText(this.#root, events, () => this.enrich());
  }

  /** Have the editor in place of the plain text, which stays where the editor cannot be fetched. */
  enrich(): void {
    this.#coming ??= this.#enrich().catch(() => (this.#coming = undefined));
  }

  async #enrich(): Promise<void> {
    const { ProgramEditor } = await import("./editor.ts");
    await this.#plain.composed();
    const { text, standing } = this.#plain;
    const editor = new ProgramEditor(this.#root, text, this.#events);
    editor.isDark = this.#isDark;
    editor.mark(this.#marks);
    this.#plain.remove();
    this.#box = editor;
    editor.resume(standing);
  }

  get text(): string {
    return this.#box.text;
  }

  set text(text: string) {
    this.#box.text = text;
  }

  get cursors(): number[] {
    return this.#box.cursors;
  }

  set isDark(isDark: boolean) {
    this.#isDark = isDark;
    this.#box.isDark = isDark;
  }

  apply(edits: readonly Edit[]): void {
    this.#box.apply(edits);
  }

  select(ranges: readonly Range[]): void {
    this.#box.select(ranges);
  }

  visit(range: Range): void {
    this.#box.visit(range);
  }

  mark(diagnostics: readonly Diagnostic[]): void {
    this.#marks = diagnostics;
    this.#box.mark(diagnostics);
  }

  lineOf(offset: number): number {
    return this.#box.lineOf(offset);
  }
}
