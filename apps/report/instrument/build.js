// Builds the instrument into one HTML file: `node instrument/build.js ENGINE.wasm TARGET.html`.
import { readFile, writeFile } from "node:fs/promises";
import { gzipAsync } from "@gfx/zopfli";
import { build } from "esbuild";
import { assemble, output } from "../page.js";
import { lessons } from "./lessons.js";

const [engine, target] = process.argv.slice(2);
const folder = new URL("..", import.meta.url).pathname;
const file = (path) => readFile(new URL(path, import.meta.url), "utf8");

const options = { absWorkingDir: folder, bundle: true, minify: true, target: "es2022", legalComments: "none", charset: "utf8", write: false, outdir: "out" };
const worker = await build({ ...options, entryPoints: ["instrument/src/worker.js"], format: "iife" });
/** The worker is text of the page: a page in one file has no other script to start it from. */
const source = {
  name: "worker-source",
  setup({ onResolve, onLoad }) {
    onResolve({ filter: /^worker-source$/ }, ({ path }) => ({ path, namespace: "text" }));
    onLoad({ filter: /.*/, namespace: "text" }, () => ({ contents: output(worker, ".js"), loader: "text" }));
  },
};
const page = await build({ ...options, entryPoints: ["instrument/src/page.js"], format: "esm", plugins: [source] });

/** Largest compressed engine, bytes: the goal is 1.2 MB, for pages that are mailed and opened on phones; what is far beyond it is a mistake.
    Checks build without optimising the units of a crate once more as one: 2 % more. The table of units, curves and warnings took 2 %, closed
    sums of tangents, combinations and duties of drives 1.5 %; exact couplings, names of results and shapes of cranes another 1.5 %. The
    shapes that pages draw, limits and usual ranges of keys, tangents in loops and duties of drives took 6 %; events on conditions and presets 1 %. */
const MOST = process.env.CARGO_PROFILE_RELEASE_LTO === "off" ? 1.56e6 : 1.53e6;

/** The cranes to start from, simplest first, with the titles of their specs and their pictures. */
const EXAMPLES = [
  "knuckle_boom", "double_pendulum", "cantilever", "loader_tipping", "two_arms", "examples/loader_crane", "examples/parallel_harvester", "examples/telescopic_loader", "eight_link_rigid", "eight_link_flexible", "eight_link_hydraulic",
  "eight_link_identified", "eight_link_two_flexible",
];
/** The picture of a crane, to be shown small: without words, table and axes, and with thicker lines. */
const picture = async (name) => (await file(`../../../docs/images/cranes/${name}.svg`))
  .replace(/<text[^]*?<\/text>|<title>[^]*?<\/title>|<rect width='100%'[^>]*>|<[^>]*stroke-width='1.4'[^>]*>|\n/g, "")
  .replace(/stroke-width='([\d.]+)'/g, (_, width) => `stroke-width='${2.5 * width}'`).replace(/width='\d+' height='\d+' viewBox='[^']*'/, "viewBox='0 40 740 520'");
const examples = await Promise.all(EXAMPLES.map(async (path) => {
  const name = path.split("/").at(-1);
  const text = await file(`../../../specs/${path}.yaml`);
  return { name: `${name}.yaml`, title: /^title: (.*)$/m.exec(text)[1], picture: await picture(name), text };
}));
const fresh = { name: "new_crane.yaml", text: await file("src/new.yaml") };
const given = JSON.stringify({ lessons: await lessons(), examples, fresh, schema: JSON.parse(await file("../../../specs/crane.schema.json")) }).replaceAll("<", "\\u003c");
// A twentieth less than by zlib.
const compressed = await gzipAsync(await readFile(engine), { numiterations: 5 });
if (compressed.length > MOST) {
  console.error(`the engine has ${compressed.length} bytes, compressed: at most ${MOST}`);
  process.exit(1);
}
const version = /^version = "(.*)"/m.exec(await file("../../../Cargo.toml"))[1];

const html = await assemble({
  template: await file("src/page.html"), script: output(page, ".js"), style: output(page, ".css"),
  packages: ["three", "uplot", "@codemirror/autocomplete", "@codemirror/commands", "@codemirror/lang-yaml", "@codemirror/language", "@codemirror/lint", "@codemirror/search", "@codemirror/state", "@codemirror/view", "@lezer/common", "@lezer/highlight", "@lezer/lr", "@lezer/yaml", "@marijn/find-cluster-break", "crelt", "style-mod", "w3c-keyname"],
  // The engine is compiled, and its worker is text of the page.
  policy: { "script-src": ["'wasm-unsafe-eval'"], "worker-src": ["blob:"] },
  more: { given, engine: Buffer.from(compressed).toString("base64"), version },
});
await writeFile(target, html);
const megabytes = (bytes) => `${(bytes / 1e6).toFixed(2)} MB`;
console.log(`${target}: ${megabytes(html.length)}, engine ${megabytes(compressed.length)} compressed, script ${megabytes(output(page, ".js").length)}`);
