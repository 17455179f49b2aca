const LARGEST = 16_000_000;

/** What a page's address asks for. */
export type Asked = { example: string } | { program: string } | undefined;

/** The fragment that carries a text. */
export async function fragmentOf(text: string): Promise<string> {
  const packed = await through(new Blob([text]), new CompressionStream("deflate-raw"));
  let letters = "";
  for (const byte of packed) letters += String.fromCharCode(byte);
  return `#program=${btoa(letters).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "")}`;
}

/** What a fragment asks for. Throws where it is damaged. */
export async function read(fragment: string): Promise<Asked> {
  const given = new URLSearchParams(fragment.replace(/^#/, ""));
  const example = given.get("example");
  if (example) return { example };
  const program = given.get("program");
  if (!program) return undefined;
  try {
    const letters = atob(program.replaceAll("-", "+").replaceAll("_", "/"));
    const packed = Uint8Array.from(letters, (letter) => letter.charCodeAt(0));
    const bytes = await through(new Blob([packed]), new DecompressionStream("deflate-raw"));
    return { program: new TextDecoder("utf-8", { fatal: true }).decode(bytes) };
  } catch {
    throw new Error("The link is damaged: it does not carry a whole program.");
  }
}

async function through(blob: Blob, stream: CompressionStream | DecompressionStream): Promise<Uint8Array<ArrayBuffer>> {
  const chunks: Uint8Array<ArrayBuffer>[] = [];
  const reader = blob.stream().pipeThrough(stream).getReader();
  for (let size = 0; ; ) {
    const { done, value } = await reader.read();
    if (done) break;
    size += value.byteLength;
    // A short link can unpack to more than any page bears.
    if (size > LARGEST) throw new Error("The program in the link is too large.");
    chunks.push(value);
  }
  return new Uint8Array(await new Blob(chunks).arrayBuffer());
}
