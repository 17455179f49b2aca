// Tries the link between an editor and the service, by node's own test runner.
import { Client, type ProgramDocument } from "tubeloom-client";
import { Link, type LinkState } from "./link.js";
import { deepEqual, environment, equal, ok, test } from "./trying.js";

const tubeloom = new Client(environment("TUBELOOM_URL"), { patience: 0 });

function at(x: number, label = "A"): ProgramDocument {
  return { items: [{ id: "a", label, position: [x, 0, 0.25] }, { id: "b", position: [9, 9, 0.25] }] };
}

/** A link, what it has told, and ways to wait for it. */
function linked(name: string) {
  const states: LinkState[] = [];
  const programs: ProgramDocument[] = [];
  const link = new Link(tubeloom, name, {
    state: (state) => states.push(state),
    program: (program) => programs.push(program),
  });
  const until = async (holds: () => boolean) => {
    for (let tries = 0; !holds(); tries += 1) {
      ok(tries < 2000, `It does not come: ${JSON.stringify(link.state)}`);
      await new Promise((resolve) => setTimeout(resolve, 10));
    }
  };
  const saved = () => until(() => link.state.status === "saved");
  return { link, states, programs, until, saved };
}

async function placeOf(name: string): Promise<number | undefined> {
  return (await tubeloom.program(name).get()).items[0]?.position?.[0];
}

test("a new program is put, and what comes meanwhile is sent together", async () => {
  const { link, saved } = linked("coalesced");
  await link.open(at(0), true);
  for (let x = 1; x <= 50; x += 1) link.send(at(x));
  await saved();
  equal(await placeOf("coalesced"), 50);
  equal(link.state.revision, 3, "the first change, and the other 49 as one");
  link.close();
});

test("what is done in one gesture is undone at once, and redone", async () => {
  const { link, programs, saved, until } = linked("gesture");
  await link.open(at(0), true);
  link.send(at(1));
  await saved();
  link.beginGesture();
  for (let x = 2; x <= 6; x += 1) {
    link.send(at(x));
    await saved();
  }
  link.endGesture();
  link.send(at(7));
  await saved();
  equal(link.state.revision, 8);
  link.undo();
  link.undo();
  await until(() => programs.length === 2);
  equal(link.state.revision, 10, "each step back is one request, however long the gesture was");
  equal(programs[1]?.items[0]?.position?.[0], 1);
  equal(await placeOf("gesture"), 1);
  link.redo();
  await until(() => programs.length === 3);
  equal(await placeOf("gesture"), 6);
  ok(link.state.canRedo && link.state.canUndo);
  link.close();
});

test("a program that exists is opened, and what others do is heard", async () => {
  await tubeloom.program("shared").put(at(5));
  const { link, programs, until } = linked("shared");
  await link.open(at(0));
  equal(programs[0]?.items[0]?.position?.[0], 5);
  await tubeloom.program("shared").edit({ type: "set_item", id: "b", fields: { label: "Theirs" } });
  await until(() => programs.at(-1)?.items[1]?.label === "Theirs");
  link.close();
});

test("changes of two at the same time are both done", async () => {
  const { link, programs, saved, until } = linked("both");
  await link.open(at(0), true);
  const theirs = tubeloom.program("both").edit({ type: "set_item", id: "b", fields: { label: "Theirs" } });
  link.send(at(3));
  await theirs;
  await saved();
  await until(() => programs.at(-1)?.items[1]?.label === "Theirs");
  const [a, b] = (await tubeloom.program("both").get()).items;
  deepEqual([a?.position?.[0], b?.label], [3, "Theirs"]);
  link.close();
});

test("where both cannot be done, theirs stays, and that is told", async () => {
  const { link, programs, until } = linked("against");
  await link.open(at(0), true);
  link.close();
  const late = linked("against");
  await late.link.open(at(0));
  const gone = tubeloom.program("against").edit({ type: "remove_item", id: "a" });
  late.link.send(at(4));
  await gone;
  await late.until(() => late.programs.at(-1)?.items.length === 1);
  equal((await tubeloom.program("against").get()).items.length, 1);
  equal(programs.length, 0, "a link that is closed tells nothing");
  await until(() => true);
  late.link.close();
});

test("what the service refuses is told, and the next change is sent", async () => {
  const { link, saved, until } = linked("refused");
  await link.open(at(0), true);
  link.send({ items: [{ id: "a", color: "no colour" }] });
  await until(() => link.state.status === "refused");
  ok(link.state.detail.length > 10);
  link.send(at(8));
  await saved();
  equal(await placeOf("refused"), 8);
  link.close();
});
