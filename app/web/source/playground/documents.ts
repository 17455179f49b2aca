import { AS_JSON, service } from "./service.ts";

/** Makes a program of what was opened, recognised by its contents. Throws what the service says. */
export async function open(contents: string): Promise<string> {
  const format = formatOf(contents);
  if (format === undefined && contents.trimStart().startsWith("{")) return contents;
  const response = await service.ask(`/v1/convert?from=${format ?? "tubeloom"}&to=tubeloom`, {
    method: "POST",
    body: contents,
    headers: AS_JSON,
  });
  return tidy((await response.json()) as Record<string, unknown>);
}

function formatOf(contents: string): "yosys" | "hif" | undefined {
  try {
    const document = JSON.parse(contents) as object | null;
    if (typeof document !== "object" || document === null || "items" in document) return undefined;
    if ("modules" in document) return "yosys";
    return "incidences" in document ? "hif" : undefined;
  } catch {
    return undefined;
  }
}

/** A document as people write it: an item or a hyperedge to a line. */
export function tidy(document: Record<string, unknown>): string {
  const parts = Object.entries(document).map(([name, value]) => {
    const isLong = Array.isArray(value) && value.length > 0 && typeof value[0] === "object";
    const written = isLong ? `[\n  ${value.map(line).join(",\n  ")}\n ]` : line(value);
    return ` ${JSON.stringify(name)}: ${written}`;
  });
  return `{\n${parts.join(",\n")}\n}\n`;
}

/** A value on one line, with spaces where people put them. */
export function line(value: unknown): string {
  return spaced(JSON.stringify(value, (_name, inner: unknown) => (typeof inner === "number" ? round(inner) : inner)));
}

/** Sums of decimal fractions end in digits that nobody has written. */
function round(value: number): number {
  return Number(value.toPrecision(12));
}

/** JSON without line breaks, with a space after each comma and colon. */
export function spaced(json: string): string {
  return json.replace(/("(?:[^"\\]|\\.)*")|([,:])\s*/g, (_all, text?: string, mark?: string) => text ?? `${mark} `);
}
