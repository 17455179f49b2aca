// Tries the adapter on the real service, by node's own test runner.
import { Client, type ProgramDocument } from "tubeloom-client";
import { editsBetween } from "./edits-between.js";
import { flowOf } from "./flow-of.js";
import type { FlowEdge, FlowNode } from "./graph.js";
import { programOf } from "./program-of.js";
import { chance, deepEqual, environment, equal, ok, pick, randomProgram, sorted, test } from "./trying.js";

const tubeloom = new Client(environment("TUBELOOM_URL"));
const ROUNDS = Number(environment("ROUNDS"));

async function kept(name: string, document: ProgramDocument): Promise<ProgramDocument> {
  const program = tubeloom.program(name);
  await program.put(document);
  return program.get();
}

test("edits between any two programs lead from one to the other", async () => {
  const random = chance(20261128);
  for (let round = 0; round < ROUNDS; round += 1) {
    const [before, after] = [randomProgram(random), randomProgram(random)];
    const program = tubeloom.program("edited");
    await program.put(before);
    const edits = editsBetween(await program.get(), after);
    if (edits.length > 0) await program.edit(...edits);
    const wanted = await kept("wanted", after);
    const found = await program.get();
    deepEqual(sorted(found), sorted(wanted), `round ${round}: ${JSON.stringify(edits)}`);
    deepEqual(editsBetween(found, wanted), []);
  }
});

test("what is the same is in no edit", async () => {
  const random = chance(7);
  for (let round = 0; round < ROUNDS; round += 1) {
    const before = randomProgram(random);
    const item = pick(random, before.items);
    const items = before.items.map((each) => (each === item ? { ...each, label: "Another" } : each));
    deepEqual(editsBetween(before, { ...before, items }), [
      { type: "set_item", id: item.id, fields: { label: "Another" } },
    ]);
    deepEqual(editsBetween(before, before), []);
    deepEqual(editsBetween(await kept("same", before), before), []);
  }
});

test("a program that others made comes back from the graph as it was", async () => {
  const random = chance(11);
  for (let round = 0; round < ROUNDS; round += 1) {
    const program = await kept("others", randomProgram(random));
    const { items: _, hyperedges: __, ...frame } = program;
    const layout = round % 2 === 0 ? { layout: await tubeloom.layout(program) } : {};
    for (const origin of [[0, 0], [0.5, 0.5]] as [number, number][]) {
      const { nodes, edges } = flowOf(program, { ...layout, origin });
      deepEqual(editsBetween(program, programOf(nodes, edges, { frame, origin })), []);
    }
  }
});

test("edges have the colours of tubes, which are not the program's", async () => {
  const ends = ["a", "b", "c"].map((item) => ({ item }));
  const [one, two] = [{ id: "one", attachments: ends }, { id: "two", attachments: ends.slice(1), data: { flow: { edge: true } } }];
  const program = await kept("painted", { items: ends.map(({ item }) => ({ id: item })), hyperedges: [one, two] });
  const layout = await tubeloom.program("painted").layout();
  const colors = layout.hyperedges.map(({ color }) => color);
  const { nodes, edges } = flowOf(program, { layout });
  equal(nodes.find(({ id }) => id === "one")?.data["paint"], colors[0]);
  deepEqual(edges.map(({ data }) => data?.["paint"]), [colors[0], colors[0], colors[0], colors[1]]);
  deepEqual(editsBetween(program, programOf(nodes, edges)), []);
});

test("an item that others made keeps its shape when its node is moved", async () => {
  const items = [{ id: "tray" }, { id: "in", parent: "tray", color: "#112233" }];
  const program = await kept("moved", { items });
  const { nodes, edges } = flowOf(program, { layout: await tubeloom.layout(program) });
  const moved = nodes.map((each) => ({ ...each, position: { x: each.position.x + 96, y: each.position.y } }));
  const after = await kept("moved", programOf(moved, edges));
  deepEqual(after.items.map(({ shape }) => shape), [undefined, undefined]);
  deepEqual(after.items.map(({ position }) => position?.length), [3, 3]);
  const again = flowOf(after);
  deepEqual(editsBetween(after, programOf(again.nodes, again.edges)), []);
});

