import type { Clearance } from "../viewer/clearance.ts";
import type { TubeEvents } from "../viewer/element.ts";

/** What is to be told of a hyperedge. */
export interface Remark {
  hyperedge: string;
  text: string;
}

/** What comes nearer than wanted, as sentences. */
export function conflictsOf({ conflicts, required }: Clearance): Remark[] {
  return conflicts.map(({ hyperedges, item, distance }) => {
    const [hyperedge = "", other] = hyperedges;
    const partner = item === null || item === undefined ? (other ?? hyperedge) : `item ${item}`;
    const apart = distance <= 0 ? "touch" : `are ${short(distance)} apart`;
    return { hyperedge, text: `${hyperedge} and ${partner} ${apart} (${short(required)} wanted).` };
  });
}

/** Where tubes bend too tightly for their thickness, as sentences. */
export function pinchesOf({ pinches }: Clearance): Remark[] {
  const edges = new Map<string, number>();
  for (const { hyperedge, radius_of_curvature: radius } of pinches) {
    edges.set(hyperedge, Math.min(radius, edges.get(hyperedge) ?? Infinity));
  }
  return [...edges].map(([hyperedge, radius]) => ({
    hyperedge,
    text: `${hyperedge} bends tightly: its narrowest curve has a radius of ${short(radius)}.`,
  }));
}

/** The verdict on so many hyperedges in one line, and whether it is good. */
export function verdictOf(clearance: Clearance, hyperedges: number): { verdict: "none" | "good" | "bad"; text: string } {
  const { conflicts, minimum, required, certified } = clearance;
  if (hyperedges === 0) return { verdict: "none", text: "There are no hyperedges yet." };
  const tight = pinchesOf(clearance).length;
  const pinches = tight === 0 ? "" : ` ${tight === 1 ? "One bends" : `${tight} bend`} tightly.`;
  if (certified) {
    const what = hyperedges === 1 ? "The hyperedge touches nothing else" : "No two hyperedges touch";
    const text = `${what}: at least ${short(minimum)} apart (${short(required)} wanted).`;
    return { verdict: "good", text: text + pinches };
  }
  const [first] = conflictsOf(clearance);
  const more = conflicts.length > 1 ? ` ${conflicts.length - 1} more.` : "";
  return { verdict: "bad", text: `${first?.text ?? "Something comes too near."}${more}${pinches}` };
}

/** What was loaded, in numbers. */
export function countsOf({ items, hyperedges, bytes, milliseconds }: TubeEvents["tube-load"]): string {
  const plural = (count: number, name: string) => `${count.toLocaleString("en")} ${name}${count === 1 ? "" : "s"}`;
  return `${plural(items, "item")} · ${plural(hyperedges, "hyperedge")} · ${sizeOf(bytes)} · ${Math.round(milliseconds)} ms`;
}

/** A number of bytes, for people. */
export function sizeOf(bytes: number): string {
  if (bytes < 1000) return `${bytes} B`;
  if (bytes < 1e6) return `${Math.round(bytes / 1000)} kB`;
  return `${(bytes / 1e6).toFixed(1)} MB`;
}

/** A length with two digits that count. */
function short(value: number): string {
  return String(Number(value.toPrecision(2)));
}
