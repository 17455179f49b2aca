// Prints what three.js finds in each file named on the command line, as JSON: every object with
// its name, user data, place in the world, number of triangles, vertex attributes, and what is special
// of its material; and whatever three.js warned of.
import { readFile } from 'node:fs/promises';
import { Box3, Texture } from 'three';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

// Browsers have it, Node has not; the loader reports its progress with it.
globalThis.ProgressEvent ??= class extends Event {};

// Node has no decoder of pictures either: of a texture, three.js finds its number alone.
function undrawn() {
  return {
    name: 'undrawn',
    loadTexture: async (number) => Object.assign(new Texture(), { userData: { number } }),
  };
}

function special(material) {
  return {
    type: material.type,
    texture: material.map?.userData.number ?? null,
    transmission: material.transmission ?? 0,
    clearcoat: material.clearcoat ?? 0,
  };
}

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
    attributes: object.isMesh ? Object.keys(object.geometry.attributes).sort() : [],
    material: object.isMesh ? special(object.material) : null,
  };
}

let warnings = [];
for (const level of ['warn', 'error']) {
  console[level] = (...words) => warnings.push(words.join(' '));
}

const found = [];
for (const path of process.argv.slice(2)) {
  const { buffer, byteOffset, byteLength } = await readFile(path);
  const data = buffer.slice(byteOffset, byteOffset + byteLength);
  warnings = [];
  const loader = new GLTFLoader().setMeshoptDecoder(MeshoptDecoder).register(undrawn);
  const { scene, cameras } = await loader.parseAsync(data, '');
  scene.updateMatrixWorld(true);
  const objects = [];
  scene.traverse((object) => objects.push(describe(object)));
  const camera = cameras[0];
  found.push({
    objects,
    cameras: cameras.length,
    view: camera.matrixWorldInverse.elements,
    projection: camera.projectionMatrix.elements,
    warnings,
  });
}
process.stdout.write(JSON.stringify(found));
