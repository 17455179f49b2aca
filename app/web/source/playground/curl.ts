/**
 * The command line that asks for what one sees: a query, and the document within it. Where a key is
 * wanted it is taken from the environment, for command lines are passed around.
 */
export function curlOf(origin: string, query: string, file: string, document: string, isKeyed: boolean): string {
  let end = "PROGRAM";
  while (document.split("\n").includes(end)) end += "_";
  const text = document.endsWith("\n") ? document : `${document}\n`;
  return [
    `curl --fail-with-body --output ${quoted(file)} \\`,
    ...(isKeyed ? [`  --header "Authorization: Bearer $TUBELOOM_KEY" \\`] : []),
    `  --header 'Content-Type: application/json' --data-binary @- \\`,
    `  ${quoted(`${origin}/v1/render?${query}`)} <<'${end}'`,
    `${text}${end}\n`,
  ].join("\n");
}

function quoted(text: string): string {
  return `'${text.replaceAll("'", "'\\''")}'`;
}

/** A file's name for a program of this name. */
export function fileOf(name: unknown, ending: string): string {
  const plain = typeof name === "string" ? name.normalize("NFKD").replace(/[^\p{L}\p{N}]+/gu, "-").toLowerCase() : "";
  return `${plain.replace(/^-+|-+$/g, "").slice(0, 60) || "program"}.${ending}`;
}

/** Puts a text on the clipboard, also where the page is not on a secure connection. */
export async function copy(text: string): Promise<void> {
  if (isSecureContext) {
    await navigator.clipboard.writeText(text);
    return;
  }
  const held = document.createElement("textarea");
  held.value = text;
  held.className = "unseen";
  document.body.append(held);
  held.select();
  const isCopied = document.execCommand("copy");
  held.remove();
  if (!isCopied) throw new Error("The browser does not let this page use the clipboard.");
}
