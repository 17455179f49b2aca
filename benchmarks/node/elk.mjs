// Lays out hypergraphs with ELK's layered algorithm and orthogonal edges: one JSON document a line
// in, one a line out. ELK moves the nodes. It takes hyperedges as edges from one port to many nodes.
import { createInterface } from 'node:readline';
import ELK from 'elkjs/lib/elk.bundled.js';

const elk = new ELK();

function graph({ items, hyperedges }) {
  const ports = items.map(() => []);
  const edges = hyperedges.flatMap((hyperedge, k) => {
    const ends = hyperedge.map(([item], n) => {
      const id = `p${k}.${n}`;
      ports[item].push({ id, width: 0, height: 0 });
      return id;
    });
    return ends.slice(1).map((end, n) => ({ id: `${k}.${n}`, sources: [ends[0]], targets: [end] }));
  });
  return {
    id: 'root',
    layoutOptions: {
      'elk.algorithm': 'layered',
      'elk.edgeRouting': 'ORTHOGONAL',
      'elk.randomSeed': '1',
      'elk.spacing.edgeEdge': '0.45',
      'elk.spacing.edgeNode': '0.45',
      'elk.layered.spacing.edgeEdgeBetweenLayers': '0.45',
      'elk.layered.spacing.edgeNodeBetweenLayers': '0.45',
      'elk.spacing.nodeNode': '0.65',
      'elk.layered.spacing.nodeNodeBetweenLayers': '0.65',
    },
    children: items.map(([, , width, height], number) => ({
      id: `i${number}`,
      width,
      height,
      ports: ports[number],
      layoutOptions: { 'elk.portConstraints': 'FREE' },
    })),
    edges,
  };
}

for await (const line of createInterface({ input: process.stdin })) {
  const laid = await elk.layout(graph(JSON.parse(line)));
  const lines = laid.edges.flatMap(({ id, sections = [] }) =>
    sections.map(({ startPoint, bendPoints = [], endPoint }) => [
      Number(id.split('.')[0]),
      [startPoint, ...bendPoints, endPoint].map(({ x, y }) => [x, y]),
    ]),
  );
  process.stdout.write(`${JSON.stringify(lines)}\n`);
}
