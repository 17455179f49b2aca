import { LGraph, LGraphCanvas, LGraphNode, LiteGraph } from "litegraph.js/build/litegraph.core.js";
import { Client, Problem, type Edit, type ProgramDocument } from "tubeloom-client";
import { admitted, keyOf } from "../key.ts";
import "../tube-viewer.ts";

type Item = ProgramDocument["items"][number];
type Hyperedge = NonNullable<ProgramDocument["hyperedges"]>[number];

const PIXELS = 60;
const LOOK_MILLISECONDS = 40;
const RETRY_MILLISECONDS = 1000;

/** The kinds of nodes: what goes in, what comes out. */
const KINDS: Record<string, { inputs: string[]; outputs: string[]; color: string }> = {
  Sensor: { inputs: [], outputs: ["value"], color: "#8fb8ee" },
  Mixer: { inputs: ["a", "b"], outputs: ["sum"], color: "#7fc6a4" },
  Gauge: { inputs: ["value"], outputs: [], color: "#e3b34f" },
};

for (const [kind, { inputs, outputs }] of Object.entries(KINDS)) {
  class KindNode extends LGraphNode {
    constructor() {
      super(kind);
      for (const name of inputs) this.addInput(name, "signal");
      for (const name of outputs) this.addOutput(name, "signal");
      this.size = [150, 30 + 20 * Math.max(inputs.length, outputs.length)];
    }
  }
  LiteGraph.registerNodeType(`flow/${kind}`, KindNode as never);
}

/** The program that a graph means: nodes are items, an output with all its inputs is a hyperedge. */
function programOf(graph: LGraph): ProgramDocument {
  const nodes = graph.serialize().nodes.map(({ id }) => graph.getNodeById(id)).filter((node) => node != null);
  const items: Item[] = [];
  const hyperedges: Hyperedge[] = [];
  for (const node of nodes) {
    const [width, height] = node.size;
    const middle = [node.pos[0] + width / 2, node.pos[1] + height / 2] as const;
    const point = (isInput: boolean, slot: number) => {
      const [, y] = node.getConnectionPos(isInput, slot);
      const x = (isInput ? -1 : 1) * (width / 2 / PIXELS - 0.25);
      return { id: `${isInput ? "in" : "out"}${slot}`, position: vector(x, (middle[1] - y) / PIXELS, 0.25) };
    };
    const color = KINDS[node.title]?.color;
    items.push({
      id: String(node.id),
      label: node.title,
      ...(color ? { color } : {}),
      shape: { type: "box", size: vector(width / PIXELS, height / PIXELS, 0.5) },
      position: vector(middle[0] / PIXELS, -middle[1] / PIXELS, 0.25),
      attachment_points: [
        ...(node.inputs ?? []).map((_, slot) => point(true, slot)),
        ...(node.outputs ?? []).map((_, slot) => point(false, slot)),
      ],
    });
    for (const [slot, { links }] of (node.outputs ?? []).entries()) {
      const ends = (links ?? []).flatMap((link) => graph.links[link] ?? []);
      if (ends.length === 0) continue;
      const inputs = ends.map((end) => ({ item: String(end.target_id), point: `in${end.target_slot}` }));
      const attachments = [{ item: String(node.id), point: `out${slot}` }, ...inputs];
      hyperedges.push({ id: `${node.id}.${slot}`, attachments });
    }
  }
  return { name: "Signals", items, hyperedges };
}

function vector(...numbers: [number, number, number]): [number, number, number] {
  return numbers.map((number) => Math.round(number * 1000) / 1000 || 0) as [number, number, number];
}

/** The edits that lead from one program to the other. */
function editsBetween(before: ProgramDocument, after: ProgramDocument): Edit[] {
  const edits: Edit[] = [];
  const [items, hyperedges] = [mapOf(before.items), mapOf(before.hyperedges ?? [])];
  const [itemsAfter, hyperedgesAfter] = [mapOf(after.items), mapOf(after.hyperedges ?? [])];
  for (const id of hyperedges.keys()) if (!hyperedgesAfter.has(id)) edits.push({ type: "remove_hyperedge", id });
  for (const item of after.items) {
    const old = items.get(item.id);
    const { id, ...fields } = item;
    if (!old) edits.push({ type: "add_item", item });
    else if (!isSame(old, item)) edits.push({ type: "set_item", id, fields: fields as never });
  }
  for (const hyperedge of hyperedgesAfter.values()) {
    const { id, attachments } = hyperedge;
    const old = hyperedges.get(id);
    if (!old) edits.push({ type: "add_hyperedge", hyperedge });
    else {
      const added = attachments.filter((end) => !old.attachments.some((each) => isSame(each, end)));
      const gone = old.attachments.filter((end) => !attachments.some((each) => isSame(each, end)));
      if (added.length > 0) edits.push({ type: "connect", id, attachments: added });
      if (gone.length > 0) edits.push({ type: "disconnect", id, attachments: gone });
    }
  }
  for (const id of items.keys()) if (!itemsAfter.has(id)) edits.push({ type: "remove_item", id });
  return edits;
}

