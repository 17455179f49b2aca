// Every page, as one finds it: nothing is wrong with it, and those who hear or type get along.
import assert from "node:assert/strict";
import { readdir, readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { after, before, test } from "node:test";
import { heard, launch, open, pixels, seen, SERVICE, shown, store } from "./browser.mjs";

const AXE = createRequire(import.meta.url).resolve("axe-core/axe.min.js");
const EXAMPLES = new URL("../../../examples/", import.meta.url);
const PAGES = ["/", "/viewer", "/viewer?stored=looked-at", "/editor", "/litegraph"];

let browser;
before(async () => {
  browser = await launch();
  await store("looked-at", { items: [{ id: "a", label: "A" }, { id: "b" }], hyperedges: [] });
});
after(() => browser.close());

for (const path of PAGES) {
  test(`axe finds nothing serious on ${path}, be it light, dark or narrow`, async () => {
    const page = await open(browser, path, { bypassCSP: true });
    if (path !== "/viewer") await shown(page);
    await page.addScriptTag({ path: AXE });
    await inspect(page);
    await page.emulateMedia({ colorScheme: "dark" });
    await inspect(page);
    await page.setViewportSize({ width: 390, height: 844 });
    await inspect(page);
    assert.deepEqual(page.troubles, []);
    await page.context().close();
  });
}

async function inspect(page) {
  const { violations } = await page.evaluate(() => window.axe.run());
  const serious = violations.filter(({ impact }) => impact === "serious" || impact === "critical");
  const told = serious.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html.slice(0, 120)).join(" | ")}`);
  assert.deepEqual(told, []);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
  assert.ok(wide <= 0, `the page is ${wide} pixels too wide`);
}

test("every example opens in the viewer", async () => {
  const page = await open(browser, "/viewer?stored=looked-at&theme=light");
  await shown(page);
  const names = (await readdir(EXAMPLES)).filter((name) => name.endsWith(".json"));
  assert.ok(names.length > 5);
  for (const name of names) {
    const document = await readFile(new URL(name, EXAMPLES), "utf8");
    const now = await page.evaluate((document) => {
      const viewer = window.document.querySelector("tube-viewer");
      viewer.removeAttribute("stored");
      viewer.program = document;
      return performance.now();
    }, document);
    const { items } = await heard(page, "load", `({ at }) => at > ${now}`);
    assert.equal(items, JSON.parse(document).items.length, name);
    const picture = await seen(page);
    const drawnOn = pixels(picture, (red, green, blue) => red + green + blue < 740).length;
    assert.ok(drawnOn > 0.03 * picture.width * picture.height, `${name}: ${drawnOn} pixels`);
  }
  assert.deepEqual(page.troubles, []);
  await page.context().close();
});

test("a compressed scene opens too", async () => {
  const query = "compress=meshopt&format=glb";
  const page = await open(browser, `/viewer?src=${encodeURIComponent(`${SERVICE}/v1/programs/looked-at/render?${query}`)}`);
  const { items } = await heard(page, "load");
  assert.equal(items, 2);
  assert.deepEqual(page.troubles, []);
  await page.context().close();
});
