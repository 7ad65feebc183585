// Compares numbers of the engine with those of the command: `node instrument/numbers.js ENGINE.wasm CRANE`, where CRANE is the command.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtemp, readFile, readdir, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { fileURLToPath } from "node:url";
import { readable } from "../src/data.js";
import { lessons } from "./lessons.js";
import { start } from "./process.js";

const [wasm, command] = process.argv.slice(2);
const SPECS = fileURLToPath(new URL("../../../specs", import.meta.url));

/** Largest difference, relative to the largest number of a table: the same operations in the same order, of which only those of the system's
 * mathematical library may round differently. */
const SAME = 1e-12;

/** Rounding of the numbers of runs, which pages hold in single precision; and what remains of it in a column of small differences. */
const SINGLE = 2 ** -24;
const CLOSE = 1e-6;
/**
 * Time from which runs of the page and of the command differ by more than this rounding, s: machine code rounds otherwise than the page's interpreter, and methods
 * with error control then choose other steps. From there on, both runs are as far from the true one as their errors say, and so is one from the other.
 */
const TOGETHER = 0.5;
/**
 * Largest difference of two such runs, relative to the sum of their printed errors. These are estimates, the difference from one finer run, which has an error of its
 * own: of the torsion of a jib of two_arms, where errors are as large as the numbers, runs differ by 1.8 of the sum; of the other two cranes by 0.2 and 0.6.
 */
const ESTIMATE = 2.5;
/** Cranes whose runs are compared at full length: those that part most, with loads that swing, feet that lift and beams that twist. The others take minutes. */
const LONG = ["knuckle_boom", "loader_tipping", "two_arms"];

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

/** Columns of the run in a page, with the errors that it prints. */
function columns({ cranes }) {
  const { run: { columns, rows, data }, record } = cranes.at(-1);
  const numbers = new Float32Array(Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0)).buffer);
  return columns.map(({ name }, index) => ({ name, values: [...numbers.subarray(index * rows, (index + 1) * rows)], error: record.differences_from_a_finer_run?.[name] ?? 0 }));
}

/**
 * Largest difference of a run from that in the report that the command writes: relative to the largest number of a column for a short run, and for a
 * long one relative to the errors that both print.
 */
async function differenceOfRun(ask, spec, duration) {
  const folder = await mkdtemp(join(tmpdir(), "crane-"));
  const report = join(folder, "report.html");
  const options = duration ? ["--duration", `${duration}`] : [];
  const { status, stderr } = spawnSync(command, ["report", spec, ...options, "-o", report], { encoding: "utf8" });
  assert.equal(status, 0, stderr);
  const [, written] = /<script [^>]*id="data"[^>]*>(.*?)<\/script>/s.exec(await readFile(report, "utf8"));
  await rm(folder, { recursive: true });
  const [own, native] = [ask({ ask: "run", duration }), JSON.parse(written)].map(columns);
  assert.deepEqual(own.map(({ name }) => name), native.map(({ name }) => name));
  const off = own.map(({ name, values, error }, index) => {
    const other = native[index];
    if (duration) return [difference(values, other.values, name), name];
    const size = Math.max(...values.map(Math.abs));
    const most = Math.max(...values.map((value, row) => Math.abs(value - other.values[row])));
    return [Math.max(0, most - 2 * SINGLE * size) / (error + other.error || Number.MIN_VALUE), name];
  });
  // The error of the energy balance is a small difference of large numbers.
  return off.filter(([, name]) => name !== "energy_balance").reduce((worst, one) => (one[0] > worst[0] ? one : worst));
}

/** What the page's script writes of a number has the digits that the command prints. */
function digits({ grids }, what) {
  let count = 0;
  for (const { key, rows, exact, numeric } of grids) {
    rows.forEach((row, index) => row.forEach((text, column) => {
      const all = exact[index][column];
      if (!numeric[column] || all === "") return;
      count += 1;
      assert.equal(readable(Number(all)), text, `${what}: ${key}, ${all}`);
    }));
  }
  assert(count > 0, what);
}

const begin = performance.now();
const ask = await start(wasm);
const shipped = (await readdir(SPECS)).filter((name) => name.endsWith(".yaml")).map((name) => join(SPECS, name));
assert(shipped.length >= 9, "all shipped cranes");
const folder = await mkdtemp(join(tmpdir(), "crane-"));
const taught = await Promise.all((await lessons()).map(async ({ name, text }) => {
  await writeFile(join(folder, name), text);
  return join(folder, name);
}));
assert.equal(taught.length, 8, "all lessons");
for (const path of [...shipped, ...taught]) {
  const file = basename(path);
  const text = await readFile(path, "utf8");
  const opened = ask({ ask: "open", name: file, text });
  assert.equal(`${opened.name}.yaml`, file, JSON.stringify(opened.diagnostics));
  const rest = ask({ ask: "rest" });
  digits(rest.tables, file);
  const native = crane(["statics", path, "--format", "json"]);
  delete native.history;
  // The page, which answers while one types, does not compute a second mesh.
  delete native.changes_of_positions_with_twice_the_sections;
  let worst = 0;
  for (const [key, table] of Object.entries(native)) {
    // How far the last step of Newton's method came is rounding.
    if (key === "cranes") continue;
    const off = difference(rest.results[key], table, `${file}: ${key}`);
    worst = Math.max(worst, off);
    assert(off <= SAME, `${file}: ${key} differs by ${off}`);
  }
  const vibrations = crane(["modes", path, "--format", "json"]).undamped;
  const frequencies = ask({ ask: "modes" }).modes.map(({ frequency }) => frequency);
  const off = difference(frequencies, vibrations.map(({ frequency }) => frequency), `${file}: frequencies`);
  assert(off <= SAME, `${file}: frequencies differ by ${off}`);
  const [ran, column] = await differenceOfRun(ask, path, TOGETHER);
  assert(ran <= CLOSE, `${file}: ${column} of its run differs by ${ran}`);
  if (LONG.includes(basename(file, ".yaml"))) {
    const [far, worst] = await differenceOfRun(ask, path, null);
    assert(far <= ESTIMATE, `${file}: ${worst} of its whole run differs by ${far} of the errors that both print`);
    console.log(`${basename(file, ".yaml")}: the whole run to ${far.toFixed(2)} of the printed errors (${worst})`);
  }
  console.log(`${basename(file, ".yaml")}: ${opened.coordinates} coordinates, statics to ${worst.toExponential(1)}, frequencies to ${off.toExponential(1)}, run to ${ran.toExponential(1)} (${column})`);
}
await rm(folder, { recursive: true });

// Mistakes are those of the terminal, word for word.
const wrong = "format: 1\nname: x\nlinks:\n  - {name: a, joint: revolut, masss: 3}\n";
const { diagnostics, drawn } = ask({ ask: "open", name: "wrong.yaml", text: wrong });
const printed = crane(["check", "-", "--format", "json"], wrong);
assert.deepEqual(diagnostics.map(({ file, ...one }) => one), printed.diagnostics.map(({ file, ...one }) => one));
assert(drawn.includes("wrong.yaml:4") && diagnostics.length >= 2, drawn);
console.log(`numbers agree with ${command}, ${((performance.now() - begin) / 1000).toFixed(0)} s`);
