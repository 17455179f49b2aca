import { Group, Mesh, MeshBasicMaterial, TorusGeometry, Vector3, type Box3 } from "three";
import type { Layout } from "tubeloom-client";
import { FROM_DOCUMENT } from "./scene.ts";

/** What is proven of distances. */
export type Clearance = NonNullable<Layout["clearance"]>;

const RADIUS_SHARE = 1 / 60;

/** A ring around each place where hyperedges come too near, which always faces whoever looks. */
export class ConflictMarks {
  readonly group = new Group();
  readonly #ring = new TorusGeometry(1, 0.12, 8, 40);
  readonly #paint = new MeshBasicMaterial({ color: 0xe11d48, depthTest: false, transparent: true });

  #shown = "";

  /** Mark these places in a scene that is as large as this box; whether that looks otherwise than before. */
  show(conflicts: Clearance["conflicts"], box: Box3): boolean {
    const radius = box.getSize(new Vector3()).length() * RADIUS_SHARE;
    const wanted = JSON.stringify([conflicts.map(({ place }) => place), conflicts.length && radius]);
    if (wanted === this.#shown) return false;
    this.#shown = wanted;
    this.group.clear();
    for (const { place } of conflicts) {
      const [x = 0, y = 0, z = 0] = place;
      const ring = new Mesh(this.#ring, this.#paint);
      ring.position.copy(new Vector3(x, y, z).applyMatrix4(FROM_DOCUMENT));
      ring.scale.setScalar(radius);
      ring.renderOrder = 10;
      ring.onBeforeRender = (_renderer, _scene, camera) => {
        ring.quaternion.copy(camera.quaternion);
        ring.updateMatrixWorld();
      };
      this.group.add(ring);
    }
    return true;
  }

  dispose(): void {
    this.#ring.dispose();
    this.#paint.dispose();
  }
}
