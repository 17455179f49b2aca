// What a viewer shows while its service is away. Told by whoever ends and starts the service: each
// line on the standard input is a step, each line of the output an answer.
import assert from "node:assert/strict";
import { createInterface } from "node:readline";
import { difference, heard, launch, open, seen, shown } from "./browser.mjs";

const browser = await launch();
const pages = {
  stored: await open(browser, "/viewer?stored=kept&theme=light"),
  program: await open(browser, "/viewer?src=/v1/programs/kept/render&theme=light"),
};
const first = {};
for (const [name, page] of Object.entries(pages)) {
  await shown(page);
  first[name] = await seen(page);
}
console.log("shown");

const steps = {
  async away() {
    const page = pages.stored;
    const { detail } = await heard(page, "status", "({ status }) => status === 'offline'");
    assert.match(detail, /does not answer/);
    const note = page.locator("tube-viewer").getByRole("status");
    assert.equal(await note.textContent(), detail);
    assert.ok(await note.isVisible());
    assert.ok(difference(first.stored, await seen(page)) < 0.06, "the last picture is kept");
    const program = pages.program;
    await program.evaluate(() => document.querySelector("tube-viewer").refresh());
    await heard(program, "status", "({ status }) => status === 'offline'");
  },
  async back() {
    for (const page of Object.values(pages)) {
      const { at } = await heard(page, "status", "({ status }) => status === 'offline'");
      await heard(page, "status", `({ status, at }) => status === 'live' && at > ${at}`);
    }
    const note = pages.stored.locator("tube-viewer").getByRole("status");
    assert.ok(!(await note.isVisible()));
    assert.ok(difference(first.stored, await seen(pages.stored)) < 0.001);
  },
  async edited() {
    const { isPart } = await heard(pages.stored, "load", "({ items }) => items === 4");
    assert.equal(isPart, true);
  },
};
for await (const step of createInterface({ input: process.stdin })) {
  await steps[step]();
  console.log(step);
}
await browser.close();
