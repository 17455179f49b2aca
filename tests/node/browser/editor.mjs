// Drives the node editor as people do: by mouse, by keyboard, and looks at both pictures.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { after, before, beforeEach, afterEach, test } from "node:test";
import { PNG } from "pngjs";
import { becomes, drawn, edit, heard, launch, open, pixels, seen, shown, store, until, SERVICE } from "./browser.mjs";

let browser;
let page;

before(async () => {
  browser = await launch();
});

after(() => browser?.close());

beforeEach(async () => {
  page = await open(browser, "/editor", { viewport: { width: 1000, height: 640 }, colorScheme: "light" });
  await saved();
  await shown(page);
});

afterEach(async () => {
  assert.deepEqual(page.troubles, []);
  await page.context().close();
});

const node = (id) => page.locator(`.react-flow__node[data-id="${id}"]`);
const handle = (id, name) => node(id).locator(`[data-handleid="${name}"]`);
const button = (name) => page.getByRole("button", { name, exact: true });

/** Once the status line says that all is saved; what was done just now may not be on its way yet. */
async function saved() {
  await page.waitForTimeout(60);
  await page.waitForSelector('[role="status"][data-status="saved"]');
}

/** The program as the service has it. */
async function program() {
  await saved();
  const id = new URL(page.url()).searchParams.get("program");
  return (await fetch(`${SERVICE}/v1/programs/${id}`)).json();
}

/** What each hyperedge joins. */
async function joins() {
  const found = (await program()).hyperedges ?? [];
  return found.map(({ attachments }) => attachments.map(({ item, point }) => `${item}.${point}`).join(" "));
}

async function drag(from, to) {
  const [start, end] = [await middle(from), await middle(to)];
  await page.mouse.move(...start);
  await page.mouse.down();
  await page.mouse.move((start[0] + end[0]) / 2, (start[1] + end[1]) / 2, { steps: 4 });
  await page.mouse.move(...end, { steps: 4 });
  await page.mouse.up();
}

async function middle(part) {
  if (Array.isArray(part)) return part;
  const { x, y, width, height } = await part.boundingBox();
  return [x + width / 2, y + height / 2];
}

/** How many pixels of the picture are as green as the third hyperedge. */
async function green() {
  return pixels(await seen(page), (red, green, blue) => green > 1.5 * red + 20 && green > blue + 15).length;
}

const X = "x.right grandparent.left parent-1.left";
const Y = "parent-1.right parent-2.left";

test("handles are joined by dragging: to a handle, to a dot, to a line, to a node", async () => {
  await becomes(joins, [X, Y]);
  assert.ok((await green()) < 20);
  await drag(handle("ada", "right"), handle("grandparent", "top"));
  await becomes(joins, [X, Y, "ada.right grandparent.top"]);
  await heard(page, "load", "({ hyperedges, isPart }) => hyperedges === 3 && isPart");
  assert.ok((await green()) > 200, "the new hyperedge is seen in three dimensions");
  await drag(handle("y", "left"), node("hyperedge-2"));
  await becomes(async () => (await joins())[1], `${Y} y.left`);
  const line = await page.locator(".react-flow__edge-path").nth(0).evaluate((path) => {
    const { x, y } = path.getPointAtLength(path.getTotalLength() / 2);
    const { a, d, e, f } = path.getScreenCTM();
    return [a * x + e, d * y + f];
  });
  await drag(handle("ada", "left"), line);
  await becomes(async () => (await joins())[0], `${X} ada.left`);
  await drag(handle("y", "right"), node("x").locator(".swatch"));
  await becomes(async () => (await joins())[3], "y.right x.left");
});

test("what is undone is gone from both pictures, and comes back", async () => {
  await drag(handle("ada", "right"), handle("grandparent", "top"));
  await heard(page, "load", "({ hyperedges }) => hyperedges === 3");
  await button("Undo").click();
  await heard(page, "load", "({ hyperedges, revision }) => hyperedges === 2 && revision === 3");
  assert.ok((await green()) < 20);
  assert.equal(await page.locator('[data-id="hyperedge-3"]').count(), 0);
  await page.keyboard.press("Control+Shift+z");
  await heard(page, "load", "({ hyperedges, revision }) => hyperedges === 3 && revision === 4");
  assert.equal(await node("hyperedge-3").count(), 1);
});

test("a drag is followed all the way, stays still elsewhere, and is one change to undo", async () => {
  const before = await program();
  const [x, y] = await middle(node("x").locator("b"));
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let step = 1; step <= 12; step += 1) {
    await page.mouse.move(x + step * 3, y + step * 6);
    await page.waitForTimeout(40);
  }
  // The picture moves before the mouse is let go.
  await heard(page, "load", "({ isPart }) => isPart");
  await page.mouse.up();
  await until(async () => JSON.stringify((await program()).items) !== JSON.stringify(before.items));
  const after = await program();
  const others = ({ items }) => items.filter(({ id }) => id !== "x");
  assert.deepEqual(others(after), others(before));
  await page.keyboard.press("Control+z");
  await until(async () => JSON.stringify(await program()) === JSON.stringify(before));
});

