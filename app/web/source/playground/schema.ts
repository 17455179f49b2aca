import type { Path } from "./completion.ts";
import { listed } from "./service.ts";

/** As much of JSON Schema as the service's own uses. */
export interface Schema {
  $ref?: string;
  anyOf?: Schema[];
  oneOf?: Schema[];
  discriminator?: { propertyName: string; mapping?: Record<string, string> };
  type?: string;
  properties?: Record<string, Schema>;
  additionalProperties?: Schema | boolean;
  required?: string[];
  items?: Schema;
  prefixItems?: Schema[];
  enum?: unknown[];
  const?: unknown;
  default?: unknown;
  description?: string;
}

const description = listed<{ components: { schemas: Record<string, Schema> } }>("/openapi.json");

/** The schema of programs, to be asked what may stand where. */
export class ProgramSchema {
  readonly #schemas: Record<string, Schema>;

  constructor(schemas: Record<string, Schema>) {
    this.#schemas = schemas;
  }

  static async load(): Promise<ProgramSchema> {
    return new ProgramSchema((await description()).components.schemas);
  }

  /** What may stand at a path, each possibility by itself; `valueAt` tells what stands on the way. */
  at(path: Path, valueAt: (path: Path) => unknown): Schema[] {
    let found = this.variants({ $ref: "#/components/schemas/Program" }, valueAt([]));
    path.forEach((name, depth) => {
      const inside = found.flatMap((schema) => this.#inside(schema, name));
      const value = valueAt(path.slice(0, depth + 1));
      found = inside.flatMap((schema) => this.variants(schema, value));
    });
    return found;
  }

  /** A schema's possibilities; where a discriminator has been written, the one that it names. */
  variants(schema: Schema, value: unknown): Schema[] {
    const meant = this.#resolve(schema);
    const choices = meant.anyOf ?? meant.oneOf;
    if (choices === undefined) return [meant];
    const { propertyName, mapping } = meant.discriminator ?? {};
    const named = propertyName !== undefined && isRecord(value) ? value[propertyName] : undefined;
    const target = typeof named === "string" ? mapping?.[named] : undefined;
    if (target !== undefined) return this.variants({ $ref: target }, value);
    return choices.flatMap((choice) => this.variants(choice, value));
  }

  #inside(schema: Schema, name: string | number): Schema[] {
    if (typeof name === "number") {
      const place = schema.prefixItems?.[name] ?? schema.items;
      return place ? [place] : [];
    }
    const property = schema.properties?.[name];
    if (property) return [property];
    const { additionalProperties } = schema;
    return typeof additionalProperties === "object" ? [additionalProperties] : [];
  }

  #resolve(schema: Schema): Schema {
    if (schema.$ref === undefined) return schema;
    const { $ref, ...beside } = schema;
    const named = this.#schemas[$ref.slice($ref.lastIndexOf("/") + 1)];
    return named ? { ...this.#resolve(named), ...beside } : beside;
  }
}

/** A word on what a schema takes. */
export function kindOf({ const: constant, enum: words, type }: Schema): string {
  if (constant !== undefined) return JSON.stringify(constant);
  if (words) return words.map((each) => JSON.stringify(each)).join(" | ");
  return type ?? "";
}

function isRecord(value: unknown): value is Record<string, unknown> {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}
