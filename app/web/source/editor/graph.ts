import type { Edge, Node } from "@xyflow/react";
import { JUNCTION, lineOf, Middles, type FlowHandle } from "tubeloom-react-flow";
import { HYPEREDGE_COLORS, type Kind } from "./kinds.ts";

export type AppNode = Node<Record<string, unknown>>;

/** What React Flow shows: items and junctions, and the lines from handles to junctions. */
export interface Graph {
  nodes: AppNode[];
  edges: Edge[];
}

/** A handle of an item. */
export interface End {
  item: string;
  handle: string;
}

export const ORIGIN: [number, number] = [0.5, 0.5];
export const NODE_SIZE = { width: 160, height: 56 };
export const DOT_SIZE = 18;
const GAP = 32;

export function handlesOf(node: AppNode): readonly FlowHandle[] {
  return (node.data["handles"] ?? []) as readonly FlowHandle[];
}

export function titleOf(node: AppNode | undefined): string {
  return String(node?.data["label"] || node?.id || "");
}

/** The junctions at a handle. */
export function junctionsAt({ edges }: Graph, { item, handle }: End): string[] {
  const there = edges.filter(({ source, sourceHandle }) => source === item && sourceHandle === handle);
  return there.map(({ target }) => target);
}

/**
 * One hyperedge that joins all `ends`, and whatever the hyperedges join that are at them already, or
 * that are named.
 */
export function joined(graph: Graph, ends: readonly End[], named: readonly string[] = []): Graph {
  const touched = [...new Set([...named, ...ends.flatMap((end) => junctionsAt(graph, end))])];
  const [kept = freeId(graph, "hyperedge"), ...others] = touched;
  const old = graph.edges.filter(({ target }) => touched.includes(target));
  const all = [...old.map((edge) => ({ item: edge.source, handle: edge.sourceHandle ?? "" })), ...ends];
  const once = [...new Map(all.map((end) => [`${end.item} ${end.handle}`, end])).values()];
  if (once.length < 2) return graph;
  const lines = once.map(({ item, handle }) => lineOf(kept, { item, point: handle }) as Edge);
  const nodes = graph.nodes.filter(({ id }) => !others.includes(id));
  if (touched.length === 0) nodes.push(junctionOf(kept, freeColor(graph)));
  return settled({ nodes, edges: [...graph.edges.filter((edge) => !touched.includes(edge.target)), ...lines] });
}

/** A handle of the node that joins nothing yet, near to a place; any handle where there is none. */
export function endOf(graph: Graph, node: AppNode, near: { x: number; y: number }): End | undefined {
  const middles = new Middles(graph.nodes, ORIGIN);
  const far = (handle: FlowHandle) => {
    const { x, y } = placeOf(handle, node, middles);
    return Math.hypot(x - near.x, y - near.y);
  };
  const sorted = [...handlesOf(node)].sort((one, other) => far(one) - far(other));
  const free = sorted.find(({ id }) => junctionsAt(graph, { item: node.id, handle: id }).length === 0);
  const handle = free ?? sorted[0];
  return handle && { item: node.id, handle: handle.id };
}

/** Without hyperedges that join less than two, and with junctions amid what they join. */
export function settled({ nodes, edges }: Graph): Graph {
  const known = new Map(nodes.map((node) => [node.id, node]));
  const lines = edges.filter(({ source, target }) => known.has(source) && known.has(target));
  const counts = new Map<string, number>();
  for (const { target } of lines) counts.set(target, (counts.get(target) ?? 0) + 1);
  const middles = new Middles(nodes, ORIGIN);
  const kept = nodes.filter(({ id, type }) => type !== JUNCTION || (counts.get(id) ?? 0) > 1);
  const shown = kept.map((node) => {
    const placed = node.data["placed"] as { x: number; y: number } | undefined;
    if (node.type !== JUNCTION || !placed || placed.x !== node.position.x || placed.y !== node.position.y) return node;
    const ends = lines.filter(({ target }) => target === node.id).map((line) => placeOfEnd(line, known, middles));
    const position = { x: mean(ends.map(({ x }) => x)), y: mean(ends.map(({ y }) => y)) };
    if (position.x === placed.x && position.y === placed.y) return node;
    return { ...node, position, data: { ...node.data, placed: position } };
  });
  const left = new Set(shown.map(({ id }) => id));
  return { nodes: shown, edges: lines.filter(({ target }) => left.has(target)) };
}

