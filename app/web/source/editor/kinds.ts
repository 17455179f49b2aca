import type { FlowHandle } from "tubeloom-react-flow";

/** A kind of nodes that the palette offers. */
export interface Kind {
  name: string;
  title: string;
  color: string;
  handles: readonly FlowHandle[];
}

const LEFT: FlowHandle = { id: "left", side: "left" };
const RIGHT: FlowHandle = { id: "right", side: "right" };

export const KINDS: readonly Kind[] = [
  { name: "variable", title: "Variable", color: "#8fb8ee", handles: [LEFT, RIGHT] },
  { name: "constant", title: "Constant", color: "#e3b34f", handles: [LEFT, RIGHT] },
  {
    name: "function",
    title: "Function",
    color: "#7fc6a4",
    handles: [{ id: "first", side: "left", along: 0.25 }, { id: "second", side: "left", along: 0.75 }, RIGHT],
  },
  {
    name: "relation",
    title: "Relation",
    color: "#b9a5e6",
    handles: [LEFT, RIGHT, { id: "top", side: "top" }, { id: "bottom", side: "bottom" }],
  },
];

/** Colours of new hyperedges, apart for everyone who sees colours differently (Okabe and Ito). */
export const HYPEREDGE_COLORS: readonly string[] = [
  "#0072b2",
  "#d55e00",
  "#009e73",
  "#cc79a7",
  "#e69f00",
  "#56b4e9",
  "#7a5fc7",
  "#8c5a3c",
];
