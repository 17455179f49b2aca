// The viewer element, as somebody uses it.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { after, before, test } from "node:test";
import { PNG } from "pngjs";
import { difference, drawn, edit, heard, launch, open, pixel, pixels, seen, shown, store, until } from "./browser.mjs";

const PROGRAM = {
  name: "Red and blue",
  items: ["a", "b", "c", "d", "e"].map((id, place) => ({
    id,
    label: id.toUpperCase(),
    color: "#d0d0d0",
    position: [2 * (place % 3) - 2, place < 3 ? 1 : -1, 0.3],
  })),
  hyperedges: [
    { id: "red", label: "R", color: "#e00000", attachments: [{ item: "a" }, { item: "c" }, { item: "d" }] },
    { id: "blue", label: "B", color: "#0020e0", attachments: [{ item: "b" }, { item: "e" }] },
  ],
};

const isRed = (red, green, blue) => red > 90 && green < 0.25 * red && blue < 0.25 * red;
const isBlue = (red, green, blue) => blue > 90 && red < 0.3 * blue && green < 0.45 * blue;

let browser;
before(async () => {
  browser = await launch();
  await store("red-and-blue", PROGRAM);
});
after(() => browser.close());

async function viewer(query = "", options = {}) {
  const page = await open(browser, `/viewer?stored=red-and-blue&theme=light${query}`, options);
  await shown(page);
  return page;
}

/** The pixel in the middle of those of a colour, in the order in which they are read. */
async function middle(page, suits) {
  const found = pixels(await seen(page), suits);
  assert.ok(found.length > 30, `${found.length} pixels of that colour`);
  return found[Math.floor(found.length / 2)];
}

test("a stored program is shown, and nothing is wrong on the page", async () => {
  const page = await viewer();
  const { items, hyperedges, calls } = await heard(page, "load");
  assert.deepEqual([items, hyperedges], [5, 2]);
  assert.ok(calls < 20);
  const picture = await seen(page);
  assert.ok(pixels(picture, isRed).length > 300);
  assert.ok(pixels(picture, isBlue).length > 150);
  const drawnOn = pixels(picture, (red, green, blue) => red + green + blue < 740).length;
  const share = drawnOn / (picture.width * picture.height);
  assert.ok(share > 0.1 && share < 0.9, `a share of ${share} is drawn on`);
  assert.deepEqual(page.troubles, []);
  await page.close();
});

test("a drag turns the picture, the wheel goes nearer, a double click shows all again", async () => {
  const page = await viewer();
  const first = await seen(page);
  await page.mouse.move(100, 400);
  await page.mouse.down();
  await page.mouse.move(220, 380, { steps: 3 });
  await page.mouse.up();
  const turned = await seen(page);
  assert.ok(difference(first, turned) > 0.03);
  assert.equal(await page.evaluate(() => window.heard.some(({ name }) => name === "select")), false);
  await page.mouse.wheel(0, -400);
  const nearer = await seen(page);
  assert.ok(pixels(nearer, isRed).length > 1.2 * pixels(turned, isRed).length);
  await page.mouse.dblclick(20, 480);
  assert.ok(pixels(await seen(page), isRed).length < 0.9 * pixels(nearer, isRed).length);
  await page.close();
});

test("what the pointer is on lights up and is told, with its members", async () => {
  const page = await viewer();
  const [x, y] = await middle(page, isRed);
  const brightness = (picture) => {
    const found = pixels(picture, isRed).map(([x, y]) => pixel(picture, x, y)[0]);
    return found.reduce((sum, red) => sum + red, 0) / found.length;
  };
  const before = brightness(await seen(page));
  await page.mouse.move(x, y);
  const { thing } = await heard(page, "hover", "({ thing }) => thing");
  assert.deepEqual([thing.shows, thing.id, thing.label], ["hyperedge", "red", "R"]);
  assert.deepEqual(thing.attachments.map(({ item }) => item), ["a", "c", "d"]);
  assert.ok(brightness(await seen(page)) > before + 15);
  await page.mouse.move(3, 480);
  await heard(page, "hover", "({ thing }) => !thing");
  await page.close();
});

test("a click selects; all else is dimmed, or hidden where that is wished", async () => {
  const page = await viewer();
  const [x, y] = await middle(page, isRed);
  await page.mouse.click(x, y);
  const { things } = await heard(page, "select");
  assert.deepEqual(things.map(({ id }) => id), ["red"]);
  await page.mouse.move(3, 480);
  const dimmed = await seen(page);
  assert.ok(pixels(dimmed, isRed).length > 300);
  assert.equal(pixels(dimmed, isBlue).length, 0);
  // Below the toolbar, which is blue too.
  const bluish = (picture) => pixels(picture, (red, green, blue) => blue > red + 14 && blue > green + 7).filter(([, y]) => y > 60);
  const ghost = bluish(dimmed).length;
  assert.ok(ghost > 100, `${ghost} pixels are left of the blue tube`);
  await page.getByRole("button", { name: "Hide what is not selected (H)" }).click();
  await page.mouse.move(3, 480);
  assert.ok(bluish(await seen(page)).length < 0.2 * ghost);
  await page.mouse.click(10, 480);
  await heard(page, "select", "({ things }) => things.length === 0");
  assert.ok(pixels(await seen(page), isBlue).length > 150);
  await page.close();
});

