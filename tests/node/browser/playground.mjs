// The playground, as somebody uses it.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { readFile } from "node:fs/promises";
import { after, before, test } from "node:test";
import { promisify } from "node:util";
import { heard, launch, open, pixels, seen, SERVICE, shown, until } from "./browser.mjs";

const PROGRAM = `{
 "name": "Two",
 "items": [
  {"id": "a", "label": "A", "color": "#d0d0d0", "position": [-1.5, 0, 0.3]},
  {"id": "b", "label": "B", "color": "#d0d0d0", "position": [1.5, 0, 0.3]}
 ],
 "hyperedges": [
  {"id": "e", "color": "#e00000", "attachments": [{"item": "a"}, {"item": "b"}]}
 ]
}`;

const isRed = (red, green, blue) => red > 90 && green < 0.25 * red && blue < 0.25 * red;
const isGreen = (red, green, blue) => green > 90 && red < 0.35 * green && blue < 0.35 * green;

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

/** The playground with a small example, or with a program if one is given. */
async function playground(text, options = {}, path = "/#example=hello") {
  const page = await open(browser, path, { viewport: { width: 1000, height: 600 }, ...options });
  await shown(page);
  if (text !== undefined) await heard(page, "load", later(await write(page, text)));
  return page;
}

/** Puts a text in place of the program; waits until the service has answered. */
async function write(page, text) {
  const now = await page.evaluate(() => performance.now());
  await page.getByRole("textbox", { name: "Program" }).click();
  await page.keyboard.press("ControlOrMeta+a");
  await page.keyboard.insertText(text);
  return now;
}

const later = (now, more = "true") => `({ at, ...rest }) => at > ${now} && ((event) => ${more})(rest)`;

test("it opens with the second clause of the paper's program, and says that nothing touches", async () => {
  const page = await playground(undefined, {}, "/");
  const { items, hyperedges } = await heard(page, "load");
  assert.deepEqual([items, hyperedges], [54, 9]);
  await heard(page, "clearance");
  await page.getByText("No two hyperedges touch").waitFor();
  assert.deepEqual(page.troubles, []);
  await page.context().close();
});

test("the text can be written in before its editor is there, which then goes on where one is", async () => {
  const page = await open(browser, "/viewer", { viewport: { width: 1000, height: 600 } });
  let release;
  const held = new Promise((resolve) => (release = resolve));
  await page.route(/\/web\/editor-/, async (route) => {
    await held;
    await route.continue();
  });
  await page.goto(`${SERVICE}/#example=hello`);
  await shown(page);
  const linesOf = (page) =>
    page.evaluate(() => {
      const found = document.querySelector("#editor").shadowRoot.querySelectorAll(".lines div, .cm-line");
      return [...found].filter(({ innerText }) => innerText.trim()).map((line) => {
        const words = document.createRange();
        words.selectNodeContents(line);
        const { left, top } = words.getClientRects()[0];
        return [left, top].map(Math.round).join();
      });
    });
  const before = await linesOf(page);
  const now = await write(page, PROGRAM.replace("}\n ]\n}", "}\n ],\n \"notation\": \n}"));
  for (let count = 0; count < 2; count += 1) await page.keyboard.press("ArrowLeft");
  await page.keyboard.type('"pla');
  release();
  await page.locator(".cm-content").waitFor();
  await page.keyboard.type('in"');
  await heard(page, "load", later(now, "event.items === 2"));
  assert.match(await page.locator(".cm-content").innerText(), /"notation": "plain"\n\}/);
  assert.ok(pixels(await seen(page), isRed).length > 200);
  assert.deepEqual(page.troubles, []);
  const other = await playground();
  await other.locator(".cm-content").waitFor();
  assert.ok(before.length > 3);
  assert.deepEqual(await linesOf(other), before);
  for (const each of [page, other]) await each.context().close();
});

test("what one types shows at once", async () => {
  const page = await playground();
  const now = await write(page, PROGRAM);
  await heard(page, "load", later(now, "event.items === 2"));
  assert.ok(pixels(await seen(page), isRed).length > 200);
  const then = await write(page, PROGRAM.replace("#e00000", "#00a000"));
  await heard(page, "load", later(then));
  const green = await seen(page);
  assert.ok(pixels(green, isGreen).length > 200);
  assert.equal(pixels(green, isRed).length, 0);
  await page.context().close();
});

test("errors stand where they are: of the text at once, of the program as the service says", async () => {
  const page = await playground(PROGRAM);
  await write(page, PROGRAM.replace('"item": "b"', '"item": "c"'));
  const problems = page.getByRole("region", { name: "Problems" });
  const problem = problems.getByRole("button").first();
  await problem.waitFor();
  assert.match(await problem.textContent(), /8/);
  assert.match(await problem.textContent(), /"?c"?/);
  assert.ok(await page.locator(".cm-lintRange-error").count());
  await write(page, PROGRAM.replace('"label": "A", ', '"label" "A", '));
  await until(async () => /4/.test(await problem.textContent()));
  assert.ok(pixels(await seen(page), isRed).length > 200, "the last good picture stays");
  const now = await write(page, PROGRAM);
  await heard(page, "load", later(now));
  await until(async () => (await problems.getByRole("button").count()) === 0);
  await page.context().close();
});

