import type { components } from "./schema.js";

/** What the service says of what is wrong (RFC 9457). */
export type ProblemDetails = components["schemas"]["Problem"];

/** The service refused, and says why. `status` 412 means that somebody else was quicker. */
export class Problem extends Error {
  override readonly name = "Problem";
  readonly status: number;
  readonly details: ProblemDetails;
  /** Seconds to wait before another try, where the service says so. */
  readonly retryAfter: number | undefined;

  constructor(details: ProblemDetails, retryAfter?: number) {
    super(`${details.status} ${details.title} ${details.detail}`.trim());
    this.status = details.status;
    this.details = details;
    this.retryAfter = retryAfter;
  }

  /** The stable name of the kind of problem, such as `inconsistent-document`. */
  get kind(): string {
    return this.details.type.slice(this.details.type.lastIndexOf(":") + 1);
  }
}

/** The job that was waited for has been cancelled. */
export class JobCancelled extends Error {
  override readonly name = "JobCancelled";
}

/** What a response that is not a success says, even if it comes from something in between. */
export async function problemOf(response: Response): Promise<Problem> {
  const text = await response.text();
  const retryAfter = Number(response.headers.get("retry-after") ?? NaN);
  return new Problem(
    { ...detailsOf(response, text), status: response.status },
    Number.isFinite(retryAfter) ? retryAfter : undefined,
  );
}

function detailsOf(response: Response, text: string): ProblemDetails {
  const isProblem = response.headers.get("content-type")?.startsWith("application/problem+json");
  if (isProblem) return JSON.parse(text) as ProblemDetails;
  return { type: "about:blank", title: response.statusText, status: response.status, detail: "" };
}
