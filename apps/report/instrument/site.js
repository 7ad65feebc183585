// Opens every spec to which pages of the site link: `node instrument/site.js ENGINE.wasm SITE`. The engine finds no mistake in it.
import assert from "node:assert/strict";
import { readFile, readdir } from "node:fs/promises";
import { join } from "node:path";
import { start } from "./process.js";
import { text } from "./src/link.js";

const [wasm, site] = process.argv.slice(2);
const LINK = /href="[^"]*instrument\.html(#spec=[^"]+)"/g;
/** Fewer would mean that links are not found. */
const LEAST = 15;

const ask = await start(wasm);
const files = (await readdir(site, { recursive: true })).filter((name) => name.endsWith(".html") && !name.startsWith("cranes"));
const names = [];
for (const file of files) {
  const page = await readFile(join(site, file), "utf8");
  for (const [, hash] of page.matchAll(LINK)) {
    const opened = ask({ ask: "open", name: file, text: await text(hash) });
    assert(opened.name, `${file}: ${opened.drawn}`);
    names.push(opened.name);
  }
}
assert(names.length >= LEAST, `only ${names.length} specs`);
console.log(`${names.length} specs of the site open in the instrument: ${[...new Set(names)].join(", ")}`);
