import { autocompletion, closeBrackets, closeBracketsKeymap, completionKeymap, type CompletionSource } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap } from "@codemirror/commands";
import { json } from "@codemirror/lang-json";
import { bracketMatching, foldGutter, foldKeymap, indentOnInput, indentUnit } from "@codemirror/language";
import { lintGutter, lintKeymap, setDiagnostics, type Diagnostic } from "@codemirror/lint";
import { highlightSelectionMatches, search, searchKeymap } from "@codemirror/search";
import { Annotation, Compartment, EditorSelection, EditorState } from "@codemirror/state";
import {
  drawSelection,
  dropCursor,
  EditorView,
  highlightActiveLine,
  highlightActiveLineGutter,
  keymap,
  lineNumbers,
} from "@codemirror/view";
import type { Edit } from "jsonc-parser";
import { editorLook } from "./editor-look.ts";
import type { Range } from "./places.ts";

/** What the page does when something happens in the editor. */
export interface EditorEvents {
  /** The text is another one; `isTyped` unless the page itself has changed it. */
  change(text: string, isTyped: boolean): void;
  /** People have moved the cursor, or cursors. */
  cursor(offsets: number[]): void;
}

const byPage = Annotation.define<boolean>();

/** The text on the left. It stands in a shadow tree, where its styles need no permission. */
export class ProgramEditor {
  readonly #view: EditorView;
  readonly #darkness = new Compartment();

  constructor(host: HTMLElement, complete: CompletionSource, events: EditorEvents) {
    const root = host.attachShadow({ mode: "open" });
    const frame = new CSSStyleSheet();
    frame.replaceSync(":host { display: block; } .cm-editor { height: 100%; }");
    root.adoptedStyleSheets = [frame];
    this.#view = new EditorView({
      root,
      parent: root,
      extensions: [
        lineNumbers(),
        lintGutter(),
        foldGutter(),
        history(),
        drawSelection(),
        dropCursor(),
        EditorState.allowMultipleSelections.of(true),
        EditorState.tabSize.of(1),
        indentUnit.of(" "),
        indentOnInput(),
        bracketMatching(),
        closeBrackets(),
        autocompletion({ override: [complete], icons: false }),
        highlightActiveLine(),
        highlightActiveLineGutter(),
        highlightSelectionMatches({ minSelectionLength: 2, maxMatches: 100 }),
        search({ top: true }),
        keymap.of([
          ...closeBracketsKeymap,
          ...defaultKeymap,
          ...searchKeymap,
          ...historyKeymap,
          ...foldKeymap,
          ...completionKeymap,
          ...lintKeymap,
        ]),
        json(),
        editorLook,
        this.#darkness.of([]),
        EditorView.lineWrapping,
        EditorView.contentAttributes.of({ "aria-label": "Program", spellcheck: "false", tabindex: "0" }),
        EditorView.domEventHandlers({ beforeinput: overLines }),
        EditorView.updateListener.of((update) => {
          const isOurs = update.transactions.some((each) => each.annotation(byPage));
          if (update.docChanged) events.change(this.text, !isOurs);
          if (update.selectionSet && !isOurs) {
            events.cursor(update.state.selection.ranges.map(({ head }) => head));
          }
        }),
      ],
    });
  }

  get text(): string {
    return this.#view.state.doc.toString();
  }

  /** Put another text in place of this one; it can be undone. */
  set text(text: string) {
    const { length } = this.#view.state.doc;
    this.#view.dispatch({
      changes: { from: 0, to: length, insert: text },
      selection: { anchor: 0 },
      annotations: byPage.of(true),
      effects: EditorView.scrollIntoView(0),
      userEvent: "input.load",
    });
  }

  set isDark(isDark: boolean) {
    this.#view.dispatch({ effects: this.#darkness.reconfigure(EditorView.darkTheme.of(isDark)) });
  }

  get cursors(): number[] {
    return this.#view.state.selection.ranges.map(({ head }) => head);
  }

  /** Change some places of the text, as if they had been typed. */
  apply(edits: readonly Edit[]): void {
    this.#view.dispatch({
      changes: edits.map(({ offset, length, content }) => ({ from: offset, to: offset + length, insert: content })),
      userEvent: "input",
      scrollIntoView: true,
    });
  }

  /** Select these stretches, the last one foremost, and show it. The focus stays where it is. */
  select(ranges: readonly Range[]): void {
    const [last] = ranges.slice(-1);
    if (last === undefined) return;
    const selection = EditorSelection.create(
      ranges.map(({ from, to }) => EditorSelection.range(from, to)),
      ranges.length - 1,
    );
    this.#view.dispatch({
      selection,
      annotations: byPage.of(true),
      effects: EditorView.scrollIntoView(last.from, { y: "center" }),
    });
  }

  /** Go to a place, to write there. */
  visit({ from, to }: Range): void {
    this.#view.dispatch({
      selection: { anchor: from, head: to },
      effects: EditorView.scrollIntoView(from, { y: "center" }),
    });
    this.#view.focus();
  }

  /** Underline what is wrong. */
  mark(diagnostics: readonly Diagnostic[]): void {
    this.#view.dispatch(setDiagnostics(this.#view.state, diagnostics));
  }

  lineOf(offset: number): number {
    const { doc } = this.#view.state;
    return doc.lineAt(Math.min(offset, doc.length)).number;
  }
}

/** Typing over several lines: left to the browser, it would style them anew, which pages may not. */
function overLines(event: InputEvent, view: EditorView): boolean {
  const { main } = view.state.selection;
  const { data, inputType } = event;
  const isOverLines = view.state.doc.lineAt(main.from).number !== view.state.doc.lineAt(main.to).number;
  if (inputType !== "insertText" || data === null || view.composing || !isOverLines) return false;
  const { from, to } = main;
  const insert = () =>
    view.state.update(view.state.replaceSelection(data), { userEvent: "input.type", scrollIntoView: true });
  const handlers = view.state.facet(EditorView.inputHandler);
  if (!handlers.some((handle) => handle(view, from, to, data, insert))) view.dispatch(insert());
  return true;
}
