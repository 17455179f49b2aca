// What the tests of the adapter are made with: node's test runner, and random programs.
import type { ProgramDocument } from "tubeloom-client";

declare const process: {
  env: Record<string, string | undefined>;
  getBuiltinModule(name: string): unknown;
};

interface Assert {
  deepStrictEqual(found: unknown, wanted: unknown, message?: string): void;
  strictEqual(found: unknown, wanted: unknown, message?: string): void;
  ok(found: unknown, message?: string): void;
}

const runner = process.getBuiltinModule("node:test") as {
  test(name: string, body: () => Promise<void>): void;
};
const assert = process.getBuiltinModule("node:assert") as Assert;

export const { test } = runner;
export const { deepStrictEqual: deepEqual, strictEqual: equal, ok } = assert;

export function environment(name: string): string {
  return process.env[name] ?? "";
}

export type Chance = () => number;

/** Numbers from 0 to 1, the same for the same seed (Mulberry32). */
export function chance(seed: number): Chance {
  let state = seed;
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let mixed = Math.imul(state ^ (state >>> 15), 1 | state);
    mixed = (mixed + Math.imul(mixed ^ (mixed >>> 7), 61 | mixed)) ^ mixed;
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 2 ** 32;
  };
}

export function pick<Value>(random: Chance, values: readonly Value[]): Value {
  const found = values[Math.floor(random() * values.length)];
  if (found === undefined) throw new Error("There is nothing to pick from.");
  return found;
}

function some<Value>(random: Chance, values: readonly Value[]): Value[] {
  return values
    .map((value) => ({ value, place: random() }))
    .sort((one, other) => one.place - other.place)
    .slice(0, Math.floor(random() * (values.length + 1)))
    .map(({ value }) => value);
}

const NAMES = ["a", "b", "c", "d", "e", "f"];
const SHAPES = [
  { type: "box", size: [2, 1, 0.5] },
  { type: "box", size: [1, 1, 1] },
  { type: "sphere", radius: 0.5 },
  { type: "cylinder", radius: 0.4, height: 1 },
];
const DATA = [{ flow: { x: 1, type: "t" } }, { flow: { y: 2 }, mine: [1, null] }, { mine: { deep: true } }];
const POINTS = [{ id: "l", position: [-0.2, 0, 0.2] }, { id: "r", position: [0.2, 0, 0.2] }];

/** A small program of which nothing is the same twice, but for names. */
export function randomProgram(random: Chance): ProgramDocument {
  const maybe = <Value>(name: string, values: readonly Value[]) =>
    random() < 0.5 ? { [name]: pick(random, values) } : {};
  const names = some(random, NAMES);
  if (names.length === 0) names.push("a");
  const items = names.map((id, number) => ({
    id,
    ...maybe("label", ["One", "Two"]),
    ...maybe("kind", ["variable", "constant"]),
    ...maybe("color", ["#112233", "#445566"]),
    ...maybe("shape", SHAPES),
    ...maybe("data", DATA),
    ...(number > 0 && random() < 0.3 ? { parent: pick(random, names.slice(0, number)) } : {}),
    ...(random() < 0.5 ? { position: [Math.floor(random() * 9), -number, 0.25] } : {}),
    attachment_points: random() < 0.7 ? POINTS : [],
  }));
  const ends = items.flatMap(({ id, attachment_points }) => [
    { item: id },
    ...attachment_points.map((point) => ({ item: id, point: point.id })),
  ]);
  const hyperedges = some(random, ["x", "y", "z"]).flatMap((id) => {
    const attachments = some(random, ends).slice(0, 5);
    if (attachments.length < 2) return [];
    return [{ id, attachments, ...maybe("label", ["One"]), ...maybe("radius", [0.1]), ...maybe("data", DATA) }];
  });
  const frame = { ...maybe("name", ["This", "That"]), ...maybe("style", [{ halo: 0.5 }, { labels: false }]) };
  return { ...frame, items, hyperedges } as ProgramDocument;
}

/** The program with its parts in the order of their names: edits do not tell orders. */
export function sorted(program: ProgramDocument): ProgramDocument {
  const name = (part: object) => JSON.stringify(part);
  const inOrder = <Part extends object>(parts: readonly Part[]) =>
    [...parts].sort((one, other) => (name(one) < name(other) ? -1 : 1));
  const hyperedges = (program.hyperedges ?? []).map((each) => ({ ...each, attachments: inOrder(each.attachments) }));
  return { ...program, items: inOrder(program.items), hyperedges: inOrder(hyperedges) };
}
