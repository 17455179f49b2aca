// Measures what browsers take; benchmarks/browser.py runs it and prints the table.
import { gzipSync } from "node:zlib";
import { drawn, heard, launch, open, SERVICE, store } from "./browser.mjs";

const WINDOW = { viewport: { width: 1280, height: 800 } };

/** From asking for a page until a frame with the scene has been handed over; bytes of its scripts. */
async function firstPicture(browser, path) {
  const context = await browser.newContext(WINDOW);
  const page = await context.newPage();
  const scripts = new Set();
  page.on("request", (request) => request.resourceType() === "script" && scripts.add(request.url()));
  await page.addInitScript(() => {
    addEventListener("tube-load", () => {
      addEventListener("tube-frame", () => setTimeout(() => (window.seen ??= performance.now())), { once: true });
    });
  });
  await page.goto(SERVICE + path);
  const seen = await page.waitForFunction(() => window.seen);
  const milliseconds = await seen.jsonValue();
  // What comes after the picture counts too.
  await page.waitForTimeout(3000);
  await context.close();
  let bytes = 0;
  for (const url of scripts) bytes += gzipSync(Buffer.from(await (await fetch(url)).arrayBuffer())).length;
  return { milliseconds, bytes };
}

/** A field of hyperedges, each among three near items. */
function field(hyperedges) {
  const side = Math.ceil(Math.sqrt(hyperedges * 2));
  const items = Array.from({ length: side * side }, (_, place) => ({
    id: `i${place}`,
    position: [2 * (place % side), 2 * Math.floor(place / side), 0.3],
    shape: { type: "box", size: [0.8, 0.8, 0.6] },
  }));
  const joined = Array.from({ length: hyperedges }, (_, number) => {
    const row = Math.floor(number / (side / 2));
    const at = row * side + 2 * (number % Math.floor(side / 2));
    const ids = [at, at + 1, (at + side) % items.length];
    return { id: `e${number}`, attachments: ids.map((each) => ({ item: `i${each % items.length}` })) };
  });
  return { items, hyperedges: joined };
}

/** Medians of what passes from sending an edit until its scene is ready, and until it is drawn. */
async function edits(browser, hyperedges) {
  const id = `field-${hyperedges}`;
  await store(id, field(hyperedges));
  const page = await open(browser, `/viewer?stored=${id}`, WINDOW);
  const { triangles, calls, bytes } = await heard(page, "load");
  await drawn(page);
  const [ready, frames] = [[], []];
  for (let round = 0; round < 9; round += 1) {
    const before = await page.evaluate(() => performance.now());
    const color = `#${(0x100000 + 0x0a1b2c * round).toString(16).slice(-6)}`;
    await page.evaluate(
      async ([id, color]) => {
        window.sent = performance.now();
        const body = { edits: [{ type: "set_hyperedge", id: "e7", fields: { color } }] };
        const headers = { "Content-Type": "application/json" };
        await fetch(`/v1/programs/${id}/edits`, { method: "POST", headers, body: JSON.stringify(body) });
      },
      [id, color],
    );
    const { at } = await heard(page, "load", `({ at }) => at > ${before}`);
    await heard(page, "clearance", `({ at }) => at > ${before}`);
    ready.push(at - (await page.evaluate(() => window.sent)));
    frames.push(
      await page.evaluate(async () => {
        const began = performance.now();
        const viewer = document.querySelector("tube-viewer");
        await viewer.drawn();
        await new Promise((resolve) => setTimeout(resolve));
        await viewer.drawn();
        return (performance.now() - began) / 2;
      }),
    );
    // The next edit does not wait for this one's frames.
    await page.screenshot();
  }
  await page.context().close();
  return { hyperedges, triangles, calls, bytes, ready: middle(ready), frame: middle(frames) };
}

/** What some 10,000 tubes cost a graphics card. */
async function crowd(browser, hyperedges) {
  const page = await open(browser, "/viewer", WINDOW);
  await page.evaluate((program) => {
    const viewer = document.querySelector("tube-viewer");
    viewer.hidden = false;
    viewer.program = program;
  }, { ...field(hyperedges), layout: { clearance: null } });
  const { triangles, calls, bytes, milliseconds } = await heard(page, "load");
  await page.context().close();
  return { hyperedges, triangles, calls, bytes, milliseconds };
}

function middle(values) {
  return values.sort((one, other) => one - other)[values.length >> 1];
}

await store("clause", JSON.parse(process.env.CLAUSE));
const found = { first: [], edits: [] };
for (let round = 0; round < 5; round += 1) {
  const browser = await launch();
  found.first.push({ path: "/viewer", ...(await firstPicture(browser, "/viewer?stored=clause")) });
  found.first.push({ path: "/viewer, again", ...(await firstPicture(browser, "/viewer?stored=clause")) });
  await browser.close();
  const other = await launch();
  found.first.push({ path: "/", ...(await firstPicture(other, "/")) });
  found.first.push({ path: "/, again", ...(await firstPicture(other, "/")) });
  await other.close();
}
const browser = await launch();
for (const hyperedges of [50, 1000]) found.edits.push(await edits(browser, hyperedges));
found.crowd = await crowd(browser, 3334);
await browser.close();
console.log(JSON.stringify(found));
