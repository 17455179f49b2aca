import { Mesh, MeshLambertMaterial, MeshStandardMaterial, type Material, type Object3D } from "three";

const GLASS_OPACITY = 0.35;

/** Has matte light on everything: without a graphics card that is drawn in half the time. */
export function simplify(scene: Object3D): void {
  const simple = new Map<Material, Material>();
  scene.traverse((object) => {
    if (!(object instanceof Mesh) || !(object.material instanceof MeshStandardMaterial)) return;
    const { material } = object;
    let made = simple.get(material);
    if (made === undefined) {
      const { name, color, map, vertexColors, transparent, opacity, side } = material;
      const isGlass = "transmission" in material && Number(material.transmission) > 0;
      made = new MeshLambertMaterial({ name, color, map, vertexColors, side });
      made.transparent = transparent || isGlass;
      made.opacity = isGlass ? GLASS_OPACITY : opacity;
      made.depthWrite = !isGlass;
      simple.set(material, made);
    }
    object.material = made;
  });
}
