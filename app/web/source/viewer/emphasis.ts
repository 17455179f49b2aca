import { Color, type Material, type Mesh, type MeshStandardMaterial } from "three";
import { lengthOf } from "./objects.ts";
import type { Part, Scene } from "./scene.ts";
import { keyOf, type ThingKey, type ThingName } from "./things.ts";

/** What becomes of all that is not selected. */
export const OTHERS = ["dim", "hide", "keep"] as const;
export type Others = (typeof OTHERS)[number];

type Look = "plain" | "dimmed" | "lit" | "hidden";

interface Looks {
  plain: Material;
  dimmed: Material;
  lit: Material;
}

const DIMMED_OPACITY = 0.1;

/** Shows what is selected and what the pointer is on; all else steps back. */
export class Emphasis {
  readonly #scene: Scene;
  readonly #looks = new Map<Material, Looks>();
  /** The material that the file gives each mesh. */
  readonly #own = new WeakMap<Mesh, Material>();
  selected: ReadonlySet<ThingKey> = new Set();
  hovered: ThingKey | undefined;
  others: Others = "dim";

  constructor(scene: Scene) {
    this.#scene = scene;
  }

  /** Whether a thing stands out, or nothing does. */
  isPlain: (key: ThingKey) => boolean = () => true;

  /** Make everything look as it should. */
  apply(): void {
    const lookOf = this.#chooser();
    this.isPlain = (key) => ["plain", "lit"].includes(lookOf(key));
    for (const [mesh, parts] of this.#scene.meshes) this.#dress(mesh, parts, lookOf);
  }

  /** Free what the graphics card keeps. */
  clear(): void {
    for (const { dimmed, lit } of this.#looks.values()) {
      dimmed.dispose();
      lit.dispose();
    }
    this.#looks.clear();
  }

  #chooser(): (key: ThingKey) => Look {
    const { selected, hovered, others } = this;
    const kept = new Set(selected);
    for (const key of selected) {
      const thing = this.#scene.things.get(key);
      if (thing) for (const other of this.#scene.neighbours(thing)) kept.add(other);
      for (const inside of thing ? this.#around(thing) : []) kept.add(inside);
    }
    const away: Look = others === "hide" ? "hidden" : others === "dim" ? "dimmed" : "plain";
    return (key) => {
      if (key === hovered) return "lit";
      return selected.size === 0 || kept.has(key) ? "plain" : away;
    };
  }

  /** The hyperedges of an item stand out with all that they join. */
  #around(thing: ThingName): ThingKey[] {
    if (thing.shows === "hyperedge") return [];
    return this.#scene
      .neighbours(thing)
      .flatMap((key) => (this.#scene.things.get(key)?.attachments ?? []))
      .map(({ item }) => keyOf({ shows: "item", id: item }));
  }

  #dress(mesh: Mesh, parts: readonly Part[], lookOf: (key: ThingKey) => Look): void {
    const looks = this.#looksOf(mesh);
    const [first] = parts;
    if (first === undefined) return;
    const isWhole = parts.length === 1 && first.count === lengthOf(mesh);
    const chosen = parts.map(({ key }) => lookOf(key));
    if (isWhole || (chosen.every((look) => look === "plain") && covers(parts, mesh))) {
      const [look] = chosen;
      mesh.visible = look !== "hidden";
      mesh.material = look === "hidden" || look === undefined ? looks.plain : looks[look];
      return;
    }
    mesh.visible = true;
    mesh.material = [looks.plain, looks.dimmed, looks.lit];
    mesh.geometry.clearGroups();
    let open: { start: number; end: number; look: Look } | undefined;
    const close = () => {
      if (open === undefined || open.look === "hidden") return;
      const place = { plain: 0, dimmed: 1, lit: 2 }[open.look];
      mesh.geometry.addGroup(open.start, open.end - open.start, place);
    };
    parts.forEach(({ start, count }, number) => {
      const look = chosen[number] ?? "plain";
      if (open?.look === look && open.end === start) {
        open.end = start + count;
        return;
      }
      close();
      open = { start, end: start + count, look };
    });
    close();
  }

  #looksOf(mesh: Mesh): Looks {
    let own = this.#own.get(mesh);
    if (own === undefined) {
      own = mesh.material as Material;
      this.#own.set(mesh, own);
    }
    let looks = this.#looks.get(own);
    if (looks === undefined) {
      looks = { plain: own, dimmed: dimmed(own), lit: lit(own) };
      this.#looks.set(own, looks);
    }
    return looks;
  }
}

function dimmed(material: Material): Material {
  const copy = material.clone();
  copy.transparent = true;
  copy.opacity = DIMMED_OPACITY;
  copy.depthWrite = false;
  if ("transmission" in copy) copy.transmission = 0;
  return copy;
}

function lit(material: Material): Material {
  const copy = material.clone() as MeshStandardMaterial;
  copy.emissive = copy.vertexColors ? new Color(0x333333) : copy.color.clone();
  copy.emissiveIntensity = 0.45;
  return copy;
}

/** Whether nothing of a mesh has been taken away. */
function covers(parts: readonly Part[], mesh: Mesh): boolean {
  return parts.reduce((sum, { count }) => sum + count, 0) === lengthOf(mesh);
}
