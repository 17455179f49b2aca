import { autocompletion, closeBrackets, closeBracketsKeymap, completionKeymap } from "@codemirror/autocomplete";
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
import { complete } from "./completion.ts";
import { editorLook } from "./editor-look.ts";
import type { Range } from "./places.ts";
import type { Standing, TextBox, TextEvents } from "./text.ts";

const byPage = Annotation.define<boolean>();

/** The text in an editor that knows what programs are made of. */
export class ProgramEditor implements TextBox {
  readonly #view: EditorView;
  readonly #darkness = new Compartment();
  readonly #events: TextEvents;

  constructor(root: ShadowRoot, text: string, events: TextEvents) {
    this.#events = events;
    const frame = new CSSStyleSheet();
    frame.replaceSync(":host { display: block; } .cm-editor { height: 100%; }");
    root.adoptedStyleSheets = [...root.adoptedStyleSheets, frame];
    this.#view = new EditorView({
      root,
      parent: root,
      doc: text,
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

  /** Go on from where somebody is in the same text elsewhere. */
  resume({ range: { from, to }, isFocused, top }: Standing): void {
    this.#view.dispatch({ selection: { anchor: from, head: to }, annotations: byPage.of(true) });
    this.#view.scrollDOM.scrollTop = top;
    if (!isFocused) return;
    this.#view.focus();
    this.#events.cursor(this.cursors);
  }

  apply(edits: readonly Edit[]): void {
    this.#view.dispatch({
      changes: edits.map(({ offset, length, content }) => ({ from: offset, to: offset + length, insert: content })),
      userEvent: "input",
      scrollIntoView: true,
    });
  }

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

  visit({ from, to }: Range): void {
    this.#view.dispatch({
      selection: { anchor: from, head: to },
      effects: EditorView.scrollIntoView(from, { y: "center" }),
    });
    this.#view.focus();
  }

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
