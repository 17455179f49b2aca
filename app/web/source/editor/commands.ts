import { JUNCTION } from "tubeloom-react-flow";
import { endOf, joined, mean, settled, type End, type Graph } from "./graph.ts";

/** Join the chosen handles, and a handle of each selected node beside them. */
export function joinChosen(graph: Graph, picked: ReadonlySet<string>): Graph {
  const ends = [...picked].map((key) => {
    const [item, handle] = JSON.parse(key) as [string, string];
    return { item, handle };
  });
  const nodes = graph.nodes.filter(({ id, selected }) => selected && !ends.some(({ item }) => item === id));
  const junctions = new Set(nodes.filter(({ type }) => type === JUNCTION).map(({ id }) => id));
  for (const { target, selected } of graph.edges) if (selected) junctions.add(target);
  const near = { x: mean(nodes.map(({ position }) => position.x)), y: mean(nodes.map(({ position }) => position.y)) };
  const others: End[] = [];
  for (const node of nodes) {
    if (node.type === JUNCTION) continue;
    const end = endOf(graph, node, near);
    if (end) others.push(end);
  }
  return joined(graph, [...ends, ...others], [...junctions]);
}

/** How much would be joined. */
export function countChosen(graph: Graph, picked: ReadonlySet<string>): number {
  const owners = new Set([...picked].map((key) => (JSON.parse(key) as [string, string])[0]));
  const nodes = graph.nodes.filter(({ id, selected }) => selected && !owners.has(id)).length;
  return picked.size + nodes + new Set(graph.edges.filter(({ selected }) => selected).map(({ target }) => target)).size;
}

/** Without what is selected, and without what is contained in it. */
export function removed({ nodes, edges }: Graph): Graph {
  const gone = new Set<string>();
  for (const { id, parentId, selected } of nodes) {
    if (selected || (parentId !== undefined && gone.has(parentId))) gone.add(id);
  }
  return settled({
    nodes: nodes.filter(({ id }) => !gone.has(id)),
    edges: edges.filter(({ selected }) => !selected),
  });
}

/** With another label for a node. */
export function renamed(graph: Graph, id: string, label: string): Graph {
  const nodes = graph.nodes.map((node) => {
    if (node.id !== id) return node;
    const { label: _, ...rest } = node.data;
    return { ...node, data: label === "" ? rest : { ...rest, label } };
  });
  return { ...graph, nodes };
}
