import {
  BufferAttribute,
  BufferGeometry,
  DirectionalLight,
  Group,
  Mesh,
  MeshLambertMaterial,
  type Camera,
  type Scene,
  type WebGLRenderer,
} from "three";

/** As many as scenes of the service have. */
const LIGHTS = 3;

/**
 * Has the program built that draws nearly everything without a graphics card, while the scene is
 * still on its way: it takes a third of a second, for which the first frame would wait. A program
 * that was not foreseen is built when it is needed, as always.
 */
export function warm(renderer: WebGLRenderer, world: Scene, camera: Camera): void {
  const geometry = new BufferGeometry();
  for (const name of ["position", "normal"]) geometry.setAttribute(name, new BufferAttribute(new Float32Array(9), 3));
  const group = new Group();
  for (let count = 0; count < LIGHTS; count += 1) group.add(new DirectionalLight());
  // Its material is kept: a program goes with the last material that has it.
  group.add(new Mesh(geometry, new MeshLambertMaterial()));
  renderer.compile(group, camera, world);
  // Without this it would begin only with the first frame.
  renderer.getContext().flush();
}
