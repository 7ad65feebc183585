// Pages inside a notebook, as a browser shows them: `node notebook.js FILE`, with the FILE from notebook.py. A picture goes next to it.
import assert from "node:assert/strict";
import { resolve } from "node:path";
import { PATIENCE, launch } from "./browser.js";

const file = resolve(process.argv[2]);
const browser = await launch();
const context = await browser.newContext({ offline: true, reducedMotion: "reduce", viewport: { width: 1100, height: 1700 } });
const page = await context.newPage();
page.setDefaultTimeout(PATIENCE);
const said = [];
page.on("console", (message) => said.push(`${message.type()}: ${message.text()}`));
page.on("pageerror", (error) => said.push(`error: ${error.stack}`));
page.on("request", (request) => {
  if (!/^(file|data|blob|about):/.test(request.url())) said.push(`request: ${request.url()}`);
});
await page.goto(`file://${file}`);

const frames = [];
for (const element of await page.$$("iframe")) {
  await element.scrollIntoViewIfNeeded();
  frames.push(await element.contentFrame());
}
// A frame out of sight draws nothing, so poll by time instead of by animation frame.
const until = (frame, question) => frame.waitForFunction(question, null, { timeout: PATIENCE, polling: 100 });
for (const frame of frames) await until(frame, () => document.documentElement.dataset.ready === "yes");
const [atRest, moving] = frames;
const sections = (frame) => frame.$$eval("section", (all) => all.map(({ id }) => id));
assert.deepEqual(await sections(atRest), ["stage", "tables"], "a crane at rest: the view and its tables, and nothing about a run");
assert((await atRest.locator("#tiles > div").count()) >= 3);
assert((await atRest.locator("#mode option").count()) > 10);
const run = await sections(moving);
assert(["stage", "motion", "drives", "supports", "energy", "repeat", "tables"].every((id) => run.includes(id)), `${run}`);
for (const frame of frames) assert((await frame.locator("#tables table").count()) >= 2);
assert((await moving.locator("figure.panel").count()) > 10);

// A mode moves the crane at rest.
await atRest.locator("#view canvas").scrollIntoViewIfNeeded();
const look = () => atRest.locator("#view canvas").screenshot();
const still = await look();
await atRest.selectOption("#mode", "0");
await until(atRest, () => globalThis.report.player.t > 0.2);
assert(!still.equals(await look()), "the mode does not move");

// A link leads to its section, not to the notebook.
await moving.click('nav a[href="#energy"]');
await until(moving, () => Math.abs(document.querySelector("#energy").getBoundingClientRect().top) < 200);
assert.equal(await moving.evaluate(() => globalThis.report.data.cranes.length), 1);
assert.equal(await moving.evaluate(() => { try { return typeof parent.document; } catch { return "closed"; } }), "closed");
await moving.locator("#stage").scrollIntoViewIfNeeded();
await page.screenshot({ path: file.replace(/\.html$/, ".png") });
assert.deepEqual(said, [], "a page says or asks for something");
await browser.close();
console.log(`${frames.length} pages inside a notebook: ok`);
