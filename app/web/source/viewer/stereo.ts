import { StereoCamera, Vector2, type PerspectiveCamera, type Scene, type WebGLRenderer } from "three";
import { AnaglyphEffect } from "three/addons/effects/AnaglyphEffect.js";

/** One picture, or one for each eye: in red and cyan, or side by side for straight or crossed eyes. */
export const STEREO = ["none", "anaglyph", "parallel", "crossed"] as const;
export type Stereo = (typeof STEREO)[number];

/** How a frame comes onto the canvas. */
export interface Drawer {
  /** How much of the canvas's width one picture has. */
  readonly share: number;
  /** Whether it draws one picture, whatever the camera. */
  readonly isSingle: boolean;
  setSize(width: number, height: number): void;
  render(world: Scene, camera: PerspectiveCamera): void;
  dispose(): void;
}

export function drawerOf(kind: Stereo, renderer: WebGLRenderer): Drawer {
  switch (kind) {
    case "anaglyph":
      return new RedAndCyan(renderer);
    case "parallel":
      return new SideBySide(renderer, false);
    case "crossed":
      return new SideBySide(renderer, true);
    case "none":
      return {
        share: 1,
        isSingle: true,
        setSize: (width, height) => renderer.setSize(width, height, false),
        render: (world, camera) => renderer.render(world, camera),
        dispose: () => undefined,
      };
  }
}

/** Between the eyes, as a share of the distance to what is looked at: as of a model on a table. */
const EYE_SHARE = 1 / 30;

class RedAndCyan implements Drawer {
  readonly share = 1;
  readonly isSingle = false;
  readonly #renderer: WebGLRenderer;
  readonly #effect: AnaglyphEffect;

  constructor(renderer: WebGLRenderer) {
    this.#renderer = renderer;
    this.#effect = new AnaglyphEffect(renderer);
  }

  setSize(width: number, height: number): void {
    this.#effect.setSize(width, height);
    // The effect gives the canvas a size of its own; the page's style sheet does that here.
    Object.assign(this.#renderer.domElement.style, { width: "", height: "" });
  }

  render(world: Scene, camera: PerspectiveCamera): void {
    this.#effect.planeDistance = camera.position.length();
    this.#effect.eyeSep = this.#effect.planeDistance * EYE_SHARE;
    this.#effect.render(world, camera);
  }

  dispose(): void {
    this.#effect.dispose();
  }
}

class SideBySide implements Drawer {
  readonly share = 0.5;
  readonly isSingle = false;
  readonly #renderer: WebGLRenderer;
  readonly #isCrossed: boolean;
  readonly #eyes = new StereoCamera();
  readonly #size = new Vector2();

  constructor(renderer: WebGLRenderer, isCrossed: boolean) {
    this.#renderer = renderer;
    this.#isCrossed = isCrossed;
    this.#eyes.aspect = this.share;
  }

  setSize(width: number, height: number): void {
    this.#renderer.setSize(width, height, false);
  }

  render(world: Scene, camera: PerspectiveCamera): void {
    world.updateMatrixWorld();
    camera.updateMatrixWorld();
    const focus = camera.position.length();
    camera.focus = focus;
    this.#eyes.eyeSep = focus * EYE_SHARE;
    this.#eyes.update(camera);
    const eyes = [this.#eyes.cameraL, this.#eyes.cameraR];
    if (this.#isCrossed) eyes.reverse();
    const { width, height } = this.#renderer.getSize(this.#size);
    this.#renderer.setScissorTest(true);
    eyes.forEach((eye, side) => {
      this.#renderer.setScissor((side * width) / 2, 0, width / 2, height);
      this.#renderer.setViewport((side * width) / 2, 0, width / 2, height);
      this.#renderer.render(world, eye);
    });
    this.dispose();
  }

  dispose(): void {
    const { width, height } = this.#renderer.getSize(this.#size);
    this.#renderer.setScissorTest(false);
    this.#renderer.setViewport(0, 0, width, height);
  }
}