test("everything can be done by the keyboard", async () => {
  const page = await viewer();
  const first = await seen(page);
  await page.keyboard.press("Tab");
  await page.keyboard.press("ArrowLeft");
  await page.keyboard.press("+");
  assert.ok(difference(first, await seen(page)) > 0.03);
  await page.keyboard.press("1");
  await page.mouse.move(0, 0);
  for (let presses = 0; presses < 12; presses += 1) {
    await page.keyboard.press("Tab");
    const role = await page.evaluate(() => document.activeElement.shadowRoot?.activeElement?.getAttribute("role"));
    if (role === "listbox") break;
  }
  const spoken = () => page.locator("tube-viewer #option").textContent();
  assert.equal(await spoken(), "Hyperedge R, joins A, C and D");
  await page.keyboard.press("ArrowDown");
  assert.equal(await spoken(), "Hyperedge B, joins B and E");
  await page.keyboard.press("Enter");
  assert.deepEqual((await heard(page, "select")).things.map(({ id }) => id), ["blue"]);
  const picture = await seen(page);
  assert.equal(pixels(picture, isRed).length, 0);
  assert.ok(pixels(picture, isBlue).length > 150);
  await page.keyboard.press("d");
  assert.match(await spoken(), /^Item D/);
  await page.keyboard.press("Escape");
  assert.ok(pixels(await seen(page), isRed).length > 300);
  await page.close();
});

test("whoever wants no motion gets none; others get what they ask for", async () => {
  const frames = (page) => page.evaluate(() => window.heard.filter(({ name }) => name === "frame").length);
  const still = await viewer("&motion=turntable");
  const first = await seen(still);
  // As many pictures as others have moved visibly by, however long the machine takes for them.
  await still.evaluate(async () => {
    for (let count = 0; count < 40; count += 1) await new Promise(requestAnimationFrame);
  });
  assert.equal(difference(first, await seen(still)), 0);
  await still.close();
  const moving = await viewer("&motion=turntable", { reducedMotion: "no-preference" });
  const [before, count] = [await seen(moving), await frames(moving)];
  await until(async () => (await frames(moving)) > count + 4);
  assert.ok(difference(before, await seen(moving)) > 0.02);
  await moving.close();
});

test("the picture can be saved", async () => {
  const page = await viewer();
  const [download] = await Promise.all([
    page.waitForEvent("download"),
    page.getByRole("button", { name: "Save the picture" }).click(),
  ]);
  assert.equal(download.suggestedFilename(), "Red and blue.png");
  const saved = PNG.sync.read(await readFile(await download.path()));
  assert.deepEqual([saved.width, saved.height], [1400, 1000]);
  assert.ok(pixels(saved, isRed).length > 1200);
  assert.deepEqual(pixel(saved, 2, 2), [255, 255, 255]);
  await page.close();
});

test("edits show at once, and nothing else moves", async () => {
  const page = await viewer();
  const first = await seen(page);
  const began = (await heard(page, "load")).revision;
  await edit("red-and-blue", { type: "remove_hyperedge", id: "red" });
  const { isPart } = await heard(page, "load", `({ revision }) => revision > ${began}`);
  assert.equal(isPart, true);
  const without = await seen(page);
  assert.equal(pixels(without, isRed).length, 0);
  assert.ok(pixels(first, isBlue).every(([x, y]) => isBlue(...pixel(without, x, y))));
  const revision = await page.evaluate(() => window.heard.findLast(({ name }) => name === "load").revision);
  await fetch(`${process.env.TUBELOOM_URL}/v1/programs/red-and-blue/undo`, { method: "POST" });
  await heard(page, "load", `({ revision }) => revision > ${revision}`);
  const moved = difference(first, await seen(page));
  assert.ok(moved < 0.001, `a share of ${moved} has changed`);
  await page.close();
});

test("both eyes get a picture", async () => {
  const page = await viewer("&stereo=parallel");
  const picture = await seen(page);
  const found = pixels(picture, isRed);
  const left = found.filter(([x]) => x < picture.width / 2).length;
  assert.ok(left > 0.35 * found.length && left < 0.65 * found.length);
  await page.close();
});

test("the dark theme is dark", async () => {
  const page = await open(browser, "/viewer?stored=red-and-blue", { colorScheme: "dark" });
  await shown(page);
  assert.deepEqual(pixel(await seen(page), 3, 3), [18, 23, 31]);
  await page.close();
});

test("a program that is not there is said to be so", async () => {
  const page = await open(browser, "/viewer?stored=nobody");
  const { status, detail } = await heard(page, "status", "({ status }) => status === 'refused'");
  assert.equal(status, "refused");
  assert.equal(await page.locator("tube-viewer").getByRole("status").textContent(), detail);
  await page.close();
});

