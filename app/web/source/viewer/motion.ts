import { Vector3 } from "three";
import { tangentOf } from "./camera.ts";
import type { Mover, Stage } from "./stage.ts";

/** How the picture moves by itself: a little movement shows depth better than two eyes do. */
export const MOTIONS = ["none", "sway", "turntable"] as const;
export type Motion = (typeof MOTIONS)[number];

const SWAY_DEGREES = 5;
const SWAY_SECONDS = 6;
const DEGREES_PER_SECOND = 12;

/** Moves the camera around what it looks at, unless whoever looks wants no movement. */
export class Mobile {
  readonly #stage: Stage;
  #mover: Mover | undefined;
  #held = false;

  constructor(stage: Stage) {
    this.#stage = stage;
    stage.controls.addEventListener("start", () => (this.#held = true));
    stage.controls.addEventListener("end", () => (this.#held = false));
  }

  set motion(motion: Motion) {
    if (this.#mover) this.#stage.movers.delete(this.#mover);
    this.#mover = undefined;
    if (motion === "none" || this.#stage.reducedMotion) return;
    this.#mover = motion === "sway" ? this.#sway() : this.#turn();
    this.#stage.movers.add(this.#mover);
    this.#stage.invalidate();
  }

  #sway(): Mover {
    let time = 0;
    const angle = () => SWAY_DEGREES * Math.sin((2 * Math.PI * time) / SWAY_SECONDS);
    return (seconds) => {
      if (this.#held) return true;
      const before = angle();
      time += seconds;
      this.#rotate(angle() - before);
      return true;
    };
  }

  #turn(): Mover {
    return (seconds) => {
      if (!this.#held) this.#rotate(DEGREES_PER_SECOND * seconds);
      return true;
    };
  }

  #rotate(degrees: number): void {
    turn(this.#stage, degrees, 0);
  }
}

/** Turns the camera around what it looks at: to the side, and upwards. */
export function turn(stage: Stage, sideways: number, upward: number): void {
  const { position, target } = stage.pose;
  const arm = position.sub(target);
  const polar = Math.acos(Math.min(Math.max(arm.y / arm.length(), -1), 1));
  const lowered = Math.min(Math.max(polar - (upward * Math.PI) / 180, 0.01), Math.PI - 0.01);
  const azimuth = Math.atan2(arm.x, arm.z) + (sideways * Math.PI) / 180;
  arm.setFromSphericalCoords(arm.length(), lowered, azimuth);
  stage.look({ position: arm.add(target), target }, "at once");
}

/** Goes nearer or away: the distance becomes `factor` times what it is. */
export function approach(stage: Stage, factor: number): void {
  const { position, target } = stage.pose;
  position.sub(target).multiplyScalar(factor).add(target);
  stage.look({ position, target }, "at once");
}

/** Moves the camera and what it looks at: by shares of the picture's height, right and up. */
export function shift(stage: Stage, right: number, up: number): void {
  const { position, target } = stage.pose;
  const height = 2 * position.distanceTo(target) * tangentOf(stage.camera);
  const [x, y] = [new Vector3(), new Vector3()];
  stage.camera.matrixWorld.extractBasis(x, y, new Vector3());
  const step = x.multiplyScalar(right * height).addScaledVector(y, up * height);
  stage.look({ position: position.add(step), target: target.add(step) }, "at once");
}
