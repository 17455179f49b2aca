import type { Edit } from "jsonc-parser";
import { make } from "./page.ts";
import type { Range } from "./places.ts";
import type { Standing, TextBox, TextEvents } from "./text.ts";

/** As the editor has its lines, so that nothing moves when it comes; see `editor-look.ts`. */
const STYLES = `
  :host { display: block; }
  .plain { position: relative; height: 100%; overflow: hidden; background: var(--paper); color: var(--ink); }
  .plain, .plain textarea { font: 13px/1.55 ui-monospace, 'SF Mono', 'Cascadia Mono', Menlo, Consolas, monospace; }
  .lines { padding: 8px 0; counter-reset: line; }
  .lines div {
    position: relative;
    min-height: 1.55em;
    padding: 0 8px 0 calc(var(--gutter) + 4ch + 4px);
    text-indent: -4ch;
    white-space: break-spaces;
    word-break: break-word;
    overflow-wrap: anywhere;
    counter-increment: line;
  }
  .lines div::before {
    content: counter(line);
    position: absolute;
    left: 14px;
    width: var(--number);
    color: var(--quiet);
    text-align: right;
    text-indent: 0;
  }
  textarea {
    position: absolute;
    inset: 0;
    box-sizing: border-box;
    width: 100%;
    height: 100%;
    padding: 8px 8px 8px calc(var(--gutter) + 4px);
    border: 0;
    outline: none;
    resize: none;
    background: none;
    color: transparent;
    caret-color: var(--accent);
    white-space: break-spaces;
    overflow-wrap: anywhere;
  }
  .plain.used textarea { background: var(--paper); color: var(--ink); }
`;

/** As many lines as any window has room for. */
const MOST_LINES = 200;

/** A text that can be written in, and looks like the editor that is on its way. */
export class PlainText implements TextBox {
  readonly #area = make("textarea");
  readonly #lines = make("div", { className: "lines" });
  readonly #frame = make("div", { className: "plain" }, this.#lines, this.#area);
  readonly #events: TextEvents;
  #composed: Promise<void> = Promise.resolve();

  /** `used` is called once somebody wants to do something with the text. */
  constructor(root: ShadowRoot, events: TextEvents, used: () => void) {
    this.#events = events;
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(STYLES);
    root.adoptedStyleSheets = [...root.adoptedStyleSheets, sheet];
    const area = this.#area;
    area.setAttribute("aria-label", "Program");
    area.spellcheck = false;
    this.#lines.setAttribute("aria-hidden", "true");
    const use = () => {
      this.#frame.classList.add("used");
      used();
    };
    area.addEventListener("focus", use);
    area.addEventListener("scroll", use);
    area.addEventListener("input", () => events.change(area.value, true));
    area.addEventListener("compositionstart", () => {
      const ended = new Promise<Event>((resolve) => area.addEventListener("compositionend", resolve, { once: true }));
      // What was composed is in the text only once this event has been told to all.
      this.#composed = ended.then(() => new Promise((resolve) => setTimeout(resolve)));
    });
    root.append(this.#frame);
  }

  /** Once nobody is in the middle of composing a letter. */
  composed(): Promise<void> {
    return this.#composed;
  }

  get standing(): Standing {
    const { selectionStart: from, selectionEnd: to, scrollTop: top } = this.#area;
    const isFocused = (this.#area.getRootNode() as ShadowRoot).activeElement === this.#area;
    return { range: { from, to }, isFocused, top };
  }

  remove(): void {
    this.#frame.remove();
  }

  get text(): string {
    return this.#area.value;
  }

  set text(text: string) {
    this.#area.value = text;
    this.#area.setSelectionRange(0, 0);
    const lines = this.#area.value.split("\n");
    const number = `${String(lines.length).length}ch`;
    this.#frame.style.setProperty("--number", `max(14px, ${number})`);
    this.#frame.style.setProperty("--gutter", `calc(max(34px, ${number} + 20px) + 24px)`);
    this.#lines.replaceChildren(...lines.slice(0, MOST_LINES).map((line) => make("div", { text: line })));
    this.#events.change(this.text, false);
  }

  get cursors(): number[] {
    return [this.#area.selectionEnd];
  }

  set isDark(_isDark: boolean) {
    // Its colours are the page's.
  }

  apply(edits: readonly Edit[]): void {
    for (const { offset, length, content } of [...edits].sort((one, other) => other.offset - one.offset)) {
      this.#area.setRangeText(content, offset, offset + length);
    }
    this.#frame.classList.add("used");
    this.#events.change(this.text, true);
  }

  select(ranges: readonly Range[]): void {
    const [last] = ranges.slice(-1);
    if (last) this.#area.setSelectionRange(last.from, last.to);
  }

  visit({ from, to }: Range): void {
    this.#area.focus();
    this.#area.setSelectionRange(from, to);
  }

  mark(): void {
    // What is wrong is listed below; the editor underlines it.
  }

  lineOf(offset: number): number {
    return this.text.slice(0, offset).split("\n").length;
  }
}