const HANDLES = [{ id: "in", side: "left" }, { id: "out", side: "right", along: 0.25 }];

function node(id: string, x: number, y: number, data: object = {}): FlowNode {
  const size = { width: 96, height: 48 };
  return { id, type: "box", position: { x, y }, ...size, data: { label: id, handles: HANDLES, ...data } };
}

function line(source: string, sourceHandle: string, target: string, targetHandle?: string): FlowEdge {
  return { id: `${source}-${target}`, source, sourceHandle, target, targetHandle: targetHandle ?? null };
}

const NODES: FlowNode[] = [
  node("a", 0, 0, { color: "#336699", data: { line: 12 }, note: { mine: [1, 2] } }),
  node("b", 240.5, 96),
  node("c", 480, -96),
  { id: "all", type: "junction", position: { x: 200, y: 20 }, data: { label: "All", color: "#aa3300" } },
];
const EDGES: FlowEdge[] = [
  line("a", "out", "all"),
  line("b", "in", "all"),
  line("c", "in", "all"),
  { ...line("a", "in", "b", "out"), data: { label: "Two" } },
];

test("nodes become items, a junction one hyperedge, an edge a hyperedge of two", async () => {
  const program = await kept("graph", programOf(NODES, EDGES));
  const [first] = program.items;
  deepEqual(first?.position, [1, -0.5, 0.25], "the middle of the node, in units");
  deepEqual(first?.shape, { type: "box", size: [2, 1, 0.5] });
  deepEqual(first?.attachment_points?.map(({ id, position }) => [id, position]), [
    ["in", [-0.78, 0, 0.25]],
    ["out", [0.78, 0.14, 0.25]],
  ]);
  deepEqual(program.hyperedges?.map(({ id, attachments }) => [id, attachments]), [
    ["all", [{ item: "a", point: "out" }, { item: "b", point: "in" }, { item: "c", point: "in" }]],
    ["a-b", [{ item: "a", point: "in" }, { item: "b", point: "out" }]],
  ]);
});

test("the graph comes back from the program, and the program from that", async () => {
  const program = await kept("graph", programOf(NODES, EDGES));
  const { nodes, edges } = flowOf(program);
  for (const [number, found] of nodes.entries()) {
    const wanted = NODES[number];
    equal(found.id, wanted?.id);
    equal(found.type, wanted?.type);
    deepEqual(found.position, wanted?.position);
    const { z: _, ...data } = found.data;
    deepEqual(data, wanted?.data);
  }
  equal(edges.length, EDGES.length);
  deepEqual(editsBetween(program, programOf(nodes, edges)), []);
});

test("to move a node is one edit, and a third connection another", async () => {
  const before = programOf(NODES, EDGES);
  const moved = NODES.map((each) => (each.id === "b" ? { ...each, position: { x: 288, y: 96 } } : each));
  const edits = editsBetween(before, programOf(moved, EDGES));
  deepEqual(edits, [
    { type: "set_item", id: "b", fields: { position: [7, -2.5, 0.25], data: { flow: { x: 288 } } } },
  ]);
  const more = editsBetween(before, programOf(NODES, [...EDGES, line("c", "out", "all")]));
  deepEqual(more, [{ type: "connect", id: "all", attachments: [{ item: "c", point: "out" }] }]);
});

test("an item that somebody moves in space moves in the graph", async () => {
  const program = programOf(NODES, EDGES);
  const items = program.items.map((item) => (item.id === "a" ? { ...item, position: [3, 2, 0.25] as [number, number, number] } : item));
  const found = flowOf({ ...program, items }).nodes[0];
  deepEqual(found?.position, { x: 3 * 48 - 48, y: -2 * 48 - 24 });
  ok(flowOf(program).nodes[0]?.position.x === 0);
});
