import { joined, NODE_SIZE, type AppNode, type Graph } from "./graph.ts";
import { KINDS } from "./kinds.ts";

const PLACES: readonly [id: string, kind: string, label: string, x: number, y: number][] = [
  ["ada", "constant", "Ada", 0, 0],
  ["x", "variable", "X", 0, 176],
  ["grandparent", "relation", "grandparent", 272, 0],
  ["parent-1", "relation", "parent", 272, 224],
  ["y", "variable", "Y", 528, 96],
  ["parent-2", "relation", "parent", 528, 224],
];

/** A rule of logic, to begin with: who is a parent of a parent is a grandparent. */
export function example(): Graph {
  const nodes = PLACES.map(([id, name, label, x, y]): AppNode => {
    const kind = KINDS.find((each) => each.name === name);
    const data = { label, kind: name, color: kind?.color, handles: kind?.handles };
    return { id, type: "item", position: { x, y }, ...NODE_SIZE, data };
  });
  const first = joined({ nodes, edges: [] }, [
    { item: "x", handle: "right" },
    { item: "grandparent", handle: "left" },
    { item: "parent-1", handle: "left" },
  ]);
  return joined(first, [
    { item: "parent-1", handle: "right" },
    { item: "parent-2", handle: "left" },
  ]);
}
