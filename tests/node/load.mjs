// Prints what three.js finds in each file named on the command line, as JSON: every object with
// its name, user data, place in the world and number of triangles.
import { readFile } from 'node:fs/promises';
import { Box3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

// Browsers have it, Node has not; the loader reports its progress with it.
globalThis.ProgressEvent ??= class extends Event {};

function triangles(object) {
  let count = 0;
  object.traverse((part) => {
    if (part.isMesh) count += part.geometry.index.count / 3;
  });
  return count;
}

function describe(object) {
  const box = new Box3().setFromObject(object);
  return {
    name: object.userData.name ?? object.name,
    type: object.type,
    data: object.userData,
    place: object.matrixWorld.elements,
    low: box.min.toArray(),
    high: box.max.toArray(),
    triangles: triangles(object),
  };
}

const found = [];
for (const path of process.argv.slice(2)) {
  const { buffer, byteOffset, byteLength } = await readFile(path);
  const data = buffer.slice(byteOffset, byteOffset + byteLength);
  const { scene, cameras } = await new GLTFLoader().parseAsync(data, '');
  scene.updateMatrixWorld(true);
  const objects = [];
  scene.traverse((object) => objects.push(describe(object)));
  const camera = cameras[0];
  found.push({
    objects,
    cameras: cameras.length,
    view: camera.matrixWorldInverse.elements,
    projection: camera.projectionMatrix.elements,
  });
}
process.stdout.write(JSON.stringify(found));
