import { flowOf, JUNCTION, type FlowNode, type ThingName } from "tubeloom-react-flow";
import type { Client, ProgramDocument } from "tubeloom-client";
import type { Edge } from "@xyflow/react";
import { DOT_SIZE, ORIGIN, settled, titleOf, type AppNode, type Graph } from "./graph.ts";

/** Lower nodes have room for a label only. */
const SMALL = 48;

/** The graph of a program; where items stand is asked of the service if the program does not say. */
export async function graphOf(program: ProgramDocument, client: Client): Promise<Graph> {
  const isPlaced = program.items.every((item) => item.position != null);
  return isPlaced ? graphAtOnce(program) : graphAtOnce(program, await client.layout(program));
}

function graphAtOnce(program: ProgramDocument, layout?: Awaited<ReturnType<Client["layout"]>>): Graph {
  const { nodes, edges } = flowOf(program, { origin: ORIGIN, type: "item", ...(layout && { layout }) });
  const containers = new Set(nodes.map(({ parentId }) => parentId));
  return settled({ nodes: nodes.map((node) => typed(node, containers.has(node.id))), edges: edges as Edge[] });
}

function typed(node: FlowNode, isContainer: boolean): AppNode {
  const dot = node.type === JUNCTION ? { width: DOT_SIZE, height: DOT_SIZE } : {};
  const isSmall = (node.height ?? 0) < SMALL && node.type !== JUNCTION;
  const look = isContainer ? { className: "container" } : isSmall ? { className: "small" } : {};
  return { ...node, ...dot, ...look } as AppNode;
}

/** The graph `after`, where what was selected in `before` is so still, and what was measured. */
export function keptSelection(before: Graph, after: Graph): Graph {
  const nodes = new Map(before.nodes.map((node) => [node.id, node]));
  const edges = new Set(before.edges.filter(({ selected }) => selected).map(({ id }) => id));
  return {
    nodes: after.nodes.map((node) => {
      const old = nodes.get(node.id);
      return old ? { ...node, selected: old.selected ?? false, ...(old.measured && { measured: old.measured }) } : node;
    }),
    edges: after.edges.map((edge) => ({ ...edge, selected: edges.has(edge.id) })),
  };
}

/** What is selected, by the program's names: a line selects its hyperedge. */
export function selectionOf({ nodes, edges }: Graph): ThingName[] {
  const found = new Map<string, ThingName>();
  const take = (shows: ThingName["shows"], id: string) => found.set(`${shows} ${id}`, { shows, id });
  for (const { id, type, selected } of nodes) if (selected) take(type === JUNCTION ? "hyperedge" : "item", id);
  for (const { target, selected } of edges) if (selected) take("hyperedge", target);
  return [...found.values()];
}

/** The graph with exactly these selected. */
export function selected(graph: Graph, things: readonly ThingName[]): Graph {
  const ids = new Set(things.map(({ id }) => id));
  return {
    nodes: graph.nodes.map((node) => ({ ...node, selected: ids.has(node.id) })),
    edges: graph.edges.map((edge) => (edge.selected ? { ...edge, selected: false } : edge)),
  };
}

/**
 * The graph with what depends on it: names for those who hear it, and hyperedges' colours on their
 * dots and lines, where they have none of their own by `paints`.
 */
export function dressed({ nodes, edges }: Graph, paints: ReadonlyMap<string, string>): Graph {
  const paintOf = (junction: AppNode | undefined) => junction?.data["color"] ?? paints.get(junction?.id ?? "");
  const byId = new Map(nodes.map((node) => [node.id, node]));
  const members = (id: string) =>
    edges.filter(({ target }) => target === id).map(({ source }) => titleOf(byId.get(source)));
  return {
    nodes: nodes.map((node) => {
      const title = titleOf(node);
      if (node.type !== JUNCTION) return { ...node, ariaLabel: `${String(node.data["kind"] ?? "item")} ${title}` };
      const ariaLabel = `Hyperedge ${title}, joins ${members(node.id).join(", ")}`;
      const data = node.data["color"] === undefined ? { ...node.data, paint: paintOf(node) } : node.data;
      return { ...node, zIndex: 10, ariaLabel, data };
    }),
    edges: edges.map((edge) => {
      const junction = byId.get(edge.target);
      const ariaLabel = `Line from ${titleOf(byId.get(edge.source))} to hyperedge ${titleOf(junction)}`;
      return { ...edge, type: "line", ariaLabel, data: { color: paintOf(junction) } };
    }),
  };
}
