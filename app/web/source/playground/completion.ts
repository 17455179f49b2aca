import { snippet, startCompletion, type Completion, type CompletionContext, type CompletionResult } from "@codemirror/autocomplete";
import type { EditorView } from "@codemirror/view";
import { getLocation, type Location } from "jsonc-parser";
import { parse, valueAt, type Parsed } from "./places.ts";
import { kindOf, ProgramSchema, type Schema } from "./schema.ts";
import { wordsFor } from "./words.ts";

/** Where something stands in a document. */
export type Path = readonly (string | number)[];

let schema: Promise<ProgramSchema> | undefined;

/** What may be written at the cursor, by the service's own schema and by what the program names. */
export async function complete(context: CompletionContext): Promise<CompletionResult | null> {
  const { state, pos, explicit } = context;
  const text = state.doc.toString();
  const location = getLocation(text, pos);
  const from = startOf(text, location, pos);
  if (!explicit && from === pos) return null;
  schema ??= ProgramSchema.load();
  const known = await schema.catch(() => (schema = undefined));
  if (known === undefined || context.aborted) return null;
  const parsed = parse(text);
  const options = location.isAtPropertyKey
    ? keysAt(known, location, parsed)
    : await valuesAt(known, location.path, parsed);
  return options.length > 0 ? { from, options, validFor: /^("[^"\n]*|[\w.#-]*)$/ } : null;
}

/** Where the word, or the text in quotes, begins that the cursor is in. */
function startOf(text: string, { previousNode }: Location, pos: number): number {
  if (previousNode && ["string", "property"].includes(previousNode.type)) {
    const { offset, length } = previousNode;
    if (offset < pos && pos <= offset + length) return offset;
  }
  return pos - (/[\w.#-]*$/.exec(text.slice(0, pos))?.[0] ?? "").length;
}

/** Puts a word in the place of the one around the cursor, and says what follows it. */
function put(view: EditorView, word: string, from: number, to: number): void {
  const { doc } = view.state;
  const rest = doc.sliceString(to, doc.lineAt(to).to);
  const isInQuotes = doc.sliceString(from, from + 1) === '"';
  const end = to + ((isInQuotes ? /^[^"\s,:]*"/ : /^[\w.#-]*/).exec(rest)?.[0].length ?? 0);
  view.dispatch({
    changes: { from, to: end, insert: word },
    selection: { anchor: from + word.length },
    userEvent: "input.complete",
  });
}

function keysAt(known: ProgramSchema, { path, previousNode }: Location, parsed: Parsed): Completion[] {
  const inside = path.slice(0, -1);
  const beside = valueAt(parsed, inside);
  const present = new Set(typeof beside === "object" && beside !== null ? Object.keys(beside) : []);
  const current: unknown = previousNode?.value;
  if (typeof current === "string") present.delete(current);
  const found = new Map<string, Completion>();
  for (const { properties = {}, required = [] } of known.at(inside, (each) => valueAt(parsed, each))) {
    for (const [name, property] of Object.entries(properties)) {
      if (present.has(name) || found.has(name)) continue;
      const possible = known.variants(property, undefined);
      const info = property.description ?? possible[0]?.description;
      found.set(name, {
        label: JSON.stringify(name),
        detail: [...new Set(possible.map(kindOf))].filter((kind) => kind && kind !== "null").join(" | ").slice(0, 48),
        ...(info ? { info } : {}),
        boost: required.includes(name) ? 2 : 0,
        apply: (view, _completion, from, to) => insertKey(view, name, from, to),
      });
    }
  }
  return [...found.values()];
}

function insertKey(view: EditorView, name: string, from: number, to: number): void {
  put(view, JSON.stringify(name), from, to);
  const { doc, selection } = view.state;
  const { head } = selection.main;
  if (/^\s*:/.test(doc.sliceString(head, head + 20))) return;
  view.dispatch({ changes: { from: head, insert: ": " }, selection: { anchor: head + 2 }, userEvent: "input.complete" });
  startCompletion(view);
}

async function valuesAt(known: ProgramSchema, path: Path, parsed: Parsed): Promise<Completion[]> {
  const found = new Map<string, Completion>();
  const add = (value: unknown, more: Partial<Completion> = {}) => {
    const label = JSON.stringify(value);
    if (found.has(label)) return;
    found.set(label, { label, apply: (view, _completion, from, to) => put(view, label, from, to), ...more });
  };
  for (const { value, detail } of await wordsFor(path, parsed)) add(value, { detail, boost: 2 });
  for (const possible of known.at(path, (each) => valueAt(parsed, each))) {
    for (const value of literalsOf(possible)) add(value, possible.description ? { info: possible.description } : {});
    if (possible.default !== undefined && possible.default !== null) add(possible.default, { detail: "as without" });
    const stub = stubOf(possible);
    if (stub && !found.has(stub.label)) found.set(stub.label, stub);
  }
  return [...found.values()];
}

function literalsOf({ const: constant, enum: words, type }: Schema): unknown[] {
  if (constant !== undefined) return [constant];
  if (words) return words;
  if (type === "boolean") return [true, false];
  return type === "null" ? [null] : [];
}

/** The least that an object or a list needs, to be filled in. */
function stubOf({ type, properties = {}, required = [], prefixItems }: Schema): Completion | undefined {
  if (type === "array") {
    const places = prefixItems?.map(() => "${0}").join(", ") ?? "${}";
    return { label: "[ … ]", apply: snippet(`[${places}]`), detail: "list" };
  }
  if (type !== "object" || Object.keys(properties).length === 0) return undefined;
  const parts = required.map((name) => {
    const { const: constant, type: kind } = properties[name] ?? {};
    if (constant !== undefined) return `"${name}": ${JSON.stringify(constant)}`;
    return `"${name}": ${kind === "array" ? "[${}]" : kind === "string" ? '"${}"' : "${}"}`;
  });
  const named = properties["type"]?.const;
  const label = typeof named === "string" ? `{ ${named} }` : `{ ${required.join(", ")} }`;
  const fields = parts.join(", ");
  return { label, apply: snippet(fields.includes("${}") ? `{${fields}}` : `{${fields}\${}}`), detail: "object" };
}
