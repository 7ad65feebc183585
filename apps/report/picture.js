// The picture of the page in the README: `node picture.js PAGE PNG WORDS` makes it, and writes the page's words to a file beside it; with `--check`
// it compares only the words. They say which page the picture shows, and are the same with any browser, fonts and processor.
import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { resolve } from "node:path";
import { PATIENCE, launch } from "./browser.js";

/** Part of the motion that is over. */
const MOMENT = 0.32;

const check = process.argv.includes("--check");
const [file, png, words] = process.argv.slice(2).filter((word) => word !== "--check");

/** Opens the page as the README shows it. */
async function open(options, use) {
  const browser = await launch(options);
  const page = await browser.newPage({ viewport: { width: 1440, height: 900 }, colorScheme: "light", reducedMotion: "reduce" });
  page.setDefaultTimeout(PATIENCE);
  await page.goto(`file://${resolve(file)}`);
  await page.waitForFunction(() => document.documentElement.dataset.ready === "yes", null, { timeout: PATIENCE });
  const given = await use(page);
  await browser.close();
  return given;
}

/** What the page says where it does not change with the motion: headings, links to them, buttons, labels of controls. */
const said = await open({ flat: true, swift: true }, (page) =>
  page.evaluate(() => {
    const parts = [...document.querySelectorAll("h1, h2, h3, nav a, button, summary, label")].map((part) => part.cloneNode(true));
    for (const part of parts) for (const choice of part.querySelectorAll("select, output, input")) choice.remove();
    const texts = parts.map((part) => part.textContent.replace(/\s+/g, " ").replace(/ \(\d+ rows\)/, "").trim());
    return [...new Set(texts)].filter((text) => /\p{L}{3}/u.test(text)).map((text) => `${text}\n`).join("");
  }));
if (check) {
  assert.equal(said, await readFile(words, "utf8"), `${png} is of another page: cargo xtask pictures`);
} else {
  await open({}, async (page) => {
    await page.evaluate((part) => globalThis.report.player.seek(globalThis.report.player.duration * part), MOMENT);
    await page.waitForTimeout(1000);
    await page.screenshot({ path: png });
  });
  await writeFile(words, said);
}
