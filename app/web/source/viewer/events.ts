import type { Clearance } from "./clearance.ts";
import type { ProblemDetails } from "./loading.ts";
import type { Thing } from "./things.ts";

/** How things stand: `offline` keeps the last picture, and comes back by itself. */
export type Status = "empty" | "loading" | "live" | "offline" | "refused" | "deleted";

/** What a page hears of. All events bubble, also out of shadow trees. */
export interface TubeEvents {
  /** A scene, or a part of one, is ready to be drawn. */
  "tube-load": {
    items: number;
    hyperedges: number;
    triangles: number;
    calls: number;
    bytes: number;
    isPart: boolean;
    revision: number | undefined;
    /** From asking the service to being ready. */
    milliseconds: number;
  };
  "tube-hover": { thing: Thing | undefined };
  "tube-select": { things: Thing[] };
  "tube-status": { status: Status; detail: string };
  /** The service has refused a document. */
  "tube-problem": { problem: ProblemDetails };
  "tube-clearance": { clearance: Clearance };
  /** A frame was drawn. */
  "tube-frame": { milliseconds: number };
}
