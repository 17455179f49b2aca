import { Vector3 } from "three";
import type { Scene } from "./scene.ts";
import type { Stage } from "./stage.ts";

/** How wide the scene stands before whoever wears the headset, in metres, and how far away. */
const WIDTH = 1.2;
const DISTANCE = 1.1;
const HEIGHT = 1.1;

/** Shows the scene in a headset, the size of a table, until the session ends. */
export async function enterHeadset(stage: Stage, scene: Scene): Promise<void> {
  const { xr } = stage.renderer;
  const session = await navigator.xr?.requestSession("immersive-vr", {
    optionalFeatures: ["local-floor"],
  });
  if (session === undefined) throw new Error("There is no headset.");
  const [middle, size] = [scene.box.getCenter(new Vector3()), scene.box.getSize(new Vector3())];
  const scale = WIDTH / Math.max(size.x, size.y, size.z, 1e-6);
  const { root } = scene;
  root.scale.setScalar(scale);
  root.position.set(0, HEIGHT, -DISTANCE).addScaledVector(middle, -scale);
  session.addEventListener("end", () => {
    stage.renderer.setAnimationLoop(null);
    xr.enabled = false;
    root.scale.setScalar(1);
    root.position.set(0, 0, 0);
    stage.resize();
  });
  xr.enabled = true;
  xr.setReferenceSpaceType("local-floor");
  await xr.setSession(session);
  stage.renderer.setAnimationLoop(() => stage.renderer.render(stage.world, stage.camera));
}
