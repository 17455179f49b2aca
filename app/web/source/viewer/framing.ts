import { OrthographicCamera, type Vector3 } from "three";
import type { GLTF } from "three/addons/loaders/GLTFLoader.js";
import { directionFrom, directionOf, placing, poseAround, type Corner, type Pose } from "./camera.ts";
import type { Emphasis } from "./emphasis.ts";
import { cornersOn, type Part, type Scene } from "./scene.ts";
import type { Stage } from "./stage.ts";

const VIEWS: Record<string, readonly [number, number, number]> = {
  top: [0, 0, 1],
  front: [0, -1, 0.12],
  side: [1, 0, 0.12],
  back: [0, 1, 0.12],
  isometric: [1, -1, 0.82],
};

const USUAL_DIRECTION = directionFrom([0.2, -1, 1]);

/** On a picture that is lower, the toolbar may be over it. */
const MOST_COVERED = 0.25;

/** Chooses where to look from, so that all is seen that is not hidden. */
export class Framing {
  readonly #stage: Stage;
  readonly #scene: Scene;
  readonly #emphasis: Emphasis;
  readonly #covered: () => Corner | undefined;
  /** The direction in which the document has its camera. */
  #given = USUAL_DIRECTION;
  #isFitted = true;

  /** `covered` tells of what is under the toolbar. */
  constructor(stage: Stage, scene: Scene, emphasis: Emphasis, covered: () => Corner | undefined) {
    this.#covered = covered;
    [this.#stage, this.#scene, this.#emphasis] = [stage, scene, emphasis];
    stage.controls.addEventListener("start", () => this.leave());
  }

  /** Step back or nearer, until all is just seen. */
  fit(when: "gently" | "at once" = "gently"): void {
    const { position, target } = this.#stage.pose;
    this.#look(position.sub(target), when);
  }

  /** Look from a view by its name, or from a direction (z up). */
  look(view: string | readonly [number, number, number]): void {
    const named = typeof view === "string" ? VIEWS[view] : view;
    this.#look(named ? directionFrom(named) : this.#given, "gently");
  }

  /** Look as a file says that is shown from now on. */
  begin(): void {
    this.#look(this.#given, "at once");
  }

  /** Learn how a file has its camera. */
  learn({ cameras: [camera] }: GLTF): void {
    this.#given = camera ? directionOf(camera) : USUAL_DIRECTION;
    this.#stage.isParallel = camera instanceof OrthographicCamera;
  }

  /** Somebody has chosen where to look from. */
  leave(): void {
    this.#isFitted = false;
  }

  /** Take another size: all is seen as before, unless somebody has chosen where to look from. */
  resize(): void {
    this.#stage.resize();
    if (this.#isFitted) this.fit("at once");
  }

  #look(direction: Vector3, when: "gently" | "at once"): void {
    const { selected, others } = this.#emphasis;
    const isPart = selected.size > 0 && others === "hide";
    const boxes = isPart ? this.#scene.boxesOf(selected) : this.#scene.boxesOf();
    this.#stage.look(this.#around(boxes, direction), when);
    this.#isFitted = true;
  }

  /** From where all is just seen; if a part of it were under the toolbar, all goes below that. */
  #around(boxes: readonly Box[], direction: Vector3): Pose {
    const [lens, covered] = [this.#stage.lens, this.#covered()];
    const corners = boxes.flatMap((box) => box.corners);
    const pose = poseAround(corners, direction, lens);
    if (covered === undefined || !reaches(boxes, placing(pose, lens), covered)) return pose;
    return poseAround(corners, direction, lens, Math.min(covered.bottom, MOST_COVERED));
  }
}

interface Box {
  part: Part;
  corners: readonly Vector3[];
}

/** Whether anything is seen in a corner of the picture. */
function reaches(boxes: readonly Box[], place: (point: Vector3) => [number, number], { left, bottom }: Corner): boolean {
  return boxes.some(({ part, corners }) => {
    const places = corners.map(place);
    // A slanted box is seen where there is nothing of what is in it.
    if (places.every(([x]) => x < left) || places.every(([, y]) => y > bottom)) return false;
    return cornersOn(part).some((corner) => {
      const [x, y] = place(corner);
      return x > left && y < bottom;
    });
  });
}
