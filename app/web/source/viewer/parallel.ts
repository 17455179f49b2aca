import { OrthographicCamera, Vector3, type Box3, type PerspectiveCamera } from "three";
import { tangentOf } from "./camera.ts";

/** A camera to which what is far is as large as what is near. */
export class ParallelLens {
  readonly camera = new OrthographicCamera();

  /** Look as this camera does; what it looks at stays as large as it is. */
  follow(other: PerspectiveCamera, target: Vector3, box: Box3): void {
    const { camera } = this;
    const half = other.position.distanceTo(target) * tangentOf(other);
    [camera.bottom, camera.top] = [-half, half];
    [camera.left, camera.right] = [-half * other.aspect, half * other.aspect];
    const forward = other.getWorldDirection(new Vector3());
    const radius = box.isEmpty() ? 1 : box.getSize(new Vector3()).length() / 2;
    const depth = box.isEmpty() ? radius : box.getCenter(new Vector3()).sub(other.position).dot(forward);
    // Whoever comes near sees a smaller part; nothing is behind them then.
    const back = Math.max(0, 1.2 * radius - depth) + 0.1;
    camera.position.copy(other.position).addScaledVector(forward, -back);
    camera.quaternion.copy(other.quaternion);
    camera.near = 0;
    camera.far = depth + back + 2 * radius + 1;
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
  }
}
