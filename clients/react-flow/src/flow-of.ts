import type { Layout, ProgramDocument } from "tubeloom-client";
import {
  complete,
  HYPEREDGE_FIELDS,
  isPlace,
  isSame,
  ITEM_FIELDS,
  JUNCTION,
  leave,
  MIDDLE,
  pick,
  rounded,
  type Attachment,
  type FlowEdge,
  type FlowHandle,
  type FlowNode,
  type FlowOptions,
  type Hyperedge,
  type Item,
  type Place,
} from "./graph.js";
import { handlesOf, Middles, pointsOf, type Size } from "./places.js";
import { programOf } from "./program-of.js";

/** What the adapter keeps in an item's or a hyperedge's `data.flow`. */
interface Kept extends Partial<Place>, Partial<Size> {
  type?: string;
  asIs?: boolean;
  handles?: FlowHandle[];
  data?: Record<string, unknown>;
  edge?: boolean;
}

interface NodeOptions {
  scale: number;
  type: string | undefined;
}

const COLUMNS = 6;
const STEP: Size = { width: 208, height: 128 };
const DEFAULT_SIZE: Size = { width: 144, height: 56 };

/**
 * The graph of a program: the way back from `programOf`.
 *
 * It takes programs of others too. Their items stand where `layout` (the service's numbers) has them,
 * or in rows; they are `placed`, and count as having no position until somebody moves them. By
 * `layout` each hyperedge's `data.paint` is the colour of its tube, be it chosen by the service or not.
 */
export function flowOf(
  program: ProgramDocument,
  options: FlowOptions & { layout?: Layout; type?: string } = {},
): { nodes: FlowNode[]; edges: FlowEdge[] } {
  const whole = complete(options);
  const drawn = new Map(options.layout?.items.map((each) => [each.id, each]));
  const middleless = new Set<string>();
  for (const { attachments } of program.hyperedges ?? []) {
    for (const { item, point } of attachments) if (point == null) middleless.add(item);
  }
  const nodes: FlowNode[] = [];
  const middles = new Map<string, Place & Size>();
  for (const [number, item] of parentsFirst(program.items).entries()) {
    const kept = keptOf(item);
    const shown = drawn.get(item.id);
    const size = {
      width: kept.width ?? (shown ? shown.size[0] * whole.scale : DEFAULT_SIZE.width),
      height: kept.height ?? (shown ? shown.size[1] * whole.scale : DEFAULT_SIZE.height),
    };
    const parent = item.parent == null ? undefined : middles.get(item.parent);
    const middle = shown
      ? { x: shown.center[0] * whole.scale, y: -shown.center[1] * whole.scale }
      : middleIn(item, number, parent, whole.scale);
    const node = nodeOf(item, kept, size, middleless.has(item.id), { ...whole, type: options.type });
    const corner = parent ? { x: parent.x - parent.width / 2, y: parent.y - parent.height / 2 } : { x: 0, y: 0 };
    const place = {
      x: middle.x - corner.x + (whole.origin[0] - 0.5) * size.width,
      y: middle.y - corner.y + (whole.origin[1] - 0.5) * size.height,
    };
    const isOurs = isPlace(kept) && isOurPlace(node, kept, item, whole);
    node.position = isOurs ? { x: kept.x, y: kept.y } : place;
    if (!isPlace(kept)) {
      node.data["placed"] = node.position;
      node.data["asIs"] = true;
      if (item.position != null) node.data["position"] = item.position;
    }
    nodes.push(node);
    const within = new Middles([node], whole.origin).of({ ...node, parentId: undefined });
    middles.set(item.id, { x: corner.x + within.x, y: corner.y + within.y, ...size });
  }
  const edges: FlowEdge[] = [];
  const paints = new Map(options.layout?.hyperedges.map(({ id, color }) => [id, color]));
  for (const hyperedge of program.hyperedges ?? []) {
    takeHyperedge(hyperedge, paints.get(hyperedge.id), middles, nodes, edges);
  }
  return { nodes, edges };
}

