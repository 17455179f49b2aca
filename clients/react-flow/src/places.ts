import { rounded, type AttachmentPoint, type FlowHandle, type FlowNode, type Place } from "./graph.js";

export interface Size {
  width: number;
  height: number;
}

/** How large a node is, as it says itself or as it was measured. */
export function sizeOf(node: FlowNode): Size | undefined {
  const width = node.width ?? node.measured?.width;
  const height = node.height ?? node.measured?.height;
  return width && height ? { width, height } : undefined;
}

/** Middles of nodes in the plane, whatever they are contained in. */
export class Middles {
  readonly #nodes: ReadonlyMap<string, FlowNode>;
  readonly #origin: [number, number];
  readonly #corners = new Map<string, Place>();

  constructor(nodes: readonly FlowNode[], origin: [number, number]) {
    this.#nodes = new Map(nodes.map((node) => [node.id, node]));
    this.#origin = origin;
  }

  of(node: FlowNode): Place {
    const { width, height } = sizeOf(node) ?? { width: 0, height: 0 };
    const { x, y } = this.corner(node);
    return { x: x + width / 2, y: y + height / 2 };
  }

  /** A node's middle as seen from that of the node that contains it. */
  within(node: FlowNode): Place {
    const parent = node.parentId === undefined ? undefined : this.#nodes.get(node.parentId);
    if (parent === undefined) return this.of(node);
    const [inner, outer] = [this.of(node), this.of(parent)];
    return { x: inner.x - outer.x, y: inner.y - outer.y };
  }

  /** The upper left corner. */
  corner(node: FlowNode): Place {
    const known = this.#corners.get(node.id);
    if (known) return known;
    const { width, height } = sizeOf(node) ?? { width: 0, height: 0 };
    const [right, down] = node.origin ?? this.#origin;
    const parent = node.parentId === undefined ? undefined : this.#nodes.get(node.parentId);
    const base = parent === undefined ? { x: 0, y: 0 } : this.corner(parent);
    const corner = {
      x: base.x + node.position.x - right * width,
      y: base.y + node.position.y - down * height,
    };
    this.#corners.set(node.id, corner);
    return corner;
  }
}

/** How near to the rim an attachment point lies: a tube that rises there needs room around it. */
const INSET = 0.22;

/** Attachment points on top of a box, near the sides where a node has its handles. */
export function pointsOf(handles: readonly FlowHandle[], size: readonly number[]): AttachmentPoint[] {
  const [width = 1, depth = 1, height = 1] = size;
  const inset = Math.min(INSET, width / 4, depth / 4);
  return handles.map(({ id, side, along = 0.5 }) => {
    const [right, up] = {
      left: [-1, 1 - 2 * along],
      right: [1, 1 - 2 * along],
      top: [2 * along - 1, 1],
      bottom: [2 * along - 1, -1],
    }[side] as [number, number];
    const position = [right * (width / 2 - inset), up * (depth / 2 - inset), height / 2].map(rounded);
    return { id, position: position as [number, number, number] };
  });
}

/** Handles at the sides to which attachment points are nearest. */
export function handlesOf(points: readonly AttachmentPoint[], size: readonly number[]): FlowHandle[] {
  const [width = 1, depth = 1] = size;
  return points.map(({ id, position: [x, y] }) => {
    const [right, up] = [(2 * x) / width, (2 * y) / depth];
    const share = (part: number) => rounded(Math.min(Math.max((1 + part) / 2, 0.1), 0.9));
    if (Math.abs(right) >= Math.abs(up)) {
      return { id, side: right < 0 ? "left" : "right", along: share(-up) };
    }
    return { id, side: up < 0 ? "bottom" : "top", along: share(right) };
  });
}
