import {
  Box3,
  BufferAttribute,
  BufferGeometry,
  Matrix3,
  Mesh,
  Vector3,
  type Material,
  type MeshStandardMaterial,
} from "three";
import type { Part } from "./scene.ts";
import type { ThingKey } from "./things.ts";

/** Above so many meshes, those of one material are drawn in one call. */
export const MOST_MESHES = 1000;

/** So that what the camera does not see can be left out. */
const MOST_VERTICES = 200_000;

/** A mesh that shows one thing. */
export interface Piece {
  mesh: Mesh;
  key: ThingKey;
}

/** Whether a piece can share a mesh with others: textures stand where their mesh is. */
export function canShare({ mesh }: Piece): boolean {
  const material = mesh.material as MeshStandardMaterial;
  return !Array.isArray(mesh.material) && !material.map && !material.vertexColors && !!mesh.geometry.index;
}

/** Meshes that show the same as these pieces, by material. They stand in the picture's space. */
export function merged(pieces: readonly Piece[]): Part[] {
  const byMaterial = new Map<Material, Piece[][]>();
  const vertices = new Map<Material, number>();
  for (const piece of pieces) {
    const material = piece.mesh.material as Material;
    const count = piece.mesh.geometry.getAttribute("position").count;
    const sum = (vertices.get(material) ?? 0) + count;
    const chunks = byMaterial.get(material) ?? [];
    const last = chunks.at(-1);
    if (last === undefined || sum > MOST_VERTICES) chunks.push([piece]);
    else last.push(piece);
    vertices.set(material, last === undefined || sum > MOST_VERTICES ? count : sum);
    byMaterial.set(material, chunks);
  }
  return [...byMaterial].flatMap(([material, chunks]) => chunks.flatMap((chunk) => join(chunk, material)));
}

function join(pieces: readonly Piece[], material: Material): Part[] {
  let [vertexCount, indexCount] = [0, 0];
  for (const { mesh } of pieces) {
    vertexCount += mesh.geometry.getAttribute("position").count;
    indexCount += mesh.geometry.index?.count ?? 0;
  }
  const positions = new Float32Array(3 * vertexCount);
  const normals = new Float32Array(3 * vertexCount);
  const index = new Uint32Array(indexCount);
  const joined = new Mesh(new BufferGeometry(), material);
  const parts: Part[] = [];
  const [corner, turn] = [new Vector3(), new Matrix3()];
  let [vertex, at] = [0, 0];
  for (const { mesh, key } of pieces) {
    const { geometry, matrixWorld } = mesh;
    const [from, upright] = [geometry.getAttribute("position"), geometry.getAttribute("normal")];
    const box = new Box3();
    turn.getNormalMatrix(matrixWorld);
    for (let number = 0; number < from.count; number += 1) {
      corner.fromBufferAttribute(from, number).applyMatrix4(matrixWorld);
      box.expandByPoint(corner);
      corner.toArray(positions, 3 * (vertex + number));
      corner.fromBufferAttribute(upright, number).applyMatrix3(turn).normalize();
      corner.toArray(normals, 3 * (vertex + number));
    }
    const count = geometry.index?.count ?? 0;
    for (let number = 0; number < count; number += 1) {
      index[at + number] = vertex + (geometry.index?.getX(number) ?? 0);
    }
    parts.push({ mesh: joined, start: at, count, box, key });
    vertex += from.count;
    at += count;
  }
  joined.geometry.setAttribute("position", new BufferAttribute(positions, 3));
  joined.geometry.setAttribute("normal", new BufferAttribute(normals, 3));
  joined.geometry.setIndex(new BufferAttribute(index, 1));
  return parts;
}