function nodeOf(item: Item, kept: Kept, size: Size, needsMiddle: boolean, options: NodeOptions): FlowNode {
  const { scale, type } = options;
  const own = isPlace(kept) ? leave(item.data ?? {}, ["flow"]) : (item.data ?? {});
  const data: Record<string, unknown> = { ...pick(item, ITEM_FIELDS), ...kept.data };
  delete data["data"];
  if (Object.keys(own).length > 0) data["data"] = own;
  const points = item.attachment_points ?? [];
  const box = item.shape?.type === "box" ? item.shape.size : undefined;
  const handles = kept.handles ?? handlesOf(points, box ?? [2, 2]);
  const isLacking = needsMiddle && !handles.some(({ id }) => id === MIDDLE);
  data["handles"] = isLacking ? [...handles, { id: MIDDLE, side: "top" }] : handles;
  if (item.position != null) data["z"] = item.position[2];
  if (kept.asIs) data["asIs"] = true;
  else if (isPlace(kept) && box) {
    // What follows from the node is not said again, so that it goes on to follow from it.
    if (isSame(points, pointsOf(handles.filter(({ id }) => id !== MIDDLE), box))) delete data["attachment_points"];
    const [width, height] = [rounded(size.width / scale), rounded(size.height / scale)];
    if (kept.width !== undefined && isSame(box.slice(0, 2), [width, height])) delete data["shape"];
  }
  const name = kept.type ?? type;
  return {
    id: item.id,
    ...(name === undefined ? {} : { type: name }),
    position: { x: 0, y: 0 },
    ...(item.parent == null ? {} : { parentId: item.parent }),
    ...size,
    data,
  };
}

/** Whether the place in the plane that is kept means the item's position; else that has the last word. */
function isOurPlace(node: FlowNode, kept: Place, item: Item, options: Required<FlowOptions>): boolean {
  if (item.parent != null) return true;
  const there = { ...node, position: { x: kept.x, y: kept.y } };
  return isSame(programOf([there], [], options).items[0]?.position, item.position);
}

function middleIn(item: Item, number: number, parent: Place | undefined, scale: number): Place {
  const base = parent ?? { x: 0, y: 0 };
  if (item.position != null) {
    return { x: base.x + item.position[0] * scale, y: base.y - item.position[1] * scale };
  }
  const [column, row] = [number % COLUMNS, Math.floor(number / COLUMNS)];
  return { x: base.x + column * STEP.width, y: base.y + row * STEP.height };
}

function takeHyperedge(
  hyperedge: Hyperedge,
  paint: string | undefined,
  middles: ReadonlyMap<string, Place>,
  nodes: FlowNode[],
  edges: FlowEdge[],
): void {
  const { id, attachments } = hyperedge;
  const kept = keptOf(hyperedge);
  const own = isPlace(kept) || kept.edge ? leave(hyperedge.data ?? {}, ["flow"]) : (hyperedge.data ?? {});
  const data: Record<string, unknown> = { ...pick(hyperedge, HYPEREDGE_FIELDS), ...kept.data };
  if (paint !== undefined) data["paint"] = paint;
  delete data["data"];
  if (Object.keys(own).length > 0) data["data"] = own;
  const [first, second] = attachments;
  if (kept.edge && first && second && attachments.length === 2) {
    const handles = { sourceHandle: first.point ?? MIDDLE, targetHandle: second.point ?? MIDDLE };
    edges.push({ id, source: first.item, target: second.item, ...handles, data });
    return;
  }
  const position = isPlace(kept) ? { x: kept.x, y: kept.y } : between(attachments, middles);
  if (!isPlace(kept)) data["placed"] = position;
  nodes.push({ id, type: JUNCTION, position, data });
  for (const end of attachments) {
    edges.push({ ...lineOf(id, end), ...(paint === undefined ? {} : { data: { paint } }) });
  }
}

/** The line from an item's handle to a hyperedge's junction. */
export function lineOf(hyperedge: string, { item, point }: Attachment): FlowEdge {
  const handle = point ?? MIDDLE;
  return {
    id: JSON.stringify([hyperedge, item, handle]),
    source: item,
    sourceHandle: handle,
    target: hyperedge,
    targetHandle: null,
  };
}

function between(attachments: readonly Attachment[], middles: ReadonlyMap<string, Place>): Place {
  const places = attachments.map(({ item }) => middles.get(item)).filter((place) => place !== undefined);
  const sum = places.reduce((all, { x, y }) => ({ x: all.x + x, y: all.y + y }), { x: 0, y: 0 });
  return { x: sum.x / Math.max(places.length, 1), y: sum.y / Math.max(places.length, 1) };
}

/** What is kept; `flow` may also be somebody else's word. */
function keptOf({ data }: { data?: Record<string, unknown> | null }): Kept {
  const kept = (data?.["flow"] ?? {}) as Kept;
  return isPlace(kept) || kept.edge === true ? kept : {};
}

/** React Flow wants containers before what they contain. */
function parentsFirst(items: readonly Item[]): Item[] {
  const byId = new Map(items.map((item) => [item.id, item]));
  const found = new Map<string, Item>();
  const take = (item: Item): void => {
    if (found.has(item.id)) return;
    const parent = item.parent == null ? undefined : byId.get(item.parent);
    if (parent) take(parent);
    found.set(item.id, item);
  };
  items.forEach(take);
  return [...found.values()];
}
