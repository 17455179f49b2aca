import { heedKey } from "../key.ts";
import { Asker, Refusal } from "../viewer/loading.ts";

/** The service that this page comes from. */
export const service = new Asker(location.origin);

heedKey((key) => (service.key = key));

export const AS_JSON = { "Content-Type": "application/json" };

/** What went wrong with a question, in a sentence; nothing if it was called off. */
export function troubleOf(error: unknown): string | undefined {
  if (error instanceof DOMException && error.name === "AbortError") return undefined;
  if (error instanceof Refusal) return error.message;
  if (error instanceof TypeError) return "The service does not answer.";
  return error instanceof Error ? error.message : String(error);
}

/** What the service lists at a path, asked once. */
export function listed<Entry>(path: string): () => Promise<Entry> {
  let answer: Promise<Entry> | undefined;
  return () => {
    answer ??= service.ask(path, {}).then((response) => response.json() as Promise<Entry>);
    answer.catch(() => (answer = undefined));
    return answer;
  };
}

export const palettes = listed<{ name: string; title: string }[]>("/v1/palettes");
export const notations =
  listed<{ name: string; title: string; items?: object; hyperedges?: object }[]>("/v1/notations");
export const formats = listed<{
  documents: { name: string; title: string; media_type: string; writes: boolean }[];
  scenes: { name: string; title: string; media_type: string }[];
}>("/v1/formats");
