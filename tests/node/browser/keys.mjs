// Pages of a service that wants a key: each asks for it once, and works with it.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { heard, launch, open, SERVICE, shown, until } from "./browser.mjs";

const { KEY } = process.env;

let browser;
before(async () => (browser = await launch()));
after(() => browser.close());

/** Gives a key to the page, which asks for one. */
async function give(page, key) {
  const dialog = page.getByRole("dialog", { name: /key/ });
  await dialog.getByLabel("API key").fill(key);
  await dialog.getByRole("button", { name: "Go on" }).click();
}

/** A page of the service, with the addresses that it has asked for. */
async function asking(path) {
  const page = await open(browser, path, { viewport: { width: 1000, height: 600 } });
  page.asked = [];
  page.on("request", (request) => page.asked.push(request.url()));
  return page;
}

for (const path of ["/#example=hello", "/viewer?stored=kept", "/editor?program=kept", "/litegraph"]) {
  test(`${path} asks for the key, also if a wrong one is given, and keeps it in its tab`, async () => {
    const page = await asking(path);
    await give(page, "tl_wrong");
    await page.getByRole("dialog", { name: "The service does not take this key" }).waitFor();
    await give(page, KEY);
    await heard(page, "load", "({ hyperedges }) => hyperedges > 0");
    await shown(page);
    assert.equal(await page.getByRole("dialog", { name: /key/ }).count(), 0);
    await page.reload();
    await heard(page, "load", "({ hyperedges }) => hyperedges > 0");
    assert.equal(await page.getByRole("dialog", { name: /key/ }).count(), 0);
    assert.equal(page.asked.filter((url) => url.includes(KEY)).length, 0, "the key is in no address");
    assert.equal(await page.evaluate((key) => Object.values(localStorage).includes(key), KEY), false);
    await page.context().close();
  });
}

test("what one does in the editor is stored with the key", async () => {
  const page = await asking("/editor?program=kept");
  await give(page, KEY);
  await shown(page);
  await page.getByLabel("Name of the program").fill("Named with a key");
  const headers = { Authorization: `Bearer ${KEY}` };
  await until(async () => (await (await fetch(`${SERVICE}/v1/programs/kept`, { headers })).json()).name === "Named with a key");
  await page.getByRole("button", { name: "Open" }).click();
  await page.getByRole("dialog", { name: "Open a program" }).getByText("kept").first().waitFor();
  await page.context().close();
});

test("whoever has no key may look at the page, and is told why there is no picture", async () => {
  const page = await asking("/viewer?stored=kept");
  await page.getByRole("dialog", { name: "This service wants an API key" }).getByRole("button", { name: "Without" }).click();
  await page.locator("tube-viewer").getByRole("status").getByText(/key/i).waitFor();
  await page.context().close();
});

test("the command line names the key without carrying it", async () => {
  const page = await open(browser, "/#example=hello", { permissions: ["clipboard-read", "clipboard-write"], viewport: { width: 1000, height: 600 } });
  await give(page, KEY);
  await shown(page);
  await page.getByRole("button", { name: "Copy curl" }).click();
  const command = await until(() => page.evaluate(() => navigator.clipboard.readText()));
  assert.match(command, /Bearer \$TUBELOOM_KEY/);
  assert.ok(!command.includes(KEY));
  await page.context().close();
});