/** Two equal boxes, the red one near and the blue one far, and no tube. */
const NEAR_AND_FAR = {
  items: [
    { id: "near", color: "#e00000", position: [-1.5, -4, 0.5] },
    { id: "far", color: "#0020e0", position: [1.5, 4, 0.5] },
  ].map((item) => ({ ...item, shape: { type: "box", size: [1, 1, 1] } })),
  hyperedges: [],
};

/** The least and the greatest x of these pixels. */
const sidesOf = (found) => found.reduce(([least, most], [x]) => [Math.min(least, x), Math.max(most, x)], [Infinity, -Infinity]);

const widthOf = (found) => sidesOf(found)[1] - sidesOf(found)[0];

/** How wide the near and the far box are, in pixels. */
async function widths(page) {
  const picture = await seen(page);
  return [isRed, isBlue].map((suits) => widthOf(pixels(picture, suits).filter(([, y]) => y > 60)));
}

test("what is far is as large as what is near where the program wants it so", async () => {
  const view = { from: [0, -1, 0.4] };
  await store("perspective", { ...NEAR_AND_FAR, view });
  await store("parallel", { ...NEAR_AND_FAR, view: { ...view, projection: "orthographic" } });
  const show = async (id, more = "") => {
    const page = await open(browser, `/viewer?stored=${id}&theme=light&labels=never${more}`);
    await shown(page);
    return page;
  };
  const usual = await show("perspective");
  const [near, far] = await widths(usual);
  assert.ok(near > 1.2 * far, `${near} and ${far} pixels wide`);
  await usual.close();
  const page = await show("parallel");
  const [one, other] = await widths(page);
  assert.ok(one > 40 && Math.abs(one - other) <= 2, `${one} and ${other} pixels wide`);
  await page.mouse.move(350, 300);
  await page.mouse.wheel(0, -300);
  const [larger, equal] = await widths(page);
  assert.ok(larger > 1.15 * one && Math.abs(larger - equal) <= 2, `${larger} and ${equal} pixels wide`);
  await page.keyboard.press("Tab");
  await page.keyboard.press("f");
  assert.ok(Math.abs((await widths(page))[0] - one) <= 2);
  const [x, y] = await middle(page, (red, green, blue) => isBlue(red, green, blue) && red < 100);
  await page.mouse.click(x, y);
  await heard(page, "select", "({ things }) => things[0]?.id === 'far'");
  await page.close();
});

test("where tubes touch there are marks", async () => {
  const corners = [[-2, -2], [2, 2], [-2, 2], [2, -2]];
  await store("crossing", {
    layout: { dimensions: 2 },
    items: corners.map(([x, y], place) => ({ id: `i${place}`, color: "#d0d0d0", position: [x, y, 0.3] })),
    hyperedges: [
      { id: "up", color: "#202020", attachments: [{ item: "i0" }, { item: "i1" }] },
      { id: "down", color: "#202020", attachments: [{ item: "i2" }, { item: "i3" }] },
    ],
  });
  const isMark = (red, green, blue) => red > 200 && green < 60 && blue > 40 && blue < 110;
  const page = await open(browser, "/viewer?stored=crossing&theme=light");
  await shown(page);
  const { clearance } = await heard(page, "clearance");
  assert.ok(clearance.conflicts.length > 0);
  assert.deepEqual([clearance.certified, clearance.conflicts[0].hyperedges.toSorted()], [false, ["down", "up"]]);
  const marks = pixels(await seen(page), isMark);
  assert.ok(marks.length > 40, `${marks.length} pixels of marks`);
  const [left, right] = sidesOf(marks);
  const [top, bottom] = sidesOf(marks.map(([x, y]) => [y, x]));
  assert.ok(Math.abs(right - left - (bottom - top)) < 3, "a ring faces whoever looks");
  assert.ok(Math.abs((left + right) / 2 - 350) < 30, `marks from ${left} to ${right}`);
  await page.evaluate(() => document.querySelector("tube-viewer").removeAttribute("conflicts"));
  assert.equal(pixels(await seen(page), isMark).length, 0);
  await page.close();
});

test("nothing is hidden by the toolbar", async () => {
  for (const [width, height] of [[700, 500], [1280, 800], [390, 844], [900, 300]]) {
    const page = await viewer("&labels=never", { viewport: { width, height } });
    await page.evaluate(() => {
      const [viewer] = document.querySelectorAll("tube-viewer");
      viewer.program = { view: { from: [0, 0, 1] }, items: [{ id: "a", color: "#e00000", shape: { type: "box", size: [40, 20, 1] } }] };
      viewer.removeAttribute("stored");
    });
    await heard(page, "load", "({ items }) => items === 1");
    const bar = await page.getByRole("toolbar").boundingBox();
    const picture = await seen(page);
    const red = pixels(picture, isRed);
    const hidden = red.filter(([x, y]) => x > bar.x && y < bar.y + bar.height);
    assert.ok(red.length > 5000 && hidden.length === 0, `${width} × ${height}: ${hidden.length} of ${red.length} are hidden`);
    const [left, right] = sidesOf(red);
    assert.ok(left > 0 && right < width - 1);
    await page.close();
  }
});
