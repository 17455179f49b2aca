// The editor made of the page's block: a node is dragged, and the picture follows.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { difference, heard, launch, seen, shown, store, until } from "../../node/browser/browser.mjs";

let browser;
let page;

before(async () => {
  await store("my-graph", {
    items: [
      { id: "sun", label: "Sun", position: [3, -2, 0.25], color: "#e3b34f" },
      { id: "earth", label: "Earth", position: [10, -2, 0.25], color: "#8fb8ee" },
      { id: "moon", label: "Moon", position: [10, -5, 0.25] },
    ],
    hyperedges: [{ id: "pull", attachments: [{ item: "sun" }, { item: "earth" }, { item: "moon" }] }],
  });
  browser = await launch();
  page = await (await browser.newContext({ viewport: { width: 700, height: 700 } })).newPage();
  page.troubles = [];
  page.on("pageerror", (error) => page.troubles.push(error.message));
  await page.addInitScript(() => {
    window.heard = [];
    addEventListener("tube-load", ({ detail }) => window.heard.push({ name: "load", ...detail }));
  });
  await page.goto(process.env.EDITOR_URL);
});

after(() => browser?.close());

test("a node that is dragged moves in the picture too", async () => {
  await shown(page);
  await until(async () => (await page.locator(".react-flow__edge").count()) === 3);
  const before = await seen(page);
  const { revision } = await heard(page, "load");
  await page.locator(".react-flow__node", { hasText: "Earth" }).hover();
  await page.mouse.down();
  await page.mouse.move(330, 220, { steps: 4 });
  await page.mouse.up();
  await heard(page, "load", `(load) => load.revision > ${revision} && load.isPart`);
  assert.ok(difference(before, await seen(page)) > 0.005);
  assert.deepEqual(page.troubles, []);
});