/** A new item at the first free place near another one. */
export function added(graph: Graph, kind: Kind, near: { x: number; y: number }): { graph: Graph; id: string } {
  const id = freeId(graph, kind.name);
  const number = id.slice(id.lastIndexOf("-") + 1);
  const node: AppNode = {
    id,
    type: "item",
    position: freePlace(graph, near),
    ...NODE_SIZE,
    selected: true,
    data: { label: `${kind.title} ${number}`, kind: kind.name, color: kind.color, handles: kind.handles },
  };
  const nodes = graph.nodes.map((each) => (each.selected ? { ...each, selected: false } : each));
  return { graph: { nodes: [...nodes, node], edges: graph.edges.map((edge) => ({ ...edge, selected: false })) }, id };
}

function junctionOf(id: string, color: string): AppNode {
  const position = { x: 0, y: 0 };
  return { id, type: JUNCTION, position, width: DOT_SIZE, height: DOT_SIZE, data: { color, placed: position } };
}

function placeOfEnd(line: Edge, nodes: ReadonlyMap<string, AppNode>, middles: Middles): { x: number; y: number } {
  const node = nodes.get(line.source);
  if (node === undefined) return { x: 0, y: 0 };
  const handle = handlesOf(node).find(({ id }) => id === line.sourceHandle);
  return handle ? placeOf(handle, node, middles) : middles.of(node);
}

function placeOf({ side, along = 0.5 }: FlowHandle, node: AppNode, middles: Middles): { x: number; y: number } {
  const { x, y } = middles.of(node);
  const [width, height] = [node.width ?? NODE_SIZE.width, node.height ?? NODE_SIZE.height];
  // A little outside: a dot between handles shall not lie on a node.
  if (side === "left" || side === "right") {
    return { x: x + (side === "left" ? -1 : 1) * (width / 2 + GAP), y: y + (along - 0.5) * height };
  }
  return { x: x + (along - 0.5) * width, y: y + (side === "top" ? -1 : 1) * (height / 2 + GAP) };
}

function freeId({ nodes }: Graph, name: string): string {
  const used = new Set(nodes.map(({ id }) => id));
  for (let number = 1; ; number += 1) if (!used.has(`${name}-${number}`)) return `${name}-${number}`;
}

function freeColor({ nodes }: Graph): string {
  const uses = (color: string) => nodes.filter((node) => node.type === JUNCTION && node.data["color"] === color).length;
  return HYPEREDGE_COLORS.reduce((best, color) => (uses(color) < uses(best) ? color : best));
}

function freePlace(graph: Graph, near: { x: number; y: number }): { x: number; y: number } {
  const middles = new Middles(graph.nodes, ORIGIN);
  const taken = graph.nodes.filter(({ type }) => type !== JUNCTION).map((node) => middles.of(node));
  const [width, height] = [NODE_SIZE.width + GAP, NODE_SIZE.height + GAP];
  const isFree = (x: number, y: number) =>
    taken.every((each) => Math.abs(each.x - x) >= width || Math.abs(each.y - y) >= height);
  for (let ring = 0; ; ring += 1) {
    for (let row = -ring; row <= ring; row += 1) {
      for (let column = -ring; column <= ring; column += 1) {
        if (Math.max(Math.abs(row), Math.abs(column)) !== ring) continue;
        const [x, y] = [near.x + column * width, near.y + row * height].map(Math.round) as [number, number];
        if (isFree(x, y)) return { x, y };
      }
    }
  }
}

export function mean(values: readonly number[]): number {
  return Math.round(values.reduce((sum, value) => sum + value, 0) / Math.max(values.length, 1));
}
