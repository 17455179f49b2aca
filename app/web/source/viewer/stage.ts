import { Box3, PerspectiveCamera, Scene as World, Vector3, WebGLRenderer, type OrthographicCamera } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Lighting } from "./lighting.ts";
import type { Lens, Pose } from "./camera.ts";
import type { Detail } from "./loading.ts";
import { ParallelLens } from "./parallel.ts";
import { drawerOf, type Drawer, type Stereo } from "./stereo.ts";
import { warm } from "./warming.ts";

/** What moves the camera by itself; returns whether it goes on. */
export type Mover = (seconds: number) => boolean;

const MOVE_SECONDS = 0.35;

/** Three's world on a canvas: draws a frame where something has changed, and none otherwise. */
export class Stage {
  readonly world = new World();
  /** Says where one looks from; headsets and stereo draw with it in any case. */
  readonly camera = new PerspectiveCamera(30, 4 / 3, 0.1, 1000);
  readonly renderer: WebGLRenderer;
  /** Whether the processor draws, and not a graphics card. */
  readonly isSoftware: boolean;
  readonly controls: OrbitControls;
  readonly lighting: Lighting;
  readonly movers = new Set<Mover>();
  /** Called after each frame that was drawn, with the milliseconds that it took. */
  onframe: ((milliseconds: number) => void) | undefined;
  /** Around all that is shown; depths are chosen by it. */
  box = new Box3();
  reducedMotion = false;
  /** Whether what is far shall be drawn as large as what is near, where one picture is drawn. */
  isParallel = false;
  readonly #parallel = new ParallelLens();
  readonly #canvas: HTMLCanvasElement;
  #drawer: Drawer;
  #dirty = false;
  #last: number | undefined;
  #waiting: (() => void)[] = [];
  #move: { from: Pose; to: Pose; began: number } | undefined;

