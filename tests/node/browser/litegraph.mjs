// Drives litegraph.js, which draws on a canvas, and looks at what Tubeloom makes of it.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { becomes, heard, launch, open, seen, difference, shown, SERVICE } from "./browser.mjs";

let browser;
let page;

before(async () => {
  browser = await launch();
  page = await open(browser, "/litegraph", { viewport: { width: 1280, height: 800 } });
  await shown(page);
});

after(() => browser?.close());

async function program() {
  const id = await page.locator("tube-viewer").getAttribute("stored");
  return (await fetch(`${SERVICE}/v1/programs/${id}`)).json();
}

/** A place on the canvas, as litegraph.js counts. */
async function at(x, y) {
  const box = await page.locator("#graph").boundingBox();
  return [box.x + x, box.y + y];
}

async function drag(from, to) {
  await page.mouse.move(...(await at(...from)));
  await page.mouse.down();
  await page.mouse.move(...(await at(...to)), { steps: 8 });
  await page.mouse.up();
}

test("an output with all its inputs is one hyperedge", async () => {
  const { items, hyperedges } = await program();
  assert.equal(items.length, 5);
  assert.deepEqual(hyperedges.map(({ attachments }) => attachments.length), [3, 3]);
});

test("a connection that is drawn is seen in three dimensions", async () => {
  const before = await seen(page);
  await page.getByRole("button", { name: "Add gauge" }).click();
  await heard(page, "load", "({ items, isPart }) => items === 6 && isPart");
  const id = (await program()).items.at(-1).position;
  const [x, y] = [id[0] * 60 - 75, -id[1] * 60 - 25];
  // From the mixer's output to the new gauge's input.
  await drag([280 + 141, 150 + 14], [x + 10, y + 14]);
  await heard(page, "load", "({ hyperedges, isPart }) => hyperedges === 3 && isPart");
  assert.ok(difference(before, await seen(page)) > 0.002);
});

test("a node that is dragged moves there, and nothing else does", async () => {
  const before = await program();
  const revision = (await heard(page, "load")).revision;
  await drag([40 + 80, 60 - 15], [40 + 80, 60 - 15 + 40]);
  await heard(page, "load", `({ revision }) => revision > ${revision}`);
  const moved = async () => {
    const { items } = await program();
    return items.filter((item, number) => JSON.stringify(item) !== JSON.stringify(before.items[number])).map(({ id }) => id);
  };
  await becomes(moved, [before.items[0].id]);
  assert.deepEqual(page.troubles, []);
});
