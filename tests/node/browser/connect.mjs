// Follows the page "Connect your editor": its page, served from an origin of its own.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { difference, heard, launch, seen, shown, until } from "./browser.mjs";

let browser;
let page;

before(async () => {
  browser = await launch();
  page = await (await browser.newContext({ viewport: { width: 700, height: 600 } })).newPage();
  page.troubles = [];
  page.on("pageerror", (error) => page.troubles.push(error.message));
  await page.addInitScript(() => {
    window.heard = [];
    for (const name of ["load", "select"]) {
      addEventListener(`tube-${name}`, ({ detail }) => window.heard.push({ name, ...detail }));
    }
  });
  await page.goto(process.env.EDITOR_URL);
});

after(() => browser?.close());

test("the program is put and shown", async () => {
  await shown(page);
  const load = await heard(page, "load");
  assert.deepEqual([load.items, load.hyperedges, load.revision], [3, 1, 1]);
});

test("an edit is sent, and only what it concerns is loaded", async () => {
  const before = await seen(page);
  await page.getByRole("button", { name: "Join the moon too" }).click();
  const load = await heard(page, "load", "({ revision }) => revision === 2");
  assert.equal(load.isPart, true);
  assert.ok(difference(before, await seen(page)) > 0.005);
  assert.equal(await page.getByRole("status").first().innerText(), "Revision 2");
});

test("an item moves as the slider does", async () => {
  await page.getByRole("slider", { name: "Earth" }).focus();
  await page.keyboard.press("ArrowRight");
  await heard(page, "load", "({ revision, isPart }) => revision === 3 && isPart");
});

test("what is selected in the picture is told to the page", async () => {
  await page.locator("tube-viewer").evaluate((viewer) => viewer.shadowRoot.querySelector("#list").focus());
  await page.keyboard.press("ArrowDown");
  await page.keyboard.press("Enter");
  await until(async () => (await page.locator("p#status").innerText()).startsWith("Selected: "));
  assert.deepEqual(page.troubles, []);
});
