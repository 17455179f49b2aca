import { Box3, Matrix4, Vector3, type Camera } from "three";

/** Where a camera stands, and what it looks at. */
export interface Pose {
  position: Vector3;
  target: Vector3;
}

/** What a camera takes in. */
export interface Lens {
  /** From the lower edge of the picture to the upper, in degrees. */
  fov: number;
  aspect: number;
  /** Whether what is far is drawn as large as what is near. */
  isParallel: boolean;
}

/** A stretch at the picture's upper right corner, in shares of its width and height. */
export interface Corner {
  left: number;
  bottom: number;
}

const MARGIN = 1.06;
const ROUNDS = 8;
const UP = new Vector3(0, 1, 0);

/**
 * The pose, in `direction` from points, from which all of them are just seen, in the middle of what
 * is below `top`, a share of the picture's height.
 */
export function poseAround(points: readonly Vector3[], direction: Vector3, lens: Lens, top = 0): Pose {
  const target = new Box3().setFromPoints([...points]).getCenter(new Vector3());
  const { right, up, outward } = axesOf(direction);
  const lower = tangentOf(lens) / MARGIN;
  const upper = lower * (1 - 2 * top);
  const sideways = lower * lens.aspect;
  const places = points.map((point) => {
    const arm = point.clone().sub(target);
    return [arm.dot(right), arm.dot(up), lens.isParallel ? 0 : arm.dot(outward)] as const;
  });
  let [x, y, distance] = [0, 0, 0.1];
  // What is near looks larger, so that the middle of space is not the middle of the picture.
  for (let round = 0; round < ROUNDS; round += 1) {
    distance = 0.1;
    for (const [px, py, pz] of places) {
      const upward = (py - y) / (py > y ? upper : -lower);
      distance = Math.max(distance, pz + upward, pz + Math.abs(px - x) / sideways);
    }
    x += middleOf(places.map(([px, , pz]) => (px - x) / (distance - pz))) * distance;
    y += (middleOf(places.map(([, py, pz]) => (py - y) / (distance - pz))) - (upper - lower) / 2) * distance;
  }
  target.addScaledVector(right, x).addScaledVector(up, y);
  return { position: target.clone().addScaledVector(outward, distance), target };
}

/** Where points are on the picture, in shares of its width and height, from its upper left corner. */
export function placing({ position, target }: Pose, lens: Lens): (point: Vector3) => [number, number] {
  const arm = position.clone().sub(target);
  const { right, up, outward } = axesOf(arm);
  const [distance, tangent] = [arm.length(), tangentOf(lens)];
  return (point) => {
    const place = point.clone().sub(target);
    const scale = 2 * tangent * (lens.isParallel ? distance : distance - place.dot(outward));
    return [0.5 + place.dot(right) / (scale * lens.aspect), 0.5 - place.dot(up) / scale];
  };
}

/** Half of a picture's height, seen from a distance of one. */
export function tangentOf({ fov }: { fov: number }): number {
  return Math.tan((fov * Math.PI) / 360);
}

function axesOf(direction: Vector3): { right: Vector3; up: Vector3; outward: Vector3 } {
  const outward = direction.clone().normalize();
  // From straight above, "up" would be no direction on the picture.
  if (Math.abs(outward.dot(UP)) > 0.9999) outward.z += 1e-3;
  const [right, up] = [new Vector3(), new Vector3()];
  new Matrix4().lookAt(outward, new Vector3(), UP).extractBasis(right, up, new Vector3());
  return { right, up, outward };
}

function middleOf(values: readonly number[]): number {
  if (values.length === 0) return 0;
  let [least, most] = [Infinity, -Infinity];
  for (const value of values) [least, most] = [Math.min(least, value), Math.max(most, value)];
  return (least + most) / 2;
}

/** The direction in which a camera stands, from what it looks at. */
export function directionOf(camera: Camera): Vector3 {
  return camera.getWorldDirection(new Vector3()).negate();
}

/** A direction as documents have it (z up), as pictures have it (y up). */
export function directionFrom([x, y, z]: readonly [number, number, number]): Vector3 {
  return new Vector3(x, z, -y);
}

/** The eight corners of a box. */
export function cornersOf(box: Box3): Vector3[] {
  if (box.isEmpty()) return [];
  const { min, max } = box;
  return [0, 1, 2, 3, 4, 5, 6, 7].map(
    (corner) =>
      new Vector3(
        corner & 1 ? max.x : min.x,
        corner & 2 ? max.y : min.y,
        corner & 4 ? max.z : min.z,
      ),
  );
}
