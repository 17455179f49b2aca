import {
  applyEdgeChanges,
  applyNodeChanges,
  Background,
  BackgroundVariant,
  ConnectionMode,
  Controls,
  ReactFlow,
  useReactFlow,
  type Connection,
  type Edge,
  type EdgeChange,
  type FinalConnectionState,
  type NodeChange,
} from "@xyflow/react";
import {
  useCallback,
  useMemo,
  type Dispatch,
  type DragEvent,
  type KeyboardEvent,
  type ReactElement,
  type SetStateAction,
} from "react";
import { JUNCTION } from "tubeloom-react-flow";
import { added, endOf, joined, ORIGIN, settled, type AppNode, type End, type Graph } from "./graph.ts";
import { KINDS } from "./kinds.ts";
import { EDGE_TYPES, NODE_TYPES } from "./nodes.tsx";
import { dressed } from "./showing.ts";

export const KIND_TYPE = "application/x-tubeloom-kind";

interface CanvasProps {
  graph: Graph;
  setGraph: Dispatch<SetStateAction<Graph>>;
  paints: ReadonlyMap<string, string>;
  colorMode: "light" | "dark";
  onGesture: (isOn: boolean) => void;
}

/** The graph, where one draws. */
export function Canvas({ graph, setGraph, paints, colorMode, onGesture }: CanvasProps): ReactElement {
  const flow = useReactFlow<AppNode, Edge>();
  const { nodes, edges } = useMemo(() => dressed(graph, paints), [graph, paints]);

  const onNodesChange = useCallback(
    (changes: NodeChange<AppNode>[]) => {
      setGraph(({ nodes, edges }) => settled({ nodes: applyNodeChanges(changes, nodes), edges }));
    },
    [setGraph],
  );
  const onEdgesChange = useCallback(
    (changes: EdgeChange<Edge>[]) => {
      setGraph(({ nodes, edges }) => settled({ nodes, edges: applyEdgeChanges(changes, edges) }));
    },
    [setGraph],
  );
  const onConnect = useCallback(
    (connection: Connection) => setGraph((now) => connected(now, connection)),
    [setGraph],
  );

  /** Dropped on a line or on a node's body, where there is no handle. */
  const onConnectEnd = useCallback(
    (event: MouseEvent | TouchEvent, { fromNode, fromHandle, toHandle }: FinalConnectionState) => {
      if (toHandle || !fromNode || fromHandle?.id == null) return;
      const pointer = "changedTouches" in event ? event.changedTouches[0] : event;
      if (pointer === undefined) return;
      const { clientX: x, clientY: y } = pointer;
      const from: End = { item: fromNode.id, handle: fromHandle.id };
      const under = document.elementsFromPoint(x, y);
      const found = (selector: string) =>
        under.map((each) => each.closest(selector)?.getAttribute("data-id")).find((id) => id != null);
      const near = flow.screenToFlowPosition({ x, y });
      setGraph((now) => {
        const line = now.edges.find(({ id }) => id === found(".react-flow__edge"));
        if (line) return joined(now, [from], [line.target]);
        const node = now.nodes.find(({ id }) => id === found(".react-flow__node"));
        if (!node || node.id === fromNode.id) return now;
        if (node.type === JUNCTION) return joined(now, [from], [node.id]);
        const end = endOf(now, node, near);
        return end ? joined(now, [from, end]) : now;
      });
    },
    [setGraph, flow],
  );

  const onDrop = (event: DragEvent) => {
    const kind = KINDS.find(({ name }) => name === event.dataTransfer.getData(KIND_TYPE));
    if (!kind) return;
    event.preventDefault();
    const place = flow.screenToFlowPosition({ x: event.clientX, y: event.clientY });
    setGraph((now) => added(now, kind, place).graph);
  };

  /** React Flow forgets that Ctrl is held once another key is let go; so choosing more is done here. */
  const onKeyDownCapture = (event: KeyboardEvent<HTMLElement>) => {
    const isMore = event.ctrlKey || event.metaKey || event.shiftKey;
    const id = event.target instanceof HTMLElement ? event.target.dataset["id"] : undefined;
    if (!isMore || !["Enter", " "].includes(event.key) || !graph.nodes.some((node) => node.id === id)) return;
    event.preventDefault();
    event.stopPropagation();
    setGraph((now) => ({
      ...now,
      nodes: now.nodes.map((node) => (node.id === id ? { ...node, selected: !node.selected } : node)),
    }));
  };

  return (
    <ReactFlow
      nodes={nodes}
      edges={edges}
      nodeTypes={NODE_TYPES}
      edgeTypes={EDGE_TYPES}
      nodeOrigin={ORIGIN}
      colorMode={colorMode}
      connectionMode={ConnectionMode.Loose}
      connectionRadius={24}
      multiSelectionKeyCode={["Meta", "Control", "Shift"]}
      selectionKeyCode="Alt"
      deleteKeyCode={["Delete", "Backspace"]}
      zoomOnDoubleClick={false}
      minZoom={0.15}
      fitView
      fitViewOptions={{ padding: 0.15, maxZoom: 1 }}
      onNodesChange={onNodesChange}
      onEdgesChange={onEdgesChange}
      onConnect={onConnect}
      onConnectEnd={onConnectEnd}
      onNodeDragStart={() => onGesture(true)}
      onNodeDragStop={() => onGesture(false)}
      onSelectionDragStart={() => onGesture(true)}
      onSelectionDragStop={() => onGesture(false)}
      onDragOver={(event) => event.preventDefault()}
      onDrop={onDrop}
      onKeyDownCapture={onKeyDownCapture}
      aria-label="Graph"
    >
      <Background variant={BackgroundVariant.Dots} gap={16} size={1} />
      <Controls showInteractive={false} />
    </ReactFlow>
  );
}

/** Handle to handle is a hyperedge, or joins those that are there; handle to dot joins the dot's. */
function connected(graph: Graph, { source, sourceHandle, target, targetHandle }: Connection): Graph {
  const ends: End[] = [];
  const junctions: string[] = [];
  for (const [id, handle] of [[source, sourceHandle], [target, targetHandle]] as const) {
    const node = graph.nodes.find((each) => each.id === id);
    if (node?.type === JUNCTION) junctions.push(id);
    else if (node && handle != null) ends.push({ item: id, handle });
  }
  return joined(graph, ends, junctions);
}
