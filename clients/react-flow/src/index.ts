export { editsBetween } from "./edits-between.js";
export { flowOf, lineOf } from "./flow-of.js";
export { JUNCTION, MIDDLE } from "./graph.js";
export type { FlowEdge, FlowHandle, FlowNode, FlowOptions, Side } from "./graph.js";
export { Link, type LinkListener, type LinkState, type LinkStatus } from "./link.js";
export { Middles } from "./places.js";
export { programOf, type Frame } from "./program-of.js";
export { TubePreview, type Clearance, type ThingName, type TubePreviewProps } from "./tube-preview.js";
export { useTubeloom, type Tubeloom, type TubeloomOptions } from "./use-tubeloom.js";
