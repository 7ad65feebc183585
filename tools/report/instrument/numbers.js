// Compares numbers of the engine with those of the command: `node instrument/numbers.js ENGINE.wasm CRANE`, where CRANE is the command.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtemp, readFile, readdir, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { fileURLToPath } from "node:url";
import { start } from "./process.js";

const [wasm, command] = process.argv.slice(2);
const SPECS = fileURLToPath(new URL("../../../specs", import.meta.url));

/** Largest difference, relative to the largest number of a table: the same operations in the same order, of which only those of the system's
 * mathematical library may round differently. */
const SAME = 1e-12;

/** The same for runs: pages hold them in single precision. */
const SINGLE = 1e-6;
/** Their length, s. */
const DURATION = 0.5;

/** What the command prints, also where it ends with a failure: a spec with mistakes, a crane that does not rest. */
function crane(words, input = "") {
  const { stdout } = spawnSync(command, words, { input, encoding: "utf8", maxBuffer: 1 << 28 });
  return JSON.parse(stdout);
}

/** All numbers in some JSON, with their paths. */
function numbers(value, path = "") {
  if (typeof value === "number") return [[path, value]];
  if (value === null || typeof value !== "object") return [];
  return Object.entries(value).flatMap(([key, one]) => numbers(one, `${path}.${key}`));
}

/** Largest difference of two tables, relative to their largest number. */
function difference(own, other, what) {
  const [a, b] = [own, other].map((one) => numbers(one));
  assert.deepEqual(a.map(([path]) => path), b.map(([path]) => path), what);
  const scale = Math.max(...a.map(([, value]) => Math.abs(value)), Number.MIN_VALUE);
  return Math.max(0, ...a.map(([, value], index) => Math.abs(value - b[index][1]) / scale));
}

/** Columns of the run in a page. */
function columns({ cranes }) {
  const { columns, rows, data } = cranes.at(-1).run;
  const numbers = new Float32Array(Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0)).buffer);
  return columns.map(({ name }, index) => ({ name, values: [...numbers.subarray(index * rows, (index + 1) * rows)] }));
}

/** Largest difference of a run from that in the report that the command writes. */
async function differenceOfRun(ask, spec) {
  const folder = await mkdtemp(join(tmpdir(), "crane-"));
  const report = join(folder, "report.html");
  const { status, stderr } = spawnSync(command, ["report", spec, "--duration", `${DURATION}`, "-o", report], { encoding: "utf8" });
  assert.equal(status, 0, stderr);
  const [, written] = /<script [^>]*id="data"[^>]*>(.*?)<\/script>/s.exec(await readFile(report, "utf8"));
  await rm(folder, { recursive: true });
  const [own, native] = [ask({ ask: "run", duration: DURATION }), JSON.parse(written)].map(columns);
  assert.deepEqual(own.map(({ name }) => name), native.map(({ name }) => name));
  const off = own.map(({ name, values }, index) => [difference(values, native[index].values, name), name]);
  // The error of the energy balance is a small difference of large numbers.
  return off.filter(([, name]) => name !== "energy_balance").reduce((worst, one) => (one[0] > worst[0] ? one : worst));
}

const begin = performance.now();
const ask = await start(wasm);
const files = (await readdir(SPECS)).filter((name) => name.endsWith(".yaml"));
assert(files.length >= 9, "all shipped cranes");
for (const file of files) {
  const text = await readFile(join(SPECS, file), "utf8");
  const opened = ask({ ask: "open", name: file, text });
  assert.equal(`${opened.name}.yaml`, file, JSON.stringify(opened.diagnostics));
  const rest = ask({ ask: "rest" });
  const native = crane(["statics", join(SPECS, file), "--format", "json"]);
  delete native.history;
  let worst = 0;
  for (const [key, table] of Object.entries(native)) {
    // How far the last step of Newton's method came is rounding.
    if (key === "cranes") continue;
    const off = difference(rest.results[key], table, `${file}: ${key}`);
    worst = Math.max(worst, off);
    assert(off <= SAME, `${file}: ${key} differs by ${off}`);
  }
  const vibrations = crane(["modes", join(SPECS, file), "--format", "json"]).undamped;
  const frequencies = rest.cranes[0].modes.map(({ frequency }) => frequency);
  const off = difference(frequencies, vibrations.map(({ frequency }) => frequency), `${file}: frequencies`);
  assert(off <= SAME, `${file}: frequencies differ by ${off}`);
  const [ran, column] = await differenceOfRun(ask, join(SPECS, file));
  assert(ran <= SINGLE, `${file}: ${column} of its run differs by ${ran}`);
  console.log(`${basename(file, ".yaml")}: ${opened.coordinates} coordinates, statics to ${worst.toExponential(1)}, frequencies to ${off.toExponential(1)}, run to ${ran.toExponential(1)} (${column})`);
}

// Mistakes are those of the terminal, word for word.
const wrong = "format: 1\nname: x\nlinks:\n  - {name: a, joint: revolut, masss: 3}\n";
const { diagnostics, drawn } = ask({ ask: "open", name: "wrong.yaml", text: wrong });
const printed = crane(["check", "-", "--format", "json"], wrong);
assert.deepEqual(diagnostics.map(({ file, ...one }) => one), printed.diagnostics.map(({ file, ...one }) => one));
assert(drawn.includes("wrong.yaml:4") && diagnostics.length >= 2, drawn);
console.log(`numbers agree with ${command}, ${((performance.now() - begin) / 1000).toFixed(0)} s`);
