import type { GLTF } from "three/addons/loaders/GLTFLoader.js";
import type { Layout } from "tubeloom-client";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

/** What the service says is wrong with a question, as RFC 9457 has it. */
export interface ProblemDetails {
  type: string;
  title: string;
  status: number;
  detail?: string;
  errors?: { pointer: string; detail: string }[];
}

/** The service has answered that it cannot. */
export class Refusal extends Error {
  readonly problem: ProblemDetails;

  constructor(problem: ProblemDetails) {
    super(problem.detail ?? problem.title);
    this.problem = problem;
  }

  /** Whether to ask again would be of no use. */
  get isFinal(): boolean {
    return this.problem.status < 500 && this.problem.status !== 429;
  }
}

/** How large a picture the tubes are made for, in pixels: it decides how fine they are. */
export interface Detail {
  width: number;
  height: number;
}

/** A scene, and what the service says beside it. */
export interface Loaded {
  gltf: GLTF;
  bytes: number;
  /** Of a stored program. */
  revision: number | undefined;
  /** The first draw of what was asked is this many milliseconds old. */
  asked: number;
}

/** Asks the service, with a key if there is one. */
export class Asker {
  base: string;
  key: string | undefined;

  constructor(base: string) {
    this.base = base;
  }

  /** The scene of a document, given as text. */
  render(document: string, detail: Detail, signal: AbortSignal): Promise<Loaded> {
    const init = { method: "POST", body: document, headers: { "Content-Type": "application/json" } };
    return this.scene(`${this.base}/v1/render?format=glb&${queryOf(detail)}`, signal, init);
  }

  /** The scene of a stored program; with `since`, only what has changed after that revision. */
  stored(id: string, detail: Detail, since: number | undefined, signal: AbortSignal): Promise<Loaded> {
    const part = since === undefined ? "" : `&since=${since}`;
    const path = `/v1/programs/${encodeURIComponent(id)}/render?format=glb&${queryOf(detail)}${part}`;
    return this.scene(this.base + path, signal);
  }

  /** A scene at any address. Throws `Refusal`; `TypeError` where nobody answers. */
  async scene(url: string, signal: AbortSignal, init: RequestInit = {}): Promise<Loaded> {
    const asked = performance.now();
    const response = await this.ask(url, { ...init, signal });
    const revision = response.headers.get("tubeloom-revision");
    const data = await response.arrayBuffer();
    const gltf = await parse(data);
    signal.throwIfAborted();
    return {
      gltf,
      bytes: data.byteLength,
      revision: revision === null ? undefined : Number(revision),
      asked,
    };
  }

  /** The numbers of a layout, for what they say of clearance. */
  async layout(init: { document: string } | { stored: string }, signal: AbortSignal): Promise<Layout> {
    const response =
      "stored" in init
        ? await this.ask(`${this.base}/v1/programs/${encodeURIComponent(init.stored)}/layout`, { signal })
        : await this.ask(`${this.base}/v1/layout`, {
            method: "POST",
            body: init.document,
            headers: { "Content-Type": "application/json" },
            signal,
          });
    return (await response.json()) as Layout;
  }

  async ask(url: string, init: RequestInit): Promise<Response> {
    const isOurs = new URL(url, location.href).href.startsWith(new URL(this.base, location.href).href);
    const authorization: Record<string, string> =
      this.key !== undefined && isOurs ? { Authorization: `Bearer ${this.key}` } : {};
    const headers = { ...authorization, ...(init.headers as Record<string, string> | undefined) };
    const response = await fetch(url, { ...init, headers });
    if (response.ok) return response;
    throw new Refusal(await problemOf(response));
  }
}

function queryOf({ width, height }: Detail): string {
  return `width=${width}&height=${height}`;
}

async function problemOf(response: Response): Promise<ProblemDetails> {
  const plain = { type: "about:blank", title: response.statusText, status: response.status };
  try {
    return { ...plain, ...((await response.json()) as Partial<ProblemDetails>) };
  } catch {
    return plain;
  }
}

/** Reads a GLB file; one that is compressed needs a decoder, which others do without. */
export async function parse(data: ArrayBuffer): Promise<GLTF> {
  const loader = new GLTFLoader();
  if (isCompressed(data)) {
    const { MeshoptDecoder } = await import("three/addons/libs/meshopt_decoder.module.js");
    loader.setMeshoptDecoder(MeshoptDecoder);
  }
  return loader.parseAsync(data, "");
}

/** Whether the file's head, which is short beside the rest, speaks of compression. */
function isCompressed(data: ArrayBuffer): boolean {
  if (data.byteLength < 20) return false;
  const length = Math.min(new DataView(data).getUint32(12, true), data.byteLength - 20);
  const head = new TextDecoder().decode(new Uint8Array(data, 20, length));
  return head.includes("EXT_meshopt_compression");
}
