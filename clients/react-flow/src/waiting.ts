import { Problem } from "tubeloom-client";

/** Whether there was no answer, or none for now. */
export function isLost(error: unknown): boolean {
  if (error instanceof Problem) return error.status >= 500 || error.status === 429;
  return error instanceof TypeError || error instanceof DOMException;
}

/** Once some time has passed. */
export function wait(milliseconds: number): Promise<void> {
  return new Promise((resolve) => setTimeout(resolve, milliseconds));
}
