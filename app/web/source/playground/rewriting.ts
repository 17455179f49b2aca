import { findNodeAtLocation, modify, type Edit } from "jsonc-parser";
import { spaced } from "./documents.ts";
import { valueAt, type Parsed } from "./places.ts";

/** The edits that write a value in a section of the program, or take it out; all else stays as it is. */
export function rewrite(parsed: Parsed, path: readonly [string, string], value: unknown): Edit[] {
  if (value === undefined) return without(parsed, path);
  const { text } = parsed;
  return modify(text, [...path], value, {}).map((edit) => {
    const content = spaced(edit.content).trim();
    if (!content.startsWith(",")) return { ...edit, content };
    return { ...edit, content: `,${gapAt(parsed, edit.offset)}${content.slice(1).trimStart()}` };
  });
}

/** A section that says nothing any more goes too. */
function without(parsed: Parsed, path: readonly [string, string]): Edit[] {
  if (valueAt(parsed, path) === undefined) return [];
  const section = valueAt(parsed, [path[0]]);
  const isLast = typeof section === "object" && section !== null && Object.keys(section).length === 1;
  return modify(parsed.text, isLast ? [path[0]] : [...path], undefined, {});
}

/** What stands between an object's brace and its first name: a new name gets the same. */
function gapAt({ text, tree }: Parsed, offset: number): string {
  const inside = ["", "layout", "style", "view"].map((name) => tree && findNodeAtLocation(tree, name ? [name] : []));
  const around = inside.filter((node) => node && node.offset < offset && offset < node.offset + node.length);
  const innermost = around.at(-1);
  const first = innermost?.children?.[0];
  const gap = innermost && first ? text.slice(innermost.offset + 1, first.offset) : "";
  return gap === "" ? " " : gap;
}
