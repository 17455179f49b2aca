// Debian's Chromium without a window and without a graphics card, and what is seen in it.
import assert from "node:assert/strict";
import { isDeepStrictEqual } from "node:util";
import { PNG } from "pngjs";
import { chromium } from "playwright-core";

const FLAGS = [
  "--no-sandbox",
  "--enable-unsafe-swiftshader",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
  "--no-first-run",
];

export const SERVICE = process.env.TUBELOOM_URL;

/** For what should take a second or two, on a machine that is busy. */
export const PATIENCE = 60_000;

export function launch() {
  return chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: FLAGS });
}

/** A page of the service; `heard` has the viewer's events, and `troubles` what goes wrong. */
export async function open(browser, path, options = {}) {
  const context = await browser.newContext({
    viewport: { width: 700, height: 500 },
    reducedMotion: "reduce",
    ...options,
  });
  const page = await context.newPage();
  page.setDefaultTimeout(PATIENCE);
  page.troubles = [];
  page.on("pageerror", (error) => page.troubles.push(error.message));
  page.on("console", (message) => {
    const isOurs = !message.text().includes("GPU stall") && !message.text().includes("Failed to load resource");
    if (["error", "warning"].includes(message.type()) && isOurs) page.troubles.push(message.text());
  });
  await page.addInitScript(() => {
    window.heard = [];
    for (const name of ["load", "hover", "select", "status", "problem", "clearance", "frame"]) {
      addEventListener(`tube-${name}`, ({ detail }) => window.heard.push({ name, at: performance.now(), ...detail }));
    }
  });
  await page.goto(SERVICE + path);
  return page;
}

/** The last event of this name, once there is one that `suits`: a function of the event, as text. */
export async function heard(page, name, suits = "() => true") {
  const last = `window.heard.findLast((each) => each.name === ${JSON.stringify(name)} && (${suits})(each))`;
  // Asked from here, for the page's policy allows no code that comes as text.
  return until(() => page.evaluate(last));
}

/** What `find` finds, as soon as it is true. */
export async function until(find) {
  for (const end = Date.now() + PATIENCE; ; await new Promise((resolve) => setTimeout(resolve, 30))) {
    const found = await find();
    if (found) return found;
    if (Date.now() > end) throw new Error(`Not within ${PATIENCE} ms: ${find}`);
  }
}

/** Waits until what `find` finds is `wanted`; fails with the difference if it never is. */
export async function becomes(find, wanted, message) {
  for (const end = Date.now() + PATIENCE; ; await new Promise((resolve) => setTimeout(resolve, 30))) {
    const found = await find();
    if (isDeepStrictEqual(found, wanted)) return;
    if (Date.now() > end) assert.deepEqual(found, wanted, message);
  }
}

/** Once the viewer shows a scene. */
export async function shown(page) {
  await heard(page, "load");
  await drawn(page);
}

/** Once a frame shows all that was changed. */
export function drawn(page) {
  return page.evaluate(() => document.querySelector("tube-viewer").drawn());
}

/** What is seen of the page, or of one of its parts. */
export async function seen(page, selector = "tube-viewer") {
  await drawn(page);
  return PNG.sync.read(await page.locator(selector).screenshot());
}

export function pixel({ data, width }, x, y) {
  const at = 4 * (width * y + x);
  return [data[at], data[at + 1], data[at + 2]];
}

/** The pixels that `suits` chooses, by their colour in red, green and blue from 0 to 255. */
export function pixels(picture, suits) {
  const found = [];
  for (let y = 0; y < picture.height; y += 1) {
    for (let x = 0; x < picture.width; x += 1) {
      if (suits(...pixel(picture, x, y))) found.push([x, y]);
    }
  }
  return found;
}

/** The share of pixels that differ in two pictures. */
export function difference(one, other) {
  let count = 0;
  for (let at = 0; at < one.data.length; at += 4) {
    const [red, green, blue] = [0, 1, 2].map((part) => Math.abs(one.data[at + part] - other.data[at + part]));
    if (red + green + blue > 30) count += 1;
  }
  return count / (one.data.length / 4);
}

/** Stores a program under an id. */
export async function store(id, document) {
  const response = await fetch(`${SERVICE}/v1/programs/${id}`, {
    method: "PUT",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify(document),
  });
  if (!response.ok) throw new Error(await response.text());
}

/** Carries out edits on a stored program. */
export async function edit(id, ...edits) {
  const response = await fetch(`${SERVICE}/v1/programs/${id}/edits`, {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify({ edits }),
  });
  if (!response.ok) throw new Error(await response.text());
}
