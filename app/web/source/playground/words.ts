import type { Path } from "./completion.ts";
import { idsOf, valueAt, type Parsed } from "./places.ts";
import { notations, palettes } from "./service.ts";

/** A word that the program or the service gives a meaning to. */
export interface Word {
  value: string;
  detail: string;
}

/** The names that make sense at a path: of items, points, kinds, notations, palettes. */
export async function wordsFor(path: Path, parsed: Parsed): Promise<Word[]> {
  const shape = path.map((part) => (typeof part === "number" ? "*" : part)).join("/");
  switch (shape) {
    case "items/*/parent":
      return itemsOf(parsed, valueAt(parsed, [...path.slice(0, -1), "id"]));
    case "hyperedges/*/attachments/*/item":
    case "layout/constraints/*/items/*":
      return itemsOf(parsed);
    case "hyperedges/*/attachments/*/point":
      return pointsOf(parsed, valueAt(parsed, [...path.slice(0, -1), "item"]));
    case "items/*/kind":
      return kindsOf(parsed, "items");
    case "hyperedges/*/kind":
      return kindsOf(parsed, "hyperedges");
    case "notation":
      return (await orNone(notations())).map(({ name, title }) => ({ value: name, detail: title }));
    case "style/palette":
      return (await orNone(palettes())).map(({ name, title }) => ({ value: name, detail: title }));
    default:
      return [];
  }
}

function itemsOf(parsed: Parsed, without?: unknown): Word[] {
  const ids = idsOf(parsed, "item").filter((id) => id !== without);
  return ids.map((value) => ({ value, detail: "item" }));
}

function pointsOf(parsed: Parsed, item: unknown): Word[] {
  const items = valueAt(parsed, ["items"]) as { id?: unknown; attachment_points?: { id?: unknown }[] }[];
  const points = items.find(({ id }) => id === item)?.attachment_points ?? [];
  return points.flatMap(({ id }) => (typeof id === "string" ? [{ value: id, detail: "attachment point" }] : []));
}

async function kindsOf(parsed: Parsed, of: "items" | "hyperedges"): Promise<Word[]> {
  const written = valueAt(parsed, ["notation"]) ?? "plain";
  const notation = (await orNone(notations())).find(({ name }) => name === written);
  return Object.keys(notation?.[of] ?? {}).map((value) => ({ value, detail: notation?.title ?? "" }));
}

/** Completion works without what the service cannot tell at the moment. */
function orNone<Entry>(asked: Promise<Entry[]>): Promise<Entry[]> {
  return asked.catch(() => []);
}
