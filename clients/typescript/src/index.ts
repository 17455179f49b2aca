export { Client } from "./client.js";
export type { ConnectionOptions } from "./connection.js";
export { Job, type JobState } from "./job.js";
export { JobCancelled, Problem, type ProblemDetails } from "./problems.js";
export { Program, type Happening, type Revision } from "./program.js";
export type {
  Document,
  Edit,
  Format,
  Layout,
  ProgramDocument,
  RenderOptions,
  StoredRenderOptions,
} from "./types.js";
export type { components, operations, paths } from "./schema.js";
