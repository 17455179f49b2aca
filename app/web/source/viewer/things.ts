/** Names an item or a hyperedge; the two have ids of their own. */
export interface ThingName {
  shows: "item" | "hyperedge";
  id: string;
}

/** What the document says of an item or a hyperedge, as the scene's extras hand it on. */
export interface Thing extends ThingName {
  kind?: string;
  label?: string;
  parent?: string;
  attachments?: { item: string; point?: string }[];
  data?: unknown;
}

export type ThingKey = `${ThingName["shows"]} ${string}`;

export function keyOf({ shows, id }: ThingName): ThingKey {
  return `${shows} ${id}`;
}

/** What to call it: its label, or its id where it has none. */
export function titleOf({ label, id }: Thing): string {
  return label || id;
}

/** A sentence about it, for those who hear the picture. */
export function describe(thing: Thing, titles: (item: string) => string): string {
  const kind = thing.kind ? `, ${thing.kind.replaceAll("_", " ")}` : "";
  if (thing.shows === "item") {
    const inside = thing.parent === undefined ? "" : `, in ${titles(thing.parent)}`;
    return `Item ${titleOf(thing)}${kind}${inside}`;
  }
  const members = [...new Set((thing.attachments ?? []).map(({ item }) => item))].map(titles);
  const last = members.pop() ?? "nothing";
  const joined = members.length > 0 ? `${members.join(", ")} and ${last}` : last;
  return `Hyperedge ${titleOf(thing)}${kind}, joins ${joined}`;
}
