import type { Edit, ProgramDocument } from "tubeloom-client";
import { isSame, leave, type Attachment, type Hyperedge, type Item } from "./graph.js";

type Fields = Record<string, unknown>;
type SetFields = Extract<Edit, { type: "set_item" }>["fields"];

/**
 * The edits that lead from one program to another. What is the same in both is in none of them.
 *
 * Edits do not tell orders: items, hyperedges and attachments that are new come last.
 */
export function editsBetween(before: ProgramDocument, after: ProgramDocument): Edit[] {
  const edits: Edit[] = [...editsOfItems(before, after), ...editsOfHyperedges(before, after)];
  const [olds, news] = [byId(before.items), byId(after.items)];
  for (const { id, parent } of before.items) {
    // What a container contains goes with it.
    const goesAnyway = parent != null && olds.has(parent) && !news.has(parent);
    if (!news.has(id) && !goesAnyway) edits.push({ type: "remove_item", id });
  }
  const fields = patch(frameOf(before), frameOf(after));
  if (fields) edits.push({ type: "set_program", fields });
  return edits;
}

function editsOfItems(before: ProgramDocument, after: ProgramDocument): Edit[] {
  const edits: Edit[] = [];
  const olds = byId(before.items);
  const news = byId(after.items);
  const taken = new Set<string>();
  const add = (item: Item): void => {
    if (olds.has(item.id) || taken.has(item.id)) return;
    taken.add(item.id);
    const parent = item.parent == null ? undefined : news.get(item.parent);
    if (parent) add(parent);
    edits.push({ type: "add_item", item });
  };
  after.items.forEach(add);
  const moving = after.items.filter((item) => {
    const old = olds.get(item.id);
    return old && (old.parent ?? null) !== (item.parent ?? null);
  });
  // First out of all, so that nothing is ever contained in itself.
  for (const { id, parent } of moving) if (parent != null) edits.push({ type: "reparent", id, parent: null });
  for (const { id, parent } of moving) edits.push({ type: "reparent", id, parent: parent ?? null });
  for (const item of after.items) {
    const old = olds.get(item.id);
    if (!old) continue;
    const now = moving.includes(item) ? leave(old, ["position"]) : old;
    const fields = patch(bare(now, ["parent"]), bare(item, ["parent"]));
    if (fields) edits.push({ type: "set_item", id: item.id, fields });
  }
  return edits;
}

function editsOfHyperedges(before: ProgramDocument, after: ProgramDocument): Edit[] {
  const edits: Edit[] = [];
  const olds = byId(before.hyperedges ?? []);
  const news = byId(after.hyperedges ?? []);
  for (const id of olds.keys()) if (!news.has(id)) edits.push({ type: "remove_hyperedge", id });
  for (const hyperedge of news.values()) {
    const { id } = hyperedge;
    const old = olds.get(id);
    if (!old) {
      edits.push({ type: "add_hyperedge", hyperedge });
      continue;
    }
    const fields = patch(bare(old, ["attachments"]), bare(hyperedge, ["attachments"]));
    if (fields) edits.push({ type: "set_hyperedge", id, fields });
    // New ends before old ones go: two must stay at every moment.
    const added = without(hyperedge.attachments, old.attachments);
    const gone = without(old.attachments, hyperedge.attachments);
    if (added.length > 0) edits.push({ type: "connect", id, attachments: added });
    if (gone.length > 0) edits.push({ type: "disconnect", id, attachments: gone });
  }
  return edits;
}

/** What must be merged into `before` (RFC 7396) to get `after`; undefined where nothing must. */
function patch(before: Fields, after: Fields): SetFields | undefined {
  const found: Fields = {};
  for (const name of new Set([...Object.keys(before), ...Object.keys(after)])) {
    const [old, now] = [before[name], after[name]];
    if (isSame(old ?? null, now ?? null)) continue;
    if (now == null) found[name] = null;
    else if (!isObject(old) || !isObject(now) || isOtherShape(name, old, now)) found[name] = now;
    else found[name] = patch(old, now) ?? {};
  }
  return Object.keys(found).length > 0 ? (found as SetFields) : undefined;
}

/** A shape of another type takes nothing from the old one. */
function isOtherShape(name: string, old: Fields, now: Fields): boolean {
  return name === "shape" && old["type"] !== now["type"];
}

function isObject(value: unknown): value is Fields {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

const EMPTY_FIELDS: readonly string[] = ["data", "attachment_points"];

/** A part without some of its fields, and without what is as good as nothing. */
function bare(part: object, without: readonly string[]): Fields {
  const fields = leave(part, ["id", ...without]);
  for (const name of EMPTY_FIELDS) {
    const value = fields[name];
    if (typeof value === "object" && value !== null && Object.keys(value).length === 0) delete fields[name];
  }
  return fields;
}

function frameOf(program: ProgramDocument): Fields {
  const frame = bare(program, ["items", "hyperedges"]);
  if (frame["notation"] === "plain") delete frame["notation"];
  return frame;
}

function byId<Part extends Item | Hyperedge>(parts: readonly Part[]): Map<string, Part> {
  return new Map(parts.map((part) => [part.id, part]));
}

function without(ends: readonly Attachment[], others: readonly Attachment[]): Attachment[] {
  const name = ({ item, point }: Attachment) => JSON.stringify([item, point ?? null]);
  const known = new Set(others.map(name));
  return ends.filter((end) => !known.has(name(end)));
}
