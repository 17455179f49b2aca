// Makes the calls that everyone needs, and writes what comes of them as one line of JSON.
import { Client, Problem, type Edit, type Happening, type JobState } from "tubeloom-client";

declare const process: { argv: string[] };

const document = {
  items: [{ id: "x", label: "X" }, { id: "y" }, { id: "z", label: "Z" }],
  hyperedges: [{ id: "e", attachments: [{ item: "x" }, { item: "y" }, { item: "z" }] }],
};

const small = { format: "png", width: 64, height: 48 } as const;

const tubeloom = new Client(process.argv[2]);

async function problemOf(work: Promise<unknown>): Promise<Problem> {
  try {
    await work;
  } catch (error) {
    if (error instanceof Problem) return error;
    throw error;
  }
  throw new Error("There should have been a problem.");
}

async function posted() {
  const picture = await tubeloom.render(document, small);
  const scene = await tubeloom.render(JSON.stringify(document));
  const layout = await tubeloom.layout(document, { patches: true });
  const bad = await problemOf(tubeloom.render({ items: [{ id: "a" }, { id: "a" }] }));
  return {
    picture: picture.slice(1, 4),
    scene: scene.slice(0, 4),
    items: layout.items.map((item) => item.id),
    segments: layout.hyperedges.map((hyperedge) => hyperedge.segments.length),
    bad: [bad.status, bad.kind, bad.details.errors?.map((fault) => fault.pointer)],
  };
}

async function stored() {
  const program = tubeloom.program("typed");
  const missing = await problemOf(program.get());
  const happenings: Happening[] = [];
  const first = await program.create(document);
  const again = await problemOf(tubeloom.program("typed").create(document));
  const watching = (async () => {
    for await (const happening of tubeloom.program("typed").watch({ after: 1 })) {
      happenings.push(happening);
    }
  })();
  const edit: Edit = { type: "add_item", item: { id: "w" } };
  const second = await program.edit(edit);
  const undone = await program.undo();
  const redone = await program.redo();
  const other = tubeloom.program("typed");
  await other.get();
  const patched = await other.patch({ name: "Typed" });
  const late = await problemOf(program.patch([{ op: "add", path: "/name", value: "Late" }]));
  const { name } = await program.get();
  const { items } = await program.layout({ revision: 1 });
  const revisions = await program.revisions();
  const delta = await program.render({ since: 4 });
  await program.delete();
  await watching;
  return {
    missing: missing.status,
    again: again.status,
    late: late.status,
    added: second.changes.items.added,
    digests: [undone.digest === first.digest, redone.digest === second.digest],
    name: [patched.name, name],
    items: items.map((item) => item.id),
    revisions: revisions.map((revision) => revision.revision),
    delta: delta.slice(0, 4),
    happenings: happenings.map(({ kind, revision }) => [kind, revision]),
  };
}

async function jobs() {
  const states: JobState[] = [];
  const final = { ...small, quality: "final", samples: 1 } as const;
  const made = await tubeloom.run(document, final, (state) => states.push(state));
  const known = await tubeloom.job(states[0]?.id ?? "").result();
  const failed = await problemOf(tubeloom.run({ items: [{ id: "a" }, { id: "a" }] }, small));
  const long = { ...final, width: 320, height: 240, samples: 65536 };
  const abort = new AbortController();
  const heard: JobState[] = [];
  const stopped = tubeloom
    .run(document, long, (state) => {
      heard.push(state);
      if (state.state === "running") abort.abort(new Error("enough"));
    }, abort.signal)
    .then(String, (error: unknown) => String(error));
  const reason = await stopped;
  const state = await tubeloom.job(heard[0]?.id ?? "").state();
  return {
    made: made.slice(1, 4),
    same: String(known) === String(made),
    end: [states.at(-1)?.state, states.at(-1)?.share],
    failed: failed.kind,
    stopped: [reason, state.state],
  };
}

const bytes = (_: string, value: unknown) =>
  value instanceof Uint8Array ? new TextDecoder().decode(value) : value;

console.log(JSON.stringify([await posted(), await stored(), await jobs()], bytes));
