import type { Diagnostic } from "@codemirror/lint";
import { printParseErrorCode, type ParseError } from "jsonc-parser";
import type { Clearance } from "../viewer/clearance.ts";
import type { ProblemDetails } from "../viewer/loading.ts";
import { make } from "./page.ts";
import { rangeOfPointer, rangeOfThing, type Parsed } from "./places.ts";
import type { TextBox } from "./text.ts";
import { conflictsOf, pinchesOf } from "./verdict.ts";

const SENTENCES: Record<string, string> = {
  InvalidSymbol: "This is not JSON: names and texts stand in double quotes.",
  InvalidNumberFormat: "This is not a number as JSON writes it.",
  PropertyNameExpected: "A name in double quotes is missing here.",
  ValueExpected: "A value is missing here.",
  ColonExpected: "A colon is missing here.",
  CommaExpected: "A comma is missing before this.",
  CloseBraceExpected: "A closing brace } is missing.",
  CloseBracketExpected: "A closing bracket ] is missing.",
  EndOfFileExpected: "The program has ended before this.",
  InvalidCommentToken: "JSON has no comments.",
  UnexpectedEndOfString: "This text has no closing double quote.",
  InvalidEscapeCharacter: "This is no escape that JSON knows.",
  InvalidUnicode: "After \\u come four digits, 0 to 9 and a to f.",
  InvalidCharacter: "This character must be escaped.",
};

const MOST_LISTED = 100;

/** What is wrong with the text, underlined in it and listed below it. */
export class Problems {
  readonly #editor: TextBox;
  readonly #summary: HTMLElement;
  readonly #list: HTMLElement;
  #problem: ProblemDetails | undefined;
  #clearance: Clearance | undefined;

  constructor(editor: TextBox, summary: HTMLElement, list: HTMLElement) {
    this.#editor = editor;
    this.#summary = summary;
    this.#list = list;
  }

  /** What the service says of the text; nothing if it was drawn. */
  set problem(problem: ProblemDetails | undefined) {
    this.#problem = problem;
    if (problem) this.#clearance = undefined;
  }

  set clearance(clearance: Clearance | undefined) {
    this.#clearance = clearance;
  }

  /** Show what is wrong with this text. */
  show(parsed: Parsed): void {
    const found = parsed.errors.length > 0 ? syntaxOf(parsed) : [...this.#faults(parsed), ...this.#conflicts(parsed)];
    found.sort((one, other) => one.from - other.from);
    this.#editor.mark(found);
    this.#list.replaceChildren(...found.slice(0, MOST_LISTED).map((each) => this.#entry(each)));
    this.#list.hidden = found.length === 0;
    const count = (severity: string) => found.filter((each) => each.severity === severity).length;
    this.#summary.dataset["severity"] = found.length === 0 ? "none" : count("error") > 0 ? "error" : "warning";
    const told = [several(count("error"), "problem"), several(count("warning"), "conflict"), several(count("info"), "remark")];
    const text = told.filter((each) => each !== "").join(", ") || "No problems";
    if (this.#summary.textContent !== text) this.#summary.textContent = text;
  }

  #faults(parsed: Parsed): Diagnostic[] {
    const problem = this.#problem;
    if (problem === undefined) return [];
    const faults: { pointer?: string | null; detail: string }[] = problem.errors ?? [];
    if (faults.length === 0) faults.push({ pointer: "", detail: problem.detail ?? problem.title });
    return faults.map(({ pointer, detail }) => ({
      ...rangeOfPointer(parsed, pointer ?? "", /^Unknown key/.test(detail)),
      severity: "error",
      message: detail,
    }));
  }

  #conflicts(parsed: Parsed): Diagnostic[] {
    if (this.#clearance === undefined) return [];
    const told = [
      ...conflictsOf(this.#clearance).map((each) => ({ ...each, severity: "warning" as const })),
      ...pinchesOf(this.#clearance).map((each) => ({ ...each, severity: "info" as const })),
    ];
    return told.flatMap(({ hyperedge, text, severity }) => {
      const range = rangeOfThing(parsed, { shows: "hyperedge", id: hyperedge });
      return range ? [{ from: range.from, to: range.from + 1, severity, message: text }] : [];
    });
  }

  #entry({ from, to, severity, message }: Diagnostic): HTMLElement {
    const button = make("button", {}, make("span", { className: "line", text: `Line ${this.#editor.lineOf(from)}` }), message);
    button.type = "button";
    button.dataset["severity"] = severity;
    button.addEventListener("click", () => this.#editor.visit({ from, to }));
    return make("li", {}, button);
  }
}

/** One error a line: those behind the first mostly follow from it. */
function syntaxOf({ text, errors }: Parsed): Diagnostic[] {
  const lines = new Map<number, ParseError>();
  for (const each of errors) {
    const line = text.lastIndexOf("\n", each.offset - 1);
    if (!lines.has(line)) lines.set(line, each);
  }
  return [...lines.values()].map(({ error, offset, length }) => {
    const from = Math.max(0, Math.min(offset, text.length - 1));
    const to = Math.min(text.length, Math.max(offset + length, from + 1));
    return { from, to, severity: "error", message: SENTENCES[printParseErrorCode(error)] ?? "This is not JSON." };
  });
}

function several(count: number, name: string): string {
  return count === 0 ? "" : `${count} ${name}${count === 1 ? "" : "s"}`;
}