test("all can be done by keyboard: add, select, join, rename, move, delete", async () => {
  await button("Add function").focus();
  await page.keyboard.press("Enter");
  await node("function-1").waitFor();
  await node("y").focus();
  await page.keyboard.press("Enter");
  await page.keyboard.down("Control");
  await node("function-1").focus();
  await page.keyboard.press("Enter");
  await node("ada").focus();
  await page.keyboard.press("Enter");
  await page.keyboard.up("Control");
  await page.keyboard.press("j");
  await becomes(async () => (await joins())[2]?.split(" ").length, 3);
  await page.keyboard.press("Escape");
  await node("y").focus();
  await page.keyboard.press("Enter");
  await page.keyboard.press("F2");
  await page.keyboard.type("Why");
  await page.keyboard.press("Enter");
  const place = (found) => found.items.find(({ id }) => id === "y");
  await becomes(async () => place(await program()).label, "Why");
  const before = place(await program());
  await page.keyboard.press("ArrowRight");
  await until(async () => place(await program()).position[0] > before.position[0]);
  await page.keyboard.press("Delete");
  await becomes(async () => place(await program()), undefined);
});

test("handles are chosen by keyboard, and joined", async () => {
  await node("ada").focus();
  await page.keyboard.press("Enter");
  await handle("ada", "right").focus();
  await page.keyboard.press("Enter");
  assert.equal(await handle("ada", "right").getAttribute("aria-pressed"), "true");
  await node("grandparent").focus();
  await page.keyboard.press("Enter");
  await handle("grandparent", "bottom").focus();
  await page.keyboard.press("Space");
  await button("Join").click();
  await becomes(async () => (await joins())[2], "ada.right grandparent.bottom");
});

test("what is selected on one side is selected on the other", async () => {
  await node("hyperedge-1").click();
  const picked = () => page.locator("tube-viewer").evaluate(({ selection }) => selection.map(({ id }) => id).join());
  await until(async () => (await picked()) === "hyperedge-1");
  await page.locator("tube-viewer").evaluate((viewer) => viewer.shadowRoot.querySelector("#list").focus());
  await page.keyboard.press("Home");
  await page.keyboard.press("Enter");
  const things = await picked();
  await until(async () => (await page.locator(".react-flow__node.selected").getAttribute("data-id")) === things);
});

test("a program is saved as a file and read again; stored ones are listed", async () => {
  const [saving] = await Promise.all([page.waitForEvent("download"), button("Save").click()]);
  const text = await readFile(await saving.path(), "utf8");
  assert.equal(JSON.parse(text).items.length, 6);
  await node("ada").click();
  await page.keyboard.press("Delete");
  await becomes(async () => (await program()).items.length, 5);
  await button("Open").click();
  await page.getByLabel("From a file …").setInputFiles({ name: "a.json", mimeType: "application/json", buffer: Buffer.from(text) });
  await until(async () => (await program()).items.length === 6);
  await store("listed", { name: "A program of others", items: [{ id: "a" }, { id: "b" }] });
  await button("Open").click();
  await page.getByRole("link", { name: /A program of others/ }).click();
  await page.waitForURL(/program=listed/);
  await node("b").waitFor();
  await edit("listed", { type: "set_item", id: "b", fields: { label: "By another" } });
  await page.getByText("By another").waitFor();
});

test("hyperedges without colours of their own have the colours of their tubes", async () => {
  const items = ["a", "b", "c", "d"].map((id, place) => ({ id, label: id, position: [4 * (place % 2), 5 * (place >> 1), 0] }));
  const joining = (id, ...ends) => ({ id, attachments: ends.map((item) => ({ item })) });
  await store("uncoloured", { items, hyperedges: [joining("e", "a", "b"), joining("f", "c", "d")] });
  await page.goto(`${SERVICE}/editor?program=uncoloured`);
  await saved();
  await shown(page);
  const { hyperedges } = await (await fetch(`${SERVICE}/v1/programs/uncoloured/layout`)).json();
  const canvas = page.locator(".canvas");
  for (const { id, color } of hyperedges) {
    const paint = [1, 3, 5].map((at) => parseInt(color.slice(at, at + 2), 16));
    const isPaint = (...rgb) => rgb.every((value, channel) => Math.abs(value - paint[channel]) < 4);
    await until(async () => pixels(PNG.sync.read(await canvas.screenshot()), isPaint).length > 200);
    assert.equal((await program()).hyperedges.find((each) => each.id === id).color ?? null, null);
  }
});

test("a file that is no program changes nothing, and that is said", async () => {
  await button("Open").click();
  const buffer = Buffer.from('{"items": [{"id": "a"}, {"id": "a"}]}');
  await page.getByLabel("From a file …").setInputFiles({ name: "a.json", mimeType: "application/json", buffer });
  await page.getByRole("alert").waitFor();
  await becomes(async () => (await program()).items.length, 6);
});

test("what is drawn while there is no service is kept, and sent when there is one", async () => {
  await page.context().setOffline(true);
  await button("Add constant").click();
  await page.locator('[role="status"][data-status="offline"]').waitFor();
  await page.context().setOffline(false);
  await becomes(async () => (await program()).items.length, 7);
  await drawn(page);
});
