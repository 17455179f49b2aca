import { Light, Mesh, type Material, type Object3D } from "three";
import type { Thing, ThingName } from "./things.ts";

/** The meshes that are an object, or hang directly on it: one for each of its materials. */
export function meshesOf(object: Object3D): Mesh[] {
  return [object, ...object.children].filter(
    (each): each is Mesh =>
      each instanceof Mesh && (each === object || each.userData["shows"] === undefined),
  );
}

/** What an object and all within it show. */
export function thingsOf(scene: Object3D): ThingName[] {
  const found: ThingName[] = [];
  scene.traverse(({ userData }) => {
    const { shows } = userData as { shows?: string };
    if (shows === "item" || shows === "hyperedge") found.push(userData as ThingName);
    for (const each of (userData["hyperedges"] as Thing[] | undefined) ?? []) {
      found.push({ shows: "hyperedge", id: each.id });
    }
  });
  return found;
}

export function lightsOf(scene: Object3D): Light[] {
  const found: Light[] = [];
  scene.traverse((object) => {
    if (object instanceof Light) found.push(object);
  });
  return found;
}

/** How many corners of triangles a mesh has. */
export function lengthOf({ geometry }: Mesh): number {
  return geometry.index?.count ?? geometry.getAttribute("position").count;
}

/** Give back what the graphics card keeps of a mesh. */
export function free(mesh: Mesh): void {
  mesh.geometry.dispose();
  const materials: Material[] = Array.isArray(mesh.material) ? mesh.material : [mesh.material];
  for (const material of materials) material.dispose();
}
