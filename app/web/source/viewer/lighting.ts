import {
  Box3,
  DirectionalLight,
  HemisphereLight,
  Mesh,
  PlaneGeometry,
  PMREMGenerator,
  ShadowMaterial,
  Vector3,
  type Object3D,
  type Scene,
  type Texture,
  type WebGLRenderer,
} from "three";
import { RoomEnvironment } from "three/addons/environments/RoomEnvironment.js";

export const SHADOWS = ["auto", "on", "off"] as const;
export type Shadows = (typeof SHADOWS)[number];

/** Above so many triangles, or without a graphics card, shadows are drawn only where asked for. */
const TRIANGLES_WITH_SHADOW = 300_000;

const SHADOW_PIXELS = 2048;

/** Light on the scene: the file's own, some from the sky, a room for metal and glass to mirror. */
export class Lighting {
  readonly #renderer: WebGLRenderer;
  readonly #world: Scene;
  readonly #isSoftware: boolean;
  readonly #sky = new HemisphereLight(0xffffff, 0xb9bdc6, 0.85);
  readonly #ground: Mesh<PlaneGeometry, ShadowMaterial>;
  #room: Texture | undefined;
  #key: DirectionalLight | undefined;

  constructor(renderer: WebGLRenderer, world: Scene, isSoftware: boolean) {
    this.#renderer = renderer;
    this.#isSoftware = isSoftware;
    this.#world = world;
    const catcher = new ShadowMaterial({ color: 0x0b1220, opacity: 0.22, depthWrite: false });
    this.#ground = new Mesh(new PlaneGeometry(1, 1), catcher);
    this.#ground.rotation.x = -Math.PI / 2;
    this.#ground.receiveShadow = true;
    this.#ground.raycast = () => undefined;
    this.#ground.visible = false;
    world.add(this.#sky, this.#ground);
    renderer.shadowMap.autoUpdate = false;
  }

  /** Light what has come, `box` being around all that is shown. */
  light(scene: Object3D, box: Box3, triangles: number, shadows: Shadows): void {
    const isCheap = !this.#isSoftware && triangles <= TRIANGLES_WITH_SHADOW;
    const isShadowed = shadows === "on" || (shadows === "auto" && isCheap);
    this.#key = undefined;
    let mirrors = false;
    scene.traverse((object) => {
      if (object instanceof DirectionalLight) {
        object.castShadow = isShadowed && object.name.startsWith("key");
        if (object.castShadow) this.#key = object;
      } else if (object instanceof Mesh) {
        object.castShadow = object.receiveShadow = isShadowed;
        for (const each of [object.material].flat()) {
          mirrors ||= (each.metalness ?? 0) > 0.5 || (each.transmission ?? 0) > 0;
          if (each.transmission > 0) object.castShadow = false;
        }
      }
    });
    if (mirrors) this.#mirror();
    this.#ground.visible = isShadowed && this.#key !== undefined && !box.isEmpty();
    this.#renderer.shadowMap.enabled = isShadowed;
    if (this.#key && this.#ground.visible) this.#shade(this.#key, box);
    this.#renderer.shadowMap.needsUpdate = true;
  }

  /** Have shadows drawn anew: something has gone, or come back. */
  refresh(): void {
    this.#renderer.shadowMap.needsUpdate = true;
  }

  dispose(): void {
    this.#room?.dispose();
    this.#ground.geometry.dispose();
    this.#ground.material.dispose();
  }

  #mirror(): void {
    if (this.#room) return;
    const generator = new PMREMGenerator(this.#renderer);
    this.#room = generator.fromScene(new RoomEnvironment(), 0.04).texture;
    generator.dispose();
    this.#world.environment = this.#room;
    this.#world.environmentIntensity = 0.35;
  }

  #shade(key: DirectionalLight, box: Box3): void {
    const [middle, size] = [box.getCenter(new Vector3()), box.getSize(new Vector3())];
    const radius = size.length() / 2;
    const towards = key.target.getWorldPosition(new Vector3());
    const from = key.getWorldPosition(new Vector3()).sub(towards).normalize();
    key.parent?.worldToLocal(key.position.copy(middle).addScaledVector(from, 2 * radius));
    key.target.position.copy(key.worldToLocal(middle.clone()));
    // The light's own turn was its direction; now its place and its target are.
    key.rotation.set(0, 0, 0);
    key.updateMatrixWorld(true);
    key.target.position.copy(key.worldToLocal(middle.clone()));
    const { camera, mapSize } = key.shadow;
    [camera.left, camera.right, camera.bottom, camera.top] = [-radius, radius, -radius, radius];
    [camera.near, camera.far] = [0.5 * radius, 3.5 * radius];
    camera.updateProjectionMatrix();
    mapSize.set(SHADOW_PIXELS, SHADOW_PIXELS);
    key.shadow.normalBias = radius / SHADOW_PIXELS;
    key.shadow.bias = -0.0004;
    key.shadow.intensity = 0.75;
    this.#ground.position.set(middle.x, box.min.y - 0.002 * radius, middle.z);
    this.#ground.scale.setScalar(8 * radius);
  }
}