test("a choice in the picture finds its text, and the text its thing in the picture", async () => {
  const page = await playground();
  const now = await write(page, PROGRAM);
  await heard(page, "load", later(now, "event.items === 2"));
  const found = pixels(await seen(page), isRed);
  const [x, y] = found[Math.floor(found.length / 2)];
  await page.locator("tube-viewer").click({ position: { x, y } });
  await heard(page, "select", "({ things }) => things[0]?.id === 'e'");
  await until(async () => (await page.locator(".cm-activeLine").first().textContent())?.includes('"id": "e"'));
  await page.getByText('"position": [-1.5').first().click();
  await until(() => page.evaluate(() => document.querySelector("tube-viewer").selection[0]?.id === "a"));
  await page.context().close();
});

test("keys and values are completed", async () => {
  const page = await playground();
  await write(page, '{"items": [{"id": "first"}], "hyperedges": [{"id": "e", "attachments": [{"item": "');
  await page.keyboard.press("Control+Space");
  await page.locator(".cm-tooltip-autocomplete").getByText("first").waitFor();
  await page.context().close();
});

test("an example of another format becomes a program", async () => {
  const page = await playground();
  const now = await page.evaluate(() => performance.now());
  const examples = page.getByRole("combobox", { name: "Example" });
  await examples.selectOption({ label: (await examples.locator("option").allTextContents()).find((name) => /up3down5|counter/i.test(name)) });
  const { hyperedges } = await heard(page, "load", later(now));
  assert.ok(hyperedges > 20);
  await page.context().close();
});

test("a link carries the program, and the command line makes what one sees", async () => {
  const context = { permissions: ["clipboard-read", "clipboard-write"] };
  const page = await playground(undefined, context);
  const now = await write(page, PROGRAM);
  await heard(page, "load", later(now, "event.items === 2"));
  const copied = async (name) => {
    await page.evaluate(() => navigator.clipboard.writeText(""));
    await page.getByRole("button", { name }).click();
    return until(() => page.evaluate(() => navigator.clipboard.readText()));
  };
  const command = await copied("Copy curl");
  const { stdout } = await promisify(execFile)("bash", ["-c", `cd "$(mktemp -d)" && ${command} >&2 && head -c 4 *`]);
  assert.equal(stdout, "glTF");
  const link = await copied("Copy link");
  const other = await page.context().newPage();
  await other.goto(link);
  await other.getByText('"name": "Two"').waitFor();
  await page.context().close();
});

test("the scene is downloaded in other formats", async () => {
  const page = await playground(PROGRAM);
  await page.getByRole("button", { name: "Download", exact: true }).click();
  for (const [name, start] of [[/SVG/i, "<"], [/GLB|binary/i, "glTF"]]) {
    const [download] = await Promise.all([
      page.waitForEvent("download"),
      page.getByRole("dialog", { name: "Download" }).getByRole("button", { name }).first().click(),
    ]);
    assert.ok((await readFile(await download.path(), "latin1")).startsWith(start));
  }
  await page.context().close();
});

test("a final picture shows how it comes, and can be stopped", async () => {
  const page = await playground(PROGRAM.replace('"Two"', `"Two at ${Date.now()}"`));
  // With so many samples it does not end before it is stopped.
  await page.route(/\/v1\/render\?.*quality=final/, (route) => route.continue({ url: `${route.request().url()}&samples=65536` }));
  await page.getByRole("radio", { name: "Final picture" }).check();
  const drawing = page.getByRole("group", { name: "Drawing" });
  await drawing.getByRole("progressbar").waitFor();
  await page.locator("#still:not([hidden])").waitFor();
  assert.ok(await page.locator("#still").evaluate((image) => image.decode().then(() => image.naturalWidth > 300)));
  const preview = await seen(page, "#still");
  assert.ok(await drawing.getByRole("progressbar").isVisible(), "what is seen is not finished");
  const share = pixels(preview, isRed).length / (preview.width * preview.height);
  assert.ok(share > 0.005 && share < 0.2, `a share of ${share} is red`);
  await drawing.getByRole("button", { name: "Cancel" }).click();
  await drawing.getByRole("button", { name: "Draw again" }).waitFor();
  await page.getByRole("radio", { name: "Draft picture" }).check();
  await page.locator("#still:not([hidden])").waitFor();
  assert.ok(await page.locator("#still").evaluate((image) => image.decode().then(() => image.naturalWidth > 300)));
  await page.context().close();
});

test("a file that is dropped is shown", async () => {
  const page = await playground();
  const now = await page.evaluate(() => performance.now());
  const netlist = await readFile(new URL("../../../examples/yosys/mux4.json", import.meta.url), "utf8");
  const data = await page.evaluateHandle((text) => {
    const transfer = new DataTransfer();
    transfer.items.add(new File([text], "mux4.json", { type: "application/json" }));
    return transfer;
  }, netlist);
  for (const kind of ["dragenter", "dragover", "drop"]) {
    await page.dispatchEvent("main", kind, { dataTransfer: data });
  }
  await heard(page, "load", later(now, "event.hyperedges > 3"));
  await page.context().close();
});
