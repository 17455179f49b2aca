/// <reference types="vite/client" />
import FIRST from "../../../../examples/id3-clause-2.json?raw";

const PROGRAMS = import.meta.glob<string>("../../../../examples/*.json", { query: "?url", import: "default", eager: true });
const OTHERS = import.meta.glob<string>(["../../../../examples/yosys/*.json", "../../../../examples/hif/*.json"], {
  query: "?url",
  import: "default",
  eager: true,
});

const TITLES: Record<string, string> = {
  "id3-clause-2": "ID3, clause 2",
  "id3-clause-1": "ID3, clause 1",
  "id3-clause-2-materials": "ID3, clause 2, in materials",
  hello: "Hello, hyperedge",
  shapes: "Shapes",
  csg: "Bodies made of bodies",
  helix: "Helix",
  "paper-curves": "The paper's curves",
  unicode: "Scripts of the world",
  "yosys/hyperedges": "Yosys: three nets",
  "yosys/mux4": "Yosys: multiplexer",
  "yosys/up3down5": "Yosys: counter",
  "hif/lesmis": "HIF: Les Misérables",
  "hif/e-coli": "HIF: E. coli",
};

/** What the page shows where nothing else is asked for. */
export const DEFAULT_EXAMPLE = "id3-clause-2";

/** An example: its name in links, what to call it, and where it lies. */
export interface Example {
  name: string;
  title: string;
  url: string;
}

export const EXAMPLES: readonly Example[] = Object.entries({ ...PROGRAMS, ...OTHERS })
  .map(([path, url]) => {
    const name = path.replace(/^.*\/examples\//, "").replace(/\.json$/, "");
    return { name, title: TITLES[name] ?? name, url };
  })
  .sort((one, other) => rank(one.name) - rank(other.name) || one.name.localeCompare(other.name));

/** The contents of an example, in whatever format it has. */
export async function contentsOf({ name, url }: Example): Promise<string> {
  // What most people see first comes with the page.
  if (name === DEFAULT_EXAMPLE) return FIRST;
  const response = await fetch(url);
  if (!response.ok) throw new Error("This example is not there.");
  return response.text();
}

function rank(name: string): number {
  const place = Object.keys(TITLES).indexOf(name);
  return place < 0 ? Infinity : place;
}
