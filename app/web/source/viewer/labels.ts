import { Box3, Vector3, type Camera } from "three";
import { cornersOf } from "./camera.ts";
import type { Scene } from "./scene.ts";
import { titleOf, type Thing, type ThingKey } from "./things.ts";

/** Which labels are written over the picture: those that could not be read in it, all, or none. */
export const LABELS = ["auto", "always", "never"] as const;
export type Labels = (typeof LABELS)[number];

/** Lettering of the scene that is lower than this on the screen is written over it. */
const LEGIBLE_PIXELS = 7;
const MOST_LABELS = 150;
const GAP = 2;

interface Place {
  thing: Thing;
  x: number;
  y: number;
  depth: number;
  isWanted: boolean;
}

/** Labels over the picture. They are for eyes only: `Narration` tells the same to ears. */
export class Overlay {
  labels: Labels = "auto";
  readonly #scene: Scene;
  readonly #layer: HTMLElement;
  readonly #pool: HTMLElement[] = [];
  readonly #widths = new Map<string, number>();
  readonly #ruler = document.createElement("canvas").getContext("2d");

  constructor(scene: Scene, layer: HTMLElement) {
    this.#scene = scene;
    this.#layer = layer;
  }

  /**
   * Write the labels where they belong in this view: those `wanted` in any case, others only where
   * `isShown` says so.
   */
  update(
    camera: Camera,
    width: number,
    height: number,
    wanted: ReadonlySet<ThingKey>,
    isShown: (key: ThingKey) => boolean,
  ): void {
    const places = this.#places(camera, width, height, wanted, isShown);
    const taken: Rect[] = [];
    let used = 0;
    for (const { thing, x, y, isWanted } of places) {
      if (used === MOST_LABELS) break;
      const text = titleOf(thing);
      const half = this.#widthOf(text) / 2 + 6;
      const left = Math.min(Math.max(x - half, 2), Math.max(width - 2 * half - 2, 2));
      const top = Math.min(Math.max(y - 20, 2), height - 20);
      const rect = { left, right: left + 2 * half, top, bottom: top + 18 };
      if (!isWanted && taken.some((other) => overlap(rect, other))) continue;
      taken.push(rect);
      this.#write(used, text, left, top, thing.shows, isWanted);
      used += 1;
    }
    for (const rest of this.#pool.slice(used)) rest.hidden = true;
  }

  #places(
    camera: Camera,
    width: number,
    height: number,
    wanted: ReadonlySet<ThingKey>,
    isShown: (key: ThingKey) => boolean,
  ): Place[] {
    const found: Place[] = [];
    const [spot, box] = [new Vector3(), new Box3()];
    for (const [key, thing] of this.#scene.things) {
      const isWanted = wanted.has(key);
      if (!isWanted && (this.labels === "never" || !thing.label || thing.shows === "hyperedge")) continue;
      if (!isWanted && !isShown(key)) continue;
      if (!this.#anchor(key, thing, spot, box)) continue;
      const depth = camera.position.distanceTo(spot);
      if (!isWanted && this.labels === "auto" && this.#isLegible(key, camera, height)) continue;
      spot.project(camera);
      if (spot.z > 1 || Math.abs(spot.x) > 1.05 || Math.abs(spot.y) > 1.05) continue;
      const [x, y] = [((spot.x + 1) * width) / 2, ((1 - spot.y) * height) / 2];
      found.push({ thing, x, y, depth, isWanted });
    }
    return found.sort((one, other) =>
      one.isWanted === other.isWanted ? one.depth - other.depth : one.isWanted ? -1 : 1,
    );
  }

  /** Puts `spot` where the label hangs: on a hyperedge's tube, above an item. */
  #anchor(key: ThingKey, { shows }: Thing, spot: Vector3, box: Box3): boolean {
    if (shows === "hyperedge") {
      const anchor = this.#scene.anchorOf(key);
      if (anchor) spot.copy(anchor);
      return anchor !== undefined;
    }
    box.copy(this.#scene.boxOf([key])).getCenter(spot);
    spot.y = box.max.y;
    return !box.isEmpty();
  }

  /** Whether the item's own lettering, its smallest part, is large enough from here. */
  #isLegible(key: ThingKey, camera: Camera, height: number): boolean {
    const parts = this.#scene.parts.get(key) ?? [];
    if (parts.length < 2) return false;
    const [size, best] = [new Vector3(), new Vector3(Infinity, Infinity, Infinity)];
    let lettering = parts[0];
    for (const part of parts) {
      part.box.getSize(size);
      if (size.x * size.y * size.z < best.x * best.y * best.z) {
        best.copy(size);
        lettering = part;
      }
    }
    if (lettering === undefined) return false;
    const { matrixWorld } = lettering.mesh;
    const heights = cornersOf(lettering.box).map((corner) => corner.applyMatrix4(matrixWorld).project(camera).y);
    return ((Math.max(...heights) - Math.min(...heights)) * height) / 2 >= LEGIBLE_PIXELS;
  }

  #write(number: number, text: string, x: number, y: number, kind: string, isWanted: boolean): void {
    let label = this.#pool[number];
    if (label === undefined) {
      label = document.createElement("span");
      this.#pool.push(label);
      this.#layer.append(label);
    }
    label.hidden = false;
    if (label.textContent !== text) label.textContent = text;
    label.className = `${kind}${isWanted ? " wanted" : ""}`;
    label.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
  }

  #widthOf(text: string): number {
    let width = this.#widths.get(text);
    if (width === undefined) {
      if (this.#ruler) this.#ruler.font = "600 12px system-ui, sans-serif";
      width = this.#ruler?.measureText(text).width ?? 7 * text.length;
      this.#widths.set(text, width);
    }
    return width;
  }
}

interface Rect {
  left: number;
  right: number;
  top: number;
  bottom: number;
}

function overlap(one: Rect, other: Rect): boolean {
  return (
    one.left < other.right + GAP &&
    other.left < one.right + GAP &&
    one.top < other.bottom + GAP &&
    other.top < one.bottom + GAP
  );
}
