import { Box3, Group, Matrix4, Vector3, type Mesh, type Object3D } from "three";
import type { GLTF } from "three/addons/loaders/GLTFLoader.js";
import { cornersOf } from "./camera.ts";
import { canShare, merged, MOST_MESHES, type Piece } from "./merging.ts";
import { free, lengthOf, lightsOf, meshesOf, thingsOf } from "./objects.ts";
import { simplify } from "./plain.ts";
import { keyOf, type Thing, type ThingKey, type ThingName } from "./things.ts";

/**
 * Where a thing is drawn: a mesh of its own, or so many numbers of the index of a mesh that it
 * shares. `box` is in the mesh's own space.
 */
export interface Part {
  mesh: Mesh;
  start: number;
  count: number;
  box: Box3;
  key: ThingKey;
}

interface Delta {
  since: number;
  revision: number;
  removed: { items: string[]; hyperedges: string[] };
}

/** The scene that is shown, by what it shows. */
export class Scene {
  readonly root = new Group();
  readonly things = new Map<ThingKey, Thing>();
  readonly parts = new Map<ThingKey, Part[]>();
  readonly meshes = new Map<Mesh, Part[]>();
  /** As the file names it. */
  name = "";
  /** Whether materials are drawn in the simplest way. */
  isPlain = false;
  #box: Box3 | undefined;

  /** Show `gltf` in place of all there was. */
  replace(gltf: GLTF): void {
    this.clear();
    // Three makes names fit for paths; the file has the document's own.
    const { scenes } = gltf.parser.json as { scenes?: { name?: string }[] };
    this.name = scenes?.[0]?.name ?? "";
    this.root.add(gltf.scene);
    this.#take(gltf.scene);
  }

  /** Show what has changed; false if `gltf` is a whole scene and no delta. */
  apply(gltf: GLTF): boolean {
    const delta = gltf.scene.userData["delta"] as Delta | undefined;
    if (delta === undefined) return false;
    for (const id of delta.removed.items) this.remove({ shows: "item", id });
    for (const id of delta.removed.hyperedges) this.remove({ shows: "hyperedge", id });
    for (const each of thingsOf(gltf.scene)) this.remove(each);
    // It brings the same lights once more.
    for (const light of lightsOf(gltf.scene)) light.removeFromParent();
    for (const emptied of this.#emptied()) emptied.removeFromParent();
    this.root.add(gltf.scene);
    this.#take(gltf.scene);
    return true;
  }

  /** Take away everything, and free what the graphics card keeps of it. */
  clear(): void {
    for (const mesh of this.meshes.keys()) free(mesh);
    this.root.clear();
    this.things.clear();
    this.parts.clear();
    this.meshes.clear();
    this.#box = undefined;
  }

  remove(name: ThingName): void {
    const key = keyOf(name);
    for (const part of this.parts.get(key) ?? []) {
      const sharers = this.meshes.get(part.mesh) ?? [];
      const others = sharers.filter((each) => each !== part);
      if (others.length > 0) {
        this.meshes.set(part.mesh, others);
      } else {
        this.meshes.delete(part.mesh);
        part.mesh.removeFromParent();
        free(part.mesh);
      }
    }
    this.parts.delete(key);
    this.things.delete(key);
    this.#box = undefined;
  }

  /** Around everything, in the space of the picture. */
  get box(): Box3 {
    this.#box ??= this.boxOf([...this.parts.keys()]);
    return this.#box;
  }

  /** Around some things, in the space of the picture. */
  boxOf(keys: readonly ThingKey[]): Box3 {
    const whole = new Box3();
    const moved = new Box3();
    this.root.updateMatrixWorld();
    for (const key of keys) {
      for (const { mesh, box } of this.parts.get(key) ?? []) {
        whole.union(moved.copy(box).applyMatrix4(mesh.matrixWorld));
      }
    }
    return whole;
  }

  /** A place on a thing, near the middle of its box, in the space of the picture. */
  anchorOf(key: ThingKey): Vector3 | undefined {
    const middle = this.boxOf([key]).getCenter(new Vector3());
    let anchor: Vector3 | undefined;
    let nearest = Infinity;
    for (const part of this.parts.get(key) ?? []) {
      for (const corner of cornersOn(part)) {
        const distance = corner.distanceToSquared(middle);
        if (distance < nearest) [nearest, anchor] = [distance, corner];
      }
    }
    return anchor;
  }

  /** The parts of some things, or of all, each with the corners of its box in the space of the picture. */
  boxesOf(keys: Iterable<ThingKey> = this.parts.keys()): { part: Part; corners: Vector3[] }[] {
    this.root.updateMatrixWorld();
    return [...keys].flatMap((key) =>
      (this.parts.get(key) ?? []).map((part) => {
        const corners = cornersOf(part.box).map((corner) => corner.applyMatrix4(part.mesh.matrixWorld));
        return { part, corners };
      }),
    );
  }

  /** How much there is: triangles, too, and the calls that draw them. */
  get size(): { items: number; hyperedges: number; triangles: number; calls: number } {
    let [triangles, hyperedges] = [0, 0];
    for (const { shows } of this.things.values()) if (shows === "hyperedge") hyperedges += 1;
    for (const mesh of this.meshes.keys()) triangles += lengthOf(mesh) / 3;
    return { items: this.things.size - hyperedges, hyperedges, triangles, calls: this.meshes.size };
  }

  /** The hyperedges that join an item, and the items that a hyperedge joins. */
  neighbours(thing: Thing): ThingKey[] {
    if (thing.shows === "hyperedge") {
      return (thing.attachments ?? []).map(({ item }) => keyOf({ shows: "item", id: item }));
    }
    const found: ThingKey[] = [];
    for (const [key, other] of this.things) {
      if (other.attachments?.some(({ item }) => item === thing.id)) found.push(key);
    }
    return found;
  }

  titleOfItem = (id: string): string => {
    const item = this.things.get(keyOf({ shows: "item", id }));
    return item?.label || id;
  };

  /** What came with earlier changes, and shows and lights nothing any more. */
  #emptied(): Object3D[] {
    const used = new Set<Object3D>();
    // From the meshes up, because most nodes of a large scene have lost theirs to a shared one.
    for (const mesh of this.meshes.keys()) {
      let top: Object3D = mesh;
      while (top.parent && top.parent !== this.root) top = top.parent;
      used.add(top);
    }
    return this.root.children.filter((child) => !used.has(child) && lightsOf(child).length === 0);
  }

