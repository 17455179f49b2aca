import type { ProgramDocument } from "tubeloom-client";
import {
  complete,
  HYPEREDGE_FIELDS,
  isSame,
  ITEM_FIELDS,
  JUNCTION,
  leave,
  MIDDLE,
  OWN_FIELDS,
  pick,
  rounded,
  type Attachment,
  type FlowEdge,
  type FlowHandle,
  type FlowNode,
  type FlowOptions,
  type Hyperedge,
  type Item,
} from "./graph.js";
import { Middles, pointsOf, sizeOf } from "./places.js";

/** All of a program but its items and hyperedges. */
export type Frame = Omit<ProgramDocument, "items" | "hyperedges">;

/**
 * The program that a graph means: nodes are items, with attachment points where they have handles;
 * a node of the type `junction` is one hyperedge that joins all handles from which edges lead to it;
 * an edge from handle to handle is a hyperedge of two.
 *
 * Where nodes are in the plane is kept in the items' `data.flow`.
 */
export function programOf(
  nodes: readonly FlowNode[],
  edges: readonly FlowEdge[],
  options: FlowOptions & { frame?: Frame } = {},
): ProgramDocument {
  const things = nodes.filter(({ type }) => type !== JUNCTION);
  const middles = new Middles(nodes, complete(options).origin);
  const items = things.map((node) => itemOf(node, middles, complete(options)));
  const points = new Map(
    items.map(({ id, attachment_points }) => [id, new Set(attachment_points?.map((point) => point.id))]),
  );
  const end = (node: string, handle: string | null | undefined): Attachment | undefined => {
    const known = points.get(node);
    if (known === undefined) return undefined;
    return handle != null && handle !== MIDDLE && known.has(handle) ? { item: node, point: handle } : { item: node };
  };
  const hyperedges: Hyperedge[] = [];
  for (const node of nodes) {
    if (node.type !== JUNCTION) continue;
    const ends = edges.map((edge) => {
      if (edge.target === node.id) return end(edge.source, edge.sourceHandle);
      return edge.source === node.id ? end(edge.target, edge.targetHandle) : undefined;
    });
    const attachments = onceEach(ends);
    const flow = isSame(node.data["placed"], node.position) ? {} : placeOf(node);
    if (attachments.length > 1) hyperedges.push(hyperedgeOf(node.id, node.data, attachments, flow));
  }
  for (const { id, data = {}, source, sourceHandle, target, targetHandle } of edges) {
    if (!points.has(source) || !points.has(target)) continue;
    const attachments = onceEach([end(source, sourceHandle), end(target, targetHandle)]);
    const flow = { edge: true };
    if (attachments.length > 1) hyperedges.push(hyperedgeOf(id, data, attachments, flow));
  }
  return { ...options.frame, items, hyperedges };
}

function itemOf(node: FlowNode, middles: Middles, options: Required<FlowOptions>): Item {
  const { id, type, parentId, data } = node;
  const fields = pick(data, ITEM_FIELDS) as Partial<Item>;
  const parent = parentId === undefined ? {} : { parent: parentId };
  const own = fields.data ?? {};
  if (isSame(data["placed"], node.position)) {
    const position = pick(data, ["position"]) as Partial<Item>;
    return { ...fields, id, ...parent, ...position, ...(isEmpty(own) ? {} : { data: own }) };
  }
  const { scale, height } = options;
  const size = sizeOf(node);
  // Whoever made the item has said all of its shape; the node was only fitted to it.
  const isAsIs = data["asIs"] === true;
  const box = size && !isAsIs && [rounded(size.width / scale), rounded(size.height / scale), height];
  const shape = fields.shape ?? (box ? { type: "box" as const, size: box as [number, number, number] } : undefined);
  const handles = (data["handles"] ?? []) as readonly FlowHandle[];
  const named = handles.filter((handle) => handle.id !== MIDDLE);
  const points = fields.attachment_points ?? (box ? pointsOf(named, box) : []);
  const { x, y } = middles.within(node);
  const z = (data["z"] as number | undefined) ?? (parentId === undefined ? height / 2 : height);
  const rest = leave(data, [...ITEM_FIELDS, ...OWN_FIELDS]);
  const flow = {
    ...placeOf(node),
    ...size,
    ...(type === undefined ? {} : { type }),
    ...(isAsIs ? { asIs: true } : {}),
    ...(handles.length > 0 ? { handles } : {}),
    ...(isEmpty(rest) ? {} : { data: rest }),
  };
  return {
    ...fields,
    id,
    ...parent,
    ...(shape ? { shape } : {}),
    position: [rounded(x / scale), rounded(-y / scale), z],
    ...(points.length > 0 ? { attachment_points: points } : {}),
    data: { ...own, flow } as NonNullable<Item["data"]>,
  };
}

function hyperedgeOf(id: string, data: object, attachments: Attachment[], flow: object): Hyperedge {
  const fields = pick(data, HYPEREDGE_FIELDS) as Partial<Hyperedge>;
  const rest = leave(data, [...HYPEREDGE_FIELDS, ...OWN_FIELDS]);
  const kept = { ...flow, ...(isEmpty(rest) ? {} : { data: rest }) };
  const own: object = { ...fields.data, ...(isEmpty(flow) ? {} : { flow: kept }) };
  return { ...fields, id, attachments, ...(isEmpty(own) ? {} : { data: own as NonNullable<Hyperedge["data"]> }) };
}

function placeOf({ position: { x, y } }: FlowNode): { x: number; y: number } {
  return { x: rounded(x), y: rounded(y) };
}

function onceEach(ends: readonly (Attachment | undefined)[]): Attachment[] {
  const found = new Map<string, Attachment>();
  for (const end of ends) if (end) found.set(JSON.stringify([end.item, end.point]), end);
  return [...found.values()];
}

function isEmpty(value: object): boolean {
  return Object.keys(value).length === 0;
}