  constructor(canvas: HTMLCanvasElement) {
    this.#canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.setClearAlpha(0);
    // All programs are three's own; to ask how they were built, a frame waits several times.
    this.renderer.debug.checkShaderErrors = false;
    this.#drawer = drawerOf("none", this.renderer);
    this.isSoftware = isDrawnBySoftware(this.renderer);
    this.lighting = new Lighting(this.renderer, this.world, this.isSoftware);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.zoomToCursor = true;
    this.controls.addEventListener("change", this.invalidate);
    this.controls.addEventListener("start", () => (this.#move = undefined));
    this.world.add(this.camera);
    this.renderer.xr.addEventListener("sessionend", this.invalidate);
    if (this.isSoftware) warm(this.renderer, this.world, this.camera);
  }

  /** Have a frame drawn soon. */
  invalidate = (): void => {
    if (this.#dirty || this.renderer.xr.isPresenting) return;
    this.#dirty = true;
    requestAnimationFrame(this.#frame);
  };

  /** Once a frame shows all that was changed until now. */
  drawn(): Promise<void> {
    this.invalidate();
    return new Promise((resolve) => this.#waiting.push(resolve));
  }

  set stereo(kind: Stereo) {
    this.#drawer.dispose();
    this.#drawer = drawerOf(kind, this.renderer);
    this.resize();
  }

  /** Take the size that the page gives the canvas. */
  resize = (): void => {
    const { clientWidth, clientHeight } = this.#canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    const ratio = Math.min(devicePixelRatio, this.isSoftware ? 1.5 : 2);
    this.renderer.setPixelRatio(ratio);
    this.#drawer.setSize(clientWidth, clientHeight);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.invalidate();
  };

  get pose(): Pose {
    return { position: this.camera.position.clone(), target: this.controls.target.clone() };
  }

  /** Look from a pose; from where it looks now it goes there in a moment, unless `at once`. */
  look(to: Pose, when: "gently" | "at once" = "gently"): void {
    if (when === "at once" || this.reducedMotion) {
      this.#move = undefined;
      this.#take(to);
      this.invalidate();
      return;
    }
    this.#move = { from: this.pose, to, began: performance.now() };
    this.movers.add(this.#glide);
    this.invalidate();
  }

  /** The camera that the picture is drawn with. */
  get eye(): PerspectiveCamera | OrthographicCamera {
    return this.lens.isParallel ? this.#parallel.camera : this.camera;
  }

  get lens(): Lens {
    const { share, isSingle } = this.#drawer;
    return { fov: this.camera.fov, aspect: this.camera.aspect * share, isParallel: this.isParallel && isSingle };
  }

  /** How large a picture the tubes are to be made for. */
  get detail(): Detail {
    const { clientWidth, clientHeight } = this.#canvas;
    const ratio = this.isSoftware ? 0.5 : Math.min(devicePixelRatio, 2);
    const clamp = (size: number) => Math.min(Math.max(Math.round((size * ratio) / 256) * 256, 256), 4096);
    return { width: clamp(clientWidth), height: clamp(clientHeight) };
  }

  /** Draw now, and copy what is seen. `scale` makes it so many times as large. */
  async picture(scale: number, background: string): Promise<Blob> {
    const { clientWidth, clientHeight } = this.#canvas;
    const before = this.renderer.getPixelRatio();
    const copy = document.createElement("canvas");
    this.renderer.setPixelRatio(scale);
    this.#drawer.setSize(clientWidth, clientHeight);
    this.#draw();
    [copy.width, copy.height] = [this.#canvas.width, this.#canvas.height];
    const context = copy.getContext("2d");
    if (context === null) throw new Error("This browser cannot copy the picture.");
    context.fillStyle = background;
    context.fillRect(0, 0, copy.width, copy.height);
    context.drawImage(this.#canvas, 0, 0);
    this.renderer.setPixelRatio(before);
    this.#drawer.setSize(clientWidth, clientHeight);
    this.invalidate();
    return new Promise((resolve, reject) => {
      copy.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("The picture is too large."))));
    });
  }

  dispose(): void {
    this.movers.clear();
    this.controls.dispose();
    this.lighting.dispose();
    this.#drawer.dispose();
    this.renderer.dispose();
    this.onframe = undefined;
  }

  #glide = (): boolean => {
    if (this.#move === undefined) return false;
    const { from, to, began } = this.#move;
    const share = Math.min((performance.now() - began) / 1000 / MOVE_SECONDS, 1);
    const eased = share * share * (3 - 2 * share);
    this.#take({
      position: from.position.clone().lerp(to.position, eased),
      target: from.target.clone().lerp(to.target, eased),
    });
    if (share === 1) this.#move = undefined;
    return share < 1;
  };

  #take({ position, target }: Pose): void {
    this.camera.position.copy(position);
    this.controls.target.copy(target);
    this.controls.update();
  }

  #frame = (now: number): void => {
    this.#dirty = false;
    const seconds = this.#last === undefined ? 0 : Math.min((now - this.#last) / 1000, 0.1);
    for (const mover of this.movers) if (!mover(seconds)) this.movers.delete(mover);
    const began = performance.now();
    this.#draw();
    const waiting = this.#waiting;
    this.#waiting = [];
    for (const resolve of waiting) resolve();
    this.onframe?.(performance.now() - began);
    this.#last = this.movers.size > 0 ? now : undefined;
    if (this.movers.size > 0) this.invalidate();
  };

  #draw(): void {
    this.#chooseDepths();
    if (this.lens.isParallel) {
      this.#parallel.follow(this.camera, this.controls.target, this.box);
      this.renderer.render(this.world, this.#parallel.camera);
    } else {
      this.#drawer.render(this.world, this.camera);
    }
  }

  /** As narrow as possible around what there is: the depth buffer is coarse. */
  #chooseDepths(): void {
    if (this.box.isEmpty()) return;
    const radius = this.box.getSize(new Vector3()).length() / 2;
    const distance = this.camera.position.distanceTo(this.box.getCenter(new Vector3()));
    this.camera.far = distance + 2 * radius + 1;
    this.camera.near = Math.max(distance - 1.2 * radius, this.camera.far / 2000);
    this.camera.updateProjectionMatrix();
  }
}

function isDrawnBySoftware(renderer: WebGLRenderer): boolean {
  const gl = renderer.getContext();
  const names = gl.getExtension("WEBGL_debug_renderer_info");
  const name = names ? String(gl.getParameter(names.UNMASKED_RENDERER_WEBGL)) : "";
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}
