import { BaseEdge, Handle, Position, type EdgeProps, type NodeProps } from "@xyflow/react";
import { createContext, useContext, useEffect, useRef, type KeyboardEvent, type ReactElement } from "react";
import { MIDDLE, type FlowHandle } from "tubeloom-react-flow";
import { DOT_SIZE, type AppNode } from "./graph.ts";

/** What nodes ask of the editor. */
export interface Acts {
  /** The node whose label is being written. */
  renamed: string | undefined;
  /** Handles that are chosen to be joined. */
  picked: ReadonlySet<string>;
  startRename(id: string): void;
  rename(id: string, label: string | undefined): void;
  pick(id: string, handle: string): void;
}

export const Editing = createContext<Acts | undefined>(undefined);

export function keyOfEnd(item: string, handle: string): string {
  return JSON.stringify([item, handle]);
}

const POSITIONS = { left: Position.Left, right: Position.Right, top: Position.Top, bottom: Position.Bottom };

function ItemNode({ id, data, selected }: NodeProps<AppNode>): ReactElement {
  const acts = useContext(Editing);
  const label = String(data["label"] ?? id);
  const handles = (data["handles"] ?? []) as readonly FlowHandle[];
  return (
    <div className="item" onDoubleClick={() => acts?.startRename(id)}>
      {data["color"] ? <span className="swatch" style={{ background: String(data["color"]) }} /> : null}
      <span className="words">
        {data["kind"] ? <small>{String(data["kind"]).replaceAll("_", " ")}</small> : null}
        {acts?.renamed === id ? <Rename id={id} label={label} /> : <b>{label}</b>}
      </span>
      {handles.map((handle) => (
        <HandleOf key={handle.id} item={id} title={label} handle={handle} isReachable={selected} />
      ))}
    </div>
  );
}

interface HandleProps {
  item: string;
  title: string;
  handle: FlowHandle;
  isReachable: boolean;
}

function HandleOf({ item, title, handle: { id, side, along = 0.5 }, isReachable }: HandleProps): ReactElement {
  const acts = useContext(Editing);
  const isPicked = acts?.picked.has(keyOfEnd(item, id)) ?? false;
  const place = side === "left" || side === "right" ? { top: `${along * 100}%` } : { left: `${along * 100}%` };
  const press = (event: KeyboardEvent) => {
    if (event.key !== "Enter" && event.key !== " ") return;
    event.preventDefault();
    event.stopPropagation();
    acts?.pick(item, id);
  };
  return (
    <Handle
      id={id}
      type="source"
      position={POSITIONS[side]}
      style={place}
      className={isPicked ? "picked" : ""}
      role="button"
      tabIndex={isReachable ? 0 : -1}
      aria-pressed={isPicked}
      aria-label={`Handle ${id === MIDDLE ? "in the middle" : id} of ${title}`}
      onKeyDown={press}
    />
  );
}

function JunctionNode({ id, data }: NodeProps<AppNode>): ReactElement {
  const acts = useContext(Editing);
  const label = data["label"] as string | undefined;
  return (
    <div className="junction" onDoubleClick={() => acts?.startRename(id)}>
      <span className="dot" style={{ background: ((data["color"] ?? data["paint"]) as string | undefined) ?? "var(--muted)" }} />
      {acts?.renamed === id ? <Rename id={id} label={label ?? ""} /> : label ? <b>{label}</b> : null}
      <Handle type="source" position={Position.Top} tabIndex={-1} aria-hidden="true" />
    </div>
  );
}

function Rename({ id, label }: { id: string; label: string }): ReactElement {
  const acts = useContext(Editing);
  const input = useRef<HTMLInputElement>(null);
  useEffect(() => input.current?.select(), []);
  const press = (event: KeyboardEvent<HTMLInputElement>) => {
    event.stopPropagation();
    if (event.key === "Enter") acts?.rename(id, event.currentTarget.value);
    if (event.key === "Escape") acts?.rename(id, undefined);
  };
  return (
    <input
      ref={input}
      className="nodrag nopan"
      aria-label="Label"
      defaultValue={label}
      maxLength={500}
      autoFocus
      onKeyDown={press}
      onBlur={(event) => acts?.rename(id, event.currentTarget.value)}
    />
  );
}

const OUTWARD: Record<Position, [number, number]> = {
  [Position.Left]: [-1, 0],
  [Position.Right]: [1, 0],
  [Position.Top]: [0, -1],
  [Position.Bottom]: [0, 1],
};

/** From a handle, squarely, to the middle of the dot. */
function Line({ sourceX, sourceY, targetX, targetY, sourcePosition, data, selected }: EdgeProps): ReactElement {
  const [right, down] = OUTWARD[sourcePosition];
  const [x, y] = [targetX, targetY + DOT_SIZE / 2];
  const reach = Math.max(24, 0.45 * Math.hypot(x - sourceX, y - sourceY));
  const path = `M${sourceX},${sourceY} Q${sourceX + right * reach},${sourceY + down * reach} ${x},${y}`;
  const style = { stroke: (data?.["color"] as string | undefined) ?? "var(--muted)", strokeWidth: selected ? 4 : 2.5 };
  return <BaseEdge path={path} style={style} interactionWidth={22} />;
}

export const NODE_TYPES = { item: ItemNode, junction: JunctionNode };
export const EDGE_TYPES = { line: Line };
