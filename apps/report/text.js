// What pages say: `node text.js PAGE …`. Every tile and every line of the summary to sign is the text that the command wrote, what is
// beyond its limit stands out, and no value is missing. Without 3-D, so that it takes a second per page.
import assert from "node:assert/strict";
import { basename, resolve } from "node:path";
import { PATIENCE, launch } from "./browser.js";

const browser = await launch({ flat: true });
const context = await browser.newContext({ offline: true, reducedMotion: "reduce", viewport: { width: 1000, height: 700 } });
/** Colour of what is beyond its limit, on light paper. */
const RED = "rgb(179, 38, 30)";

/** What the page shows, and what the command wrote. */
function shown() {
  const { data } = globalThis.report;
  const texts = (host, selector) => [...host.querySelectorAll(selector)].map(({ textContent }) => textContent);
  const red = (element) => getComputedStyle(element).color;
  return {
    written: { figures: data.figures, summary: data.summary, verdict: data.verdict, moves: data.moves },
    bars: [...document.querySelectorAll("#moves .block .move")].map((row) => ({ texts: texts(row, "span.number, span.change"), width: parseFloat(row.querySelector("b").style.width) })),
    cut: [...document.querySelectorAll("#moves .number")].filter((one) => one.scrollWidth > one.clientWidth).map(({ textContent }) => textContent),
    ticks: [...document.querySelectorAll("#moves .tick")].map((tick) => tick.getBoundingClientRect()).filter(({ width }) => width).map(({ left, right }) => [left, right]),
    drawn: texts(document, "#moves code").join(""),
    tiles: [...document.querySelectorAll("#tiles > div")].map((tile) => ({ texts: texts(tile, "span, strong"), colour: red(tile.querySelector("strong")) })),
    lines: [...document.querySelectorAll("#sign tr")].map((line) => ({ name: texts(line, "th")[0], texts: texts(line, "td p"), colour: red(line.querySelector("td")) })),
    verdict: document.querySelector("#verdict")?.textContent ?? null,
    // Without the script, the style and the data.
    whole: [...document.querySelectorAll("header, nav, main")].map(({ textContent }) => textContent).join("\n"),
    titles: [...document.querySelectorAll("[title]")].map(({ title }) => title).join("\n"),
  };
}

for (const file of process.argv.slice(2).map((path) => resolve(path))) {
  const page = await context.newPage();
  page.setDefaultTimeout(PATIENCE);
  const errors = [];
  page.on("pageerror", (error) => errors.push(error.stack));
  await page.emulateMedia({ colorScheme: "light" });
  await page.goto(`file://${file}`);
  await page.waitForFunction(() => document.documentElement.dataset.ready === "yes");
  const name = basename(file);
  for (const [media, width] of [["screen", 1000], ["screen", 390], ["print", 680]]) {
    await page.emulateMedia({ media });
    await page.setViewportSize({ width, height: 700 });
    const { written, tiles, lines, verdict, whole, titles, bars, drawn, cut, ticks } = await page.evaluate(shown);
    assert.deepEqual(cut, [], `${name}: names that are cut, ${media} of ${width} points`);
    ticks.slice(1).forEach(([left], index) => assert(left > ticks[index][1], `${name}: numbers of the scale overlap, ${media} of ${width} points`));
    assert.deepEqual(tiles.map(({ texts }) => texts), written.figures.map(({ title, value, note }) => [title, value, note]), `${name}: tiles`);
    assert.deepEqual(lines.map(({ name, texts }) => [name, texts]), written.summary.map(({ name, texts }) => [name, texts]), `${name}: to sign`);
    const moved = (written.moves?.outputs ?? []).flatMap((output) => output.bars);
    const greatest = Math.max(0, ...moved.map(({ relative }) => Math.abs(relative)));
    assert.deepEqual(bars.map(({ texts }) => texts), moved.map(({ number, text }) => [number, text]), `${name}: what moves what`);
    // Half of the track is the largest change; the page writes five digits.
    moved.forEach(({ relative }, index) => assert(Math.abs(bars[index].width - (50 * Math.abs(relative)) / greatest) < 1e-2, `${name}: bar ${index}`));
    assert.equal(drawn, written.moves?.command ?? "", name);
    if (written.verdict.verdict !== "unlimited") assert.equal(verdict, written.verdict.text, name);
    for (const [shown, all] of [[tiles, written.figures], [lines, written.summary]]) {
      shown.forEach(({ colour }, index) => assert.equal(colour === RED, all[index].verdict === "beyond", `${name}, ${media}: ${JSON.stringify(all[index])} in ${colour}`));
    }
    for (const text of [whole, titles]) {
      const missing = text.match(/.{0,60}(undefined|\bNaN\b|\[object|\bnull\b|Infinity).{0,60}/);
      assert(!missing, `${name}: ${missing?.[0]}`);
    }
  }
  assert.deepEqual(errors, [], name);
  await page.close();
}
await browser.close();
console.log(`${process.argv.length - 2} pages say what was computed`);