  #take(scene: Object3D): void {
    // The page is the ground here; where there are shadows, `Lighting` catches them.
    scene.getObjectByName("ground")?.removeFromParent();
    if (this.isPlain) simplify(scene);
    scene.updateMatrixWorld(true);
    const pieces: Piece[] = [];
    scene.traverse((object) => {
      const { shows } = object.userData as { shows?: string };
      if (shows === "hyperedges") {
        const list = object.userData["hyperedges"] as Thing[];
        for (const mesh of meshesOf(object)) this.#takeMerged(mesh, list);
      } else if (shows === "item" || shows === "hyperedge") {
        const thing = object.userData as Thing;
        const key = keyOf(thing);
        this.things.set(key, thing);
        for (const mesh of meshesOf(object)) pieces.push({ mesh, key });
      }
    });
    const isCrowd = pieces.length > MOST_MESHES;
    const shared = isCrowd ? pieces.filter(canShare) : [];
    for (const { mesh, key } of isCrowd ? pieces.filter((piece) => !canShare(piece)) : pieces) {
      mesh.geometry.computeBoundingBox();
      const box = mesh.geometry.boundingBox ?? new Box3();
      this.#add({ mesh, start: 0, count: lengthOf(mesh), box, key });
    }
    for (const part of merged(shared)) {
      this.#add(part);
      scene.add(part.mesh);
    }
    for (const { mesh } of shared) mesh.removeFromParent();
    this.#box = undefined;
  }

  #takeMerged(mesh: Mesh, list: readonly Thing[]): void {
    const { index } = mesh.geometry;
    const features = mesh.geometry.getAttribute("_feature_id_0");
    const positions = mesh.geometry.getAttribute("position");
    if (index === null) return;
    let start = 0;
    let feature = features.getX(index.getX(0));
    const box = new Box3();
    const finish = (end: number) => {
      const thing = { ...list[feature], shows: "hyperedge" } as Thing;
      const key = keyOf(thing);
      this.things.set(key, thing);
      this.#add({ mesh, start, count: end - start, box: box.clone(), key });
      box.makeEmpty();
      start = end;
    };
    for (let at = 0; at < index.count; at += 3) {
      const corner = index.getX(at);
      const next = features.getX(corner);
      if (next !== feature) {
        finish(at);
        feature = next;
      }
      for (let more = 0; more < 3; more += 1) {
        const vertex = index.getX(at + more);
        const [x, y, z] = [positions.getX(vertex), positions.getY(vertex), positions.getZ(vertex)];
        box.min.set(Math.min(box.min.x, x), Math.min(box.min.y, y), Math.min(box.min.z, z));
        box.max.set(Math.max(box.max.x, x), Math.max(box.max.y, y), Math.max(box.max.z, z));
      }
    }
    finish(index.count);
  }

  #add(part: Part): void {
    const [own, shared] = [this.parts.get(part.key), this.meshes.get(part.mesh)];
    if (own) own.push(part);
    else this.parts.set(part.key, [part]);
    if (shared) shared.push(part);
    else this.meshes.set(part.mesh, [part]);
  }
}

/** Some corners of a part's triangles, from all over it, in the space of the picture. */
export function cornersOn({ mesh, start, count }: Part): Vector3[] {
  const { index } = mesh.geometry;
  const positions = mesh.geometry.getAttribute("position");
  const found: Vector3[] = [];
  for (let at = start; at < start + count; at += Math.max(1, Math.floor(count / MOST_SAMPLES))) {
    const corner = new Vector3().fromBufferAttribute(positions, index ? index.getX(at) : at);
    found.push(corner.applyMatrix4(mesh.matrixWorld));
  }
  return found;
}

const MOST_SAMPLES = 500;

/** A picture's space has y up; documents have z up. */
export const FROM_DOCUMENT = new Matrix4().makeRotationX(-Math.PI / 2);
