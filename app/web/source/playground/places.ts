import { findNodeAtLocation, getNodeValue, parseTree, type Node as Tree, type ParseError } from "jsonc-parser";
import type { ThingName } from "../viewer/things.ts";

/** A stretch of the text. */
export interface Range {
  from: number;
  to: number;
}

/** A text, and what it says. */
export interface Parsed {
  text: string;
  tree: Tree | undefined;
  errors: ParseError[];
}

export function parse(text: string): Parsed {
  const errors: ParseError[] = [];
  const tree = parseTree(text, errors, { disallowComments: true, allowTrailingComma: false });
  return { text, tree, errors };
}

const LISTS = { item: "items", hyperedge: "hyperedges" } as const;

/** The value at a path, if the text has one. */
export function valueAt({ tree }: Parsed, path: readonly (string | number)[]): unknown {
  const found = tree && findNodeAtLocation(tree, [...path]);
  return found && (getNodeValue(found) as unknown);
}

/** The ids of all items or hyperedges, in their order. */
export function idsOf(parsed: Parsed, shows: ThingName["shows"]): string[] {
  return entries(parsed, shows).map(({ id }) => id);
}

/** The item or hyperedge whose text is around a place. */
export function thingAt(parsed: Parsed, offset: number): ThingName | undefined {
  for (const shows of ["item", "hyperedge"] as const) {
    for (const { id, node } of entries(parsed, shows)) {
      const end = node.offset + node.length;
      // At the end of its line one is still there.
      if (node.offset <= offset && offset <= end + (parsed.text[end] === "," ? 1 : 0)) return { shows, id };
    }
  }
  return undefined;
}

/** Where an item or a hyperedge is written. */
export function rangeOfThing(parsed: Parsed, { shows, id }: ThingName): Range | undefined {
  return rangeOf(entries(parsed, shows).find((entry) => entry.id === id)?.node);
}

/** Where to point at for a JSON pointer: a value, the key of a long one, or what lacks it. */
export function rangeOfPointer({ text, tree }: Parsed, pointer: string, isKey: boolean): Range {
  const path = pathOf(pointer);
  for (let depth = path.length; depth >= 0; depth -= 1) {
    const node = tree && nodeAt(tree, path.slice(0, depth));
    if (node === undefined) continue;
    const isLong = node.type === "object" || node.type === "array";
    const key = node.parent?.type === "property" ? node.parent.children?.[0] : undefined;
    if (key && (isLong || isKey)) return rangeOf(key) as Range;
    return isLong ? { from: node.offset, to: node.offset + 1 } : (rangeOf(node) as Range);
  }
  return { from: 0, to: Math.min(1, text.length) };
}

function pathOf(pointer: string): string[] {
  const parts = pointer.split("/").slice(1);
  return parts.map((name) => name.replaceAll("~1", "/").replaceAll("~0", "~"));
}

/** As `findNodeAtLocation`, which wants numbers for places in lists; a pointer does not tell. */
function nodeAt(tree: Tree, path: readonly string[]): Tree | undefined {
  let node: Tree | undefined = tree;
  for (const name of path) {
    if (node === undefined) return undefined;
    node = findNodeAtLocation(node, [node.type === "array" ? Number(name) : name]);
  }
  return node;
}

function rangeOf(node: Tree | undefined): Range | undefined {
  return node && { from: node.offset, to: node.offset + node.length };
}

function entries({ tree }: Parsed, shows: ThingName["shows"]): { id: string; node: Tree }[] {
  const list = tree && findNodeAtLocation(tree, [LISTS[shows]]);
  const found: { id: string; node: Tree }[] = [];
  for (const node of list?.type === "array" ? (list.children ?? []) : []) {
    const id = node.type === "object" ? findNodeAtLocation(node, ["id"])?.value : undefined;
    if (typeof id === "string") found.push({ id, node });
  }
  return found;
}
