import { Box3, Matrix4, Ray, Raycaster, Vector2, Vector3, type Camera, type Intersection } from "three";
import type { Part, Scene } from "./scene.ts";
import type { ThingKey } from "./things.ts";

/** How far beside a thin tube one may point, in pixels, if nothing else is there. */
const NEAR_PIXELS = 5;

/** Finds what a place on the picture shows. */
export class Picker {
  readonly #scene: Scene;
  readonly #caster = new Raycaster();
  readonly #ray = new Ray();
  readonly #inverse = new Matrix4();
  readonly #entry = new Vector3();

  constructor(scene: Scene) {
    this.#scene = scene;
  }

  /** What is at (x, y), in pixels from the picture's top left corner, or close beside it. */
  at(x: number, y: number, width: number, height: number, camera: Camera): ThingKey | undefined {
    const here = this.#hit(x, y, width, height, camera);
    if (here !== undefined) return here;
    for (let step = 0; step < 8; step += 1) {
      const angle = (step * Math.PI) / 4;
      const [dx, dy] = [Math.cos(angle) * NEAR_PIXELS, Math.sin(angle) * NEAR_PIXELS];
      const near = this.#hit(x + dx, y + dy, width, height, camera);
      if (near?.startsWith("hyperedge")) return near;
    }
    return undefined;
  }

  #hit(x: number, y: number, width: number, height: number, camera: Camera): ThingKey | undefined {
    const place = new Vector2((2 * x) / width - 1, 1 - (2 * y) / height);
    this.#caster.setFromCamera(place, camera);
    let nearest = Infinity;
    let found: ThingKey | undefined;
    const hits: Intersection[] = [];
    for (const { part, distance } of this.#candidates()) {
      if (distance >= nearest) break;
      const { geometry } = part.mesh;
      hits.length = 0;
      geometry.setDrawRange(part.start, part.count);
      part.mesh.raycast(this.#caster, hits);
      geometry.setDrawRange(0, Infinity);
      for (const hit of hits) {
        if (hit.distance < nearest) [nearest, found] = [hit.distance, part.key];
      }
    }
    return found;
  }

  /** The parts whose boxes the ray enters, the nearest first. */
  #candidates(): { part: Part; distance: number }[] {
    const found: { part: Part; distance: number }[] = [];
    for (const [mesh, parts] of this.#scene.meshes) {
      if (!mesh.visible) continue;
      this.#inverse.copy(mesh.matrixWorld).invert();
      this.#ray.copy(this.#caster.ray).applyMatrix4(this.#inverse);
      if (parts.length > 1 && !this.#enters(boundsOf(mesh))) continue;
      for (const part of parts) {
        if (!this.#enters(part.box)) continue;
        this.#entry.applyMatrix4(mesh.matrixWorld);
        found.push({ part, distance: this.#entry.distanceTo(this.#caster.ray.origin) });
      }
    }
    return found.sort((one, other) => one.distance - other.distance);
  }

  #enters(box: Box3): boolean {
    if (box.containsPoint(this.#ray.origin)) {
      this.#entry.copy(this.#ray.origin);
      return true;
    }
    return this.#ray.intersectBox(box, this.#entry) !== null;
  }
}

function boundsOf({ geometry }: Part["mesh"]): Box3 {
  if (geometry.boundingBox === null) geometry.computeBoundingBox();
  return geometry.boundingBox ?? new Box3();
}
