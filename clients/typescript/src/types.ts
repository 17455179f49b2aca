import type { components, operations } from "./schema.js";

/** A program, as the service reads it. */
export type ProgramDocument = components["schemas"]["Program"];

/** A program, or a document in another format, as an object or as text. */
export type Document = ProgramDocument | object | string;

/** One of the edits of a stored program. */
export type Edit = components["schemas"]["EditList"]["edits"][number];

/** The numbers of a layout. */
export type Layout = components["schemas"]["LayoutNumbers"];

/** What a scene can be answered as. */
export type Format = components["schemas"]["SceneFormat"];

type Query<Operation extends keyof operations> = NonNullable<
  operations[Operation]["parameters"]["query"]
>;

/** All that may be asked of a scene; what is left out is the service's default. */
export type RenderOptions = Omit<Query<"render_v1_render_post">, "errors">;

/** All that may be asked of a stored program's scene. */
export type StoredRenderOptions = Omit<
  Query<"render_program_v1_programs__id__render_get">,
  "errors"
>;

export const JSON_TYPE = { "Content-Type": "application/json" };

/** The document as it is sent. */
export function bodyOf(document: Document): string {
  return typeof document === "string" ? document : JSON.stringify(document);
}