function mapOf<Part extends { id: string }>(parts: readonly Part[]): Map<string, Part> {
  return new Map(parts.map((part) => [part.id, part]));
}

function isSame(one: unknown, other: unknown): boolean {
  return JSON.stringify(one) === JSON.stringify(other);
}

const graph = new LGraph();
const element = document.querySelector<HTMLCanvasElement>("#graph");
const viewer = document.querySelector("tube-viewer");
const status = document.querySelector<HTMLElement>("#status");
if (!element || !viewer || !status) throw new Error("The page is not whole.");

const isDark = matchMedia("(prefers-color-scheme: dark)").matches;
Object.assign(LiteGraph, {
  NODE_DEFAULT_COLOR: isDark ? "#2b3647" : "#e8edf4",
  NODE_DEFAULT_BGCOLOR: isDark ? "#1b2430" : "#ffffff",
  NODE_DEFAULT_BOXCOLOR: "#66738a",
  NODE_TITLE_COLOR: isDark ? "#e8edf4" : "#1b2430",
  NODE_SELECTED_TITLE_COLOR: isDark ? "#ffffff" : "#000000",
  NODE_TEXT_COLOR: isDark ? "#c3cedb" : "#3b4656",
  NODE_BOX_OUTLINE_COLOR: isDark ? "#7fb2ff" : "#1d5fd1",
  LINK_COLOR: isDark ? "#7fb2ff" : "#1d5fd1",
});
const canvas = new LGraphCanvas(element, graph);
Object.assign(canvas, { allow_searchbox: false, render_info: false, show_info: false, background_image: null });
Object.assign(canvas, { clear_background_color: isDark ? "#0d1117" : "#f5f7fa", render_canvas_border: false });
element.tabIndex = 0; // litegraph.js puts it before all else.
const resize = () => canvas.resize(element.clientWidth, element.clientHeight);
new ResizeObserver(resize).observe(element);
canvas.ds.scale = Math.min(1, element.clientWidth / 470);

function add(kind: string, x: number, y: number): LGraphNode {
  const node = LiteGraph.createNode(`flow/${kind}`);
  node.pos = [x, y];
  graph.add(node);
  return node;
}

const [first, second] = [add("Sensor", 40, 60), add("Sensor", 40, 220)];
const [mixer, gauge, other] = [add("Mixer", 280, 150), add("Gauge", 280, 40), add("Gauge", 280, 290)];
first.connect(0, mixer, 0);
first.connect(0, gauge, 0);
second.connect(0, mixer, 1);
second.connect(0, other, 0);

for (const kind of Object.keys(KINDS)) {
  const button = document.createElement("button");
  button.textContent = `Add ${kind.toLowerCase()}`;
  button.addEventListener("click", () => add(kind, 60 + 20 * (graph.last_node_id % 8), 380));
  document.querySelector("#kinds")?.append(button);
}

await admitted();
const key = keyOf();
if (key !== undefined) viewer.key = key;

// The first call: put the program.
const id = `litegraph-${[...crypto.getRandomValues(new Uint8Array(6))].join("")}`;
const program = new Client(location.origin, { patience: 0, ...(key && { key }) }).program(id);
let sent = programOf(graph);
await program.create(sent);

// The second: show it, and let what is selected here be selected there.
viewer.setAttribute("stored", id);
canvas.onSelectionChange = (nodes) => {
  viewer.selection = Object.keys(nodes).map((name) => ({ shows: "item", id: name }));
};
viewer.addEventListener("tube-select", (event) => {
  const { things } = (event as CustomEvent<{ things: { id: string }[] }>).detail;
  const ids = things.map((thing) => Number.parseInt(thing.id));
  canvas.selectNodes(ids.flatMap((each) => graph.getNodeById(each) ?? []));
});

// The third, again and again: send what has changed, one request at a time.
for (;;) {
  const wanted = programOf(graph);
  const edits = editsBetween(sent, wanted);
  try {
    if (edits.length > 0) await program.edit(...edits);
    sent = wanted;
    status.textContent = `Saved as ${id}: ${wanted.items.length} items, ${wanted.hyperedges?.length ?? 0} hyperedges`;
    await new Promise((resolve) => setTimeout(resolve, LOOK_MILLISECONDS));
  } catch (error) {
    status.textContent = error instanceof Problem ? error.message : "Offline; your changes are kept.";
    await new Promise((resolve) => setTimeout(resolve, RETRY_MILLISECONDS));
  }
}
