import type { components } from "tubeloom-client";

export type Item = components["schemas"]["Item"];
export type Hyperedge = components["schemas"]["Hyperedge"];
export type Attachment = components["schemas"]["Attachment"];
export type AttachmentPoint = components["schemas"]["AttachmentPoint"];

export type Side = "left" | "right" | "top" | "bottom";

/** A handle of a node: on which side, and where along it (0 to 1, from the left or from the top). */
export interface FlowHandle {
  id: string;
  side: Side;
  along?: number;
}

export interface Place {
  x: number;
  y: number;
}

/**
 * What the adapter reads of a node; React Flow's `Node` is one.
 *
 * In `data` it heeds the fields of an item (`label`, `kind`, `shape`, `color`, …), or of a hyperedge
 * where the node is a junction, `handles`, and `data`, which is your own. All else that is in it is
 * kept and comes back.
 */
export interface FlowNode {
  id: string;
  type?: string | undefined;
  position: Place;
  parentId?: string | undefined;
  origin?: [number, number] | undefined;
  width?: number | undefined;
  height?: number | undefined;
  measured?: { width?: number | undefined; height?: number | undefined } | undefined;
  data: Record<string, unknown>;
}

/** What the adapter reads of an edge; React Flow's `Edge` is one. */
export interface FlowEdge {
  id: string;
  source: string;
  target: string;
  sourceHandle?: string | null | undefined;
  targetHandle?: string | null | undefined;
  data?: Record<string, unknown> | undefined;
}

/** How the plane of the graph lies in space. */
export interface FlowOptions {
  /** Pixels of the graph that are one unit. */
  scale?: number;
  /** React Flow's `nodeOrigin`: [0, 0] where a position is a node's corner, [0.5, 0.5] its middle. */
  origin?: [number, number];
  /** How high items are that do not say it. */
  height?: number;
}

/** The type of the nodes that are hyperedges: edges lead from handles to them. */
export const JUNCTION = "junction";

/** The handle of an item that has no attachment points: its middle. */
export const MIDDLE = "*";

const DEFAULTS: Required<FlowOptions> = { scale: 48, origin: [0, 0], height: 0.5 };

export function complete(options: FlowOptions): Required<FlowOptions> {
  return { ...DEFAULTS, ...options };
}

const LOOK = ["kind", "label", "material", "finish", "translucency", "color"] as const;
export const ITEM_FIELDS: readonly string[] = [...LOOK, "shape", "rotation", "attachment_points", "data"];
export const HYPEREDGE_FIELDS: readonly string[] = [...LOOK, "radius", "join_height", "data"];

/** Names in a node's data that are the adapter's own. */
export const OWN_FIELDS: readonly string[] = ["handles", "placed", "position", "z", "asIs", "paint"];

/** The fields of these names that say anything. */
export function pick(from: object, names: readonly string[]): Record<string, unknown> {
  const said = Object.entries(from).filter(([name, value]) => names.includes(name) && value != null);
  return Object.fromEntries(said);
}

/** The fields of other names that say anything. */
export function leave(from: object, names: readonly string[]): Record<string, unknown> {
  const said = Object.entries(from).filter(([name, value]) => !names.includes(name) && value != null);
  return Object.fromEntries(said);
}

/** Whether two values are the same JSON, whatever the order of their keys. */
export function isSame(one: unknown, other: unknown): boolean {
  if (one === other) return true;
  if (one === null || other === null || typeof one !== "object" || typeof other !== "object") return false;
  if (Array.isArray(one) !== Array.isArray(other)) return false;
  const [ones, others] = [leave(one, []), leave(other, [])];
  if (Array.isArray(one) && one.length !== (other as unknown[]).length) return false;
  const names = Object.keys(ones);
  return names.length === Object.keys(others).length && names.every((name) => isSame(ones[name], others[name]));
}

/** Four digits are finer than any screen; and numbers come back as they were sent. */
export function rounded(value: number): number {
  return Math.round(value * 1e4) / 1e4 || 0;
}

export function isPlace<Value>(value: Value): value is Value & Place {
  const place = value as Partial<Place> | undefined;
  return typeof place?.x === "number" && typeof place.y === "number";
}
