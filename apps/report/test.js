// The page as a browser shows it: `node test.js PAGE [CSV …]`. The CSV files are those of the page's runs; without them,
// values are not compared. Pictures are written next to the page.
import assert from "node:assert/strict";
import { readFile, stat } from "node:fs/promises";
import { basename, resolve } from "node:path";
import { PATIENCE, launch } from "./browser.js";

/** Rounding to 32 bits, and once more to the shortest text that reads back as the same. */
const ROUNDING = 2 * 2 ** -24;
/** Smallest 32-bit number with full precision. */
const LEAST = 2 ** -126;
/** Rounding to the four digits shown. */
const SHOWN = 0.51e-3;
/** Maximum size of a page, bytes, so that it can be mailed. */
const MOST_BYTES = 6e6;

const [file, ...csvFiles] = process.argv.slice(2).map((path) => resolve(path));
const picture = (name) => file.replace(/\.html$/, `_${name}.png`);

/** Columns of a CSV text by their header. */
function columns(text) {
  const [header, ...rows] = text.trim().split("\n").map((line) => line.split(","));
  return new Map(header.map((name, i) => [name, rows.map((row) => Number(row[i]))]));
}

/** Longest wait for something to be drawn, ms. */
const MOMENT = 20_000;

/** Opens the page; `check` examines it; messages and network requests are returned as errors. */
async function open(browser, options, check) {
  const context = await browser.newContext({ offline: true, reducedMotion: "reduce", acceptDownloads: true, ...options });
  const page = await context.newPage();
  // Software rendering on a busy machine.
  page.setDefaultTimeout(PATIENCE);
  const said = [];
  // Those on reading pixels concern this test and the browser without a graphics card, not the page.
  page.on("console", (message) => /getImageData|due to ReadPixels/.test(message.text()) || said.push(`${message.type()}: ${message.text()}`));
  page.on("pageerror", (error) => said.push(`error: ${error.stack}`));
  page.on("request", (request) => {
    if (!/^(file|data|blob):/.test(request.url())) said.push(`request: ${request.url()}`);
  });
  await page.goto(`file://${file}`);
  await page.waitForFunction(() => document.documentElement.dataset.ready === "yes", null, { timeout: PATIENCE });
  await check(page);
  await context.close();
  return said;
}

const seek = async (page, t) => {
  await page.evaluate((time) => globalThis.report.player.seek(time), t);
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
};

/** Repeats a check until it passes: drawing takes as long as the machine needs. */
async function eventually(page, check) {
  for (const begin = Date.now(); ; ) {
    try {
      return await check();
    } catch (error) {
      if (Date.now() - begin > MOMENT) throw error;
      await page.waitForTimeout(50);
    }
  }
}

async function download(page, act, encoding = "utf8") {
  const [given] = await Promise.all([page.waitForEvent("download"), act()]);
  return readFile(await given.path(), encoding);
}

/** Every panel has curves, and a value with a unit for each. */
async function panels(page) {
  const ids = await page.$$eval("figure.panel", (figures) => figures.map(({ id }) => id));
  assert(ids.length >= 4, `${ids}`);
  for (const id of ids) {
    await page.locator(`#${id}`).scrollIntoViewIfNeeded();
    await eventually(page, async () => {
      const seen = await page.$eval(`#${id}`, (figure, id) => {
        const canvas = figure.querySelector("canvas");
        const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
        let coloured = 0;
        // Axes and text are grey; curves are not.
        for (let i = 0; i < data.length; i += 4) {
          if (data[i + 3] > 128 && Math.max(data[i], data[i + 1], data[i + 2]) - Math.min(data[i], data[i + 1], data[i + 2]) > 60) coloured += 1;
        }
        const along = figure.classList.contains("along");
        // Points that are far apart and hardly move have short paths: what is drawn of the longest one, pixels.
        const extent = (numbers) => Math.max(...numbers) - Math.min(...numbers);
        const drawn = ({ kind, curves, plot: { bbox, scales } }) =>
          kind === "path" ? (Math.max(...curves.flatMap(({ x, values }) => [extent(x), extent(values)])) * bbox.width) / (scales.x.max - scales.x.min) : Infinity;
        const shown = globalThis.report.plots.find((one) => one.id === id);
        const values = [...figure.querySelectorAll(".u-series:not(:first-child) .u-value")].map((value) => value.textContent);
        return { coloured, length: shown ? drawn(shown) : Infinity, values: along ? [] : values, isRatio: shown?.y.unit === "1" };
      }, id);
      assert(seen.coloured > Math.min(100, seen.length / 2), `${id}: no curve (${seen.coloured} pixels of ${seen.length})`);
      // A ratio has no unit.
      for (const value of seen.values) assert.match(value, seen.isRatio ? /^-?[\d.e-]+$/ : /^-?[\d.,e\s-]+ \S/, `${id}: ${value}`);
    });
  }
  return ids;
}

/** Values shown at some times are those of the CSV files. */
async function values(page, files) {
  const [main] = files;
  const { t, drives, points, crane } = await page.evaluate(() => {
    const { crane } = globalThis.report.data;
    return { t: [...crane.run.t], crane: crane.name, drives: crane.drives.map((j) => crane.coordinates[j]), points: crane.scene.points.map(({ name }) => name) };
  });
  assert.equal(basename(csvFiles[0]), `${crane}.csv`);
  const buttons = ["#all", "#all_rigid"];
  for (const [index, columnsOfFile] of files.entries()) {
    const given = columns(await download(page, () => page.click(buttons[index])));
    assert.deepEqual([...given.keys()], [...columnsOfFile.keys()]);
    for (const [name, exact] of columnsOfFile) {
      given.get(name).forEach((value, row) => {
        assert(Math.abs(value - exact[row]) <= ROUNDING * Math.abs(exact[row]) + LEAST, `${name}, row ${row}: ${value}, ${exact[row]}`);
      });
    }
  }
  for (const row of [0, 320, Math.floor(t.length / 2), t.length - 1]) {
    await seek(page, t[row]);
    for (const { name, force_unit: unit } of drives) {
      const effort = unit === "N" ? "force" : "torque";
      const plot = page.locator(`#drive_${name}`);
      await plot.scrollIntoViewIfNeeded();
      await eventually(page, async () => {
        const text = await plot.locator(".u-series").nth(1).locator(".u-value").textContent();
        const [number, ...shown] = text.split(" ");
        const exact = main.get(`${name}_drive_${effort} [${unit}]`)[row];
        const value = Number(number) * (shown.join(" ") === `k${unit}` ? 1e3 : 1);
        // Below 1e-10 of a unit the page says 0.
        assert(Math.abs(value - exact) <= SHOWN * Math.abs(exact) + 1e-7, `${name} at ${t[row]} s: ${text}, ${exact} ${unit}`);
      });
    }
    const drawn = await page.evaluate(() => {
      const { viewer } = globalThis.report;
      viewer.set({ factor: 1 });
      return viewer.figure.kinematics.points.map((_, index) => viewer.figure.kinematics.point(index).toArray());
    });
    points.forEach((name, index) => ["x", "y", "z"].forEach((axis, i) => {
      const exact = main.get(`${name}_${axis} [m]`)[row];
      // Coordinates of 32 bits on a crane of 10 m: some 1e-6 m.
      assert(Math.abs(drawn[index][i] - exact) < 5e-6, `${name}_${axis} at ${t[row]} s is drawn at ${drawn[index][i]}, is at ${exact}`);
    }));
  }
}

/** The picture of the crane moves with time, with a mode, with exaggeration. */
async function moves(page) {
  await page.evaluate(() => scrollTo(0, 0));
  const look = async (t) => {
    await seek(page, t);
    // Pictures differ in what they show, not in their detail.
    await page.waitForFunction(() => !globalThis.report.viewer.moves);
    return page.locator("#view canvas").screenshot();
  };
  const duration = await page.evaluate(() => globalThis.report.player.duration);
  const moving = await page.evaluate(() => globalThis.report.data.crane.run.column("kinetic_energy").values.some((value) => value > 1e-9));
  const still = await look(0);
  if (moving) await eventually(page, async () => assert(!still.equals(await look(duration / 2)), "the crane does not move"));
  const modes = await page.locator("#mode option").count();
  if (modes > 1) {
    await page.selectOption("#mode", "0");
    await page.evaluate(() => globalThis.report.player.play(false));
    const rest = await look(0);
    await eventually(page, async () => assert(!rest.equals(await look(duration / 16 + 0.1)), "the mode does not move"));
    await page.selectOption("#mode", "");
    await page.evaluate(() => globalThis.report.player.play(false));
  }
  await seek(page, 0);
  await page.click("#play");
  await page.waitForFunction(() => globalThis.report.player.t > 0.05);
  await page.keyboard.press("Space");
  assert.equal(await page.evaluate(() => globalThis.report.player.playing), false, "the play button has the focus: space pauses");
}

/** A run plays once and rests, without a picture of the crane at rest in between and out of sight without any; counts, no times. */
async function rests(page) {
  await page.evaluate(() => {
    scrollTo(0, 0);
    const { viewer, player } = globalThis.report;
    const paint = viewer.paint.bind(viewer);
    globalThis.painted = [];
    viewer.paint = () => {
      paint();
      globalThis.painted.push({ level: viewer.level, playing: player.playing, triangles: viewer.renderer.info.render.triangles, calls: viewer.renderer.info.render.calls });
    };
  });
  const { soft, duration } = await page.evaluate(() => ({ soft: globalThis.report.viewer.soft, duration: globalThis.report.player.duration }));
  if (!duration) return;
  const settled = () => page.waitForFunction(() => !globalThis.report.viewer.moves && !globalThis.report.player.playing);
  const frames = () => page.evaluate(() => globalThis.painted.length);
  await settled();
  const length = Math.min(1.5, duration);
  await page.evaluate((from) => {
    const { player } = globalThis.report;
    globalThis.painted = [];
    player.seek(from);
    player.play(true);
  }, duration - length);
  await page.waitForFunction(() => globalThis.painted.some(({ playing }) => playing));
  // Longer than a crane must be still to be drawn as one at rest.
  await page.evaluate(() => {
    const { viewer } = globalThis.report;
    clearTimeout(viewer.quiet);
    viewer.settle();
  });
  await settled();
  await eventually(page, async () => assert.equal((await page.evaluate(() => globalThis.painted.at(-1))).level, 0, "at rest with all detail"));
  const painted = await page.evaluate(() => globalThis.painted);
  const playing = painted.filter((one) => one.playing);
  assert(playing.length > 0);
  if (soft) {
    const { calls } = painted.at(-1);
    for (const one of playing) assert(one.level >= 1 && one.calls < calls, `${JSON.stringify(one)} in a motion, at rest ${calls} calls`);
  }
  assert.equal(await page.evaluate(() => globalThis.report.player.t), duration, "it plays once");
  const still = await frames();
  await page.waitForTimeout(700);
  assert.equal(await frames(), still, "at rest nothing is drawn");
  // Out of sight.
  await page.evaluate(() => scrollTo(0, document.documentElement.scrollHeight));
  await page.waitForFunction(() => !globalThis.report.viewer.seen);
  const before = await frames();
  // The end of the run: it plays as fast as it is.
  await page.evaluate((from) => {
    const { player } = globalThis.report;
    player.seek(from);
    player.play(true);
  }, duration - length);
  await page.waitForFunction((from) => globalThis.report.player.t > from, duration - length);
  await settled();
  assert.equal(await frames(), before, "nothing is drawn out of sight");
  await page.evaluate(() => scrollTo(0, 0));
  await eventually(page, async () => assert((await frames()) > before, "what has changed is drawn when it comes into sight"));
}

/** Zoom by keys, cursor by keys, SVG with units. */
async function plots(page) {
  const figure = page.locator("#balance");
  await figure.focus();
  const span = () => page.evaluate(() => {
    const { min, max } = globalThis.report.plots.find(({ id }) => id === "balance").plot.scales.x;
    return max - min;
  });
  const whole = await span();
  await page.keyboard.press("+");
  await eventually(page, async () => assert((await span()) < whole));
  await page.keyboard.press("0");
  await eventually(page, async () => assert.equal(await span(), whole));
  await page.keyboard.press("ArrowRight");
  await eventually(page, async () => {
    const index = await page.evaluate(() => globalThis.report.plots.find(({ id }) => id === "balance").plot.cursor.idx);
    assert(index > 0, `${index}`);
  });
  const svg = await download(page, () => figure.locator("button", { hasText: "SVG" }).click());
  const sound = await page.evaluate((text) => new DOMParser().parseFromString(text, "image/svg+xml").querySelector("parsererror") === null, svg);
  assert(sound && svg.includes("t [s]") && svg.includes("[J]") && svg.includes("<polyline"), svg.slice(0, 500));
  assert(!svg.includes("NaN"));
  const csv = columns(await download(page, () => figure.locator("button", { hasText: "CSV" }).click()));
  assert(csv.has("t [s]") && csv.size >= 2);
}

/** Utilisation is drawn on the beams and over time, margins if the crane has feet, and the page to sign has the hash of the spec. */
async function strength(page) {
  const { beams, lines, hash } = await page.evaluate(() => {
    const { crane } = globalThis.report.data;
    const { sections, stability } = crane.strength ?? {};
    return { beams: new Set(sections?.places.map(({ beam }) => beam)).size, lines: stability?.lines.length ?? 0, hash: crane.record.spec_hash };
  });
  assert.equal(await page.locator("#strength figure.along").count(), beams, "a plot along every beam");
  assert.equal(await page.locator("#margins").count(), Number(lines > 0), "margins over time");
  assert((await page.locator("#sign").textContent()).includes(hash));
  const painted = () => page.evaluate(() => globalThis.report.viewer.figure.beams.filter(({ mesh }) => mesh.material.vertexColors).length);
  assert.equal(await painted(), 0);
  if (!beams) return;
  await page.click("#used");
  assert.equal(await painted(), beams, "beams are coloured");
  await page.click("#used");
  assert.equal(await painted(), 0);
}

/** Cylinders are drawn as long as the run says, with rocker and link of their lengths, at some times. */
async function cylinders(page) {
  for (const share of [0, 0.37, 1]) {
    const row = await page.evaluate((share) => Math.round(share * (globalThis.report.data.crane.run.rows - 1)), share);
    await seek(page, await page.evaluate((row) => globalThis.report.data.crane.run.t[row], row));
    const drawn = await page.evaluate((row) => {
      const { viewer, data: { crane } } = globalThis.report;
      viewer.set({ factor: 1 });
      // Lengths of meshes of length 1.
      return viewer.figure.cylinders.map(({ rod, bars, data: { name, linkage } }) => {
        const exact = [crane.run.column(`${name}_length`).values[row], ...(linkage ? [linkage.rocker, linkage.link] : [])];
        return { name, exact, drawn: [rod, ...bars].map(({ scale }) => scale.y) };
      });
    }, row);
    for (const { name, exact, drawn: own } of drawn) {
      // Coordinates of 32 bits: some 1e-6 m.
      exact.forEach((length, i) => assert(Math.abs(own[i] - length) < 5e-6, `${name}: drawn ${own} m long, is ${exact} m`));
    }
  }
}

/** Each path has a dot at its point, in its colour; the tipping line is on the ground between two feet; pictures and films are files. */
async function marks(page) {
  const { paths, lines, feet, duration } = await page.evaluate(() => {
    const { data: { crane }, plots, viewer, player } = globalThis.report;
    const marked = plots.filter(({ kind }) => kind === "path").map(({ marks, curves }) => ({
      colours: marks.map((mark) => mark.style.background), curves: curves.length, colour: curves.map(({ colour }) => colour),
    }));
    const { start, end } = Object.fromEntries(["start", "end"].map((one) => [one, viewer.tipping.geometry.getAttribute(`instance${one === "start" ? "Start" : "End"}`)]));
    const ends = [start, end].map((one) => [one.getX(0), one.getY(0), one.getZ(0)]);
    const places = viewer.reactions.map(({ local }) => local.clone().applyMatrix4(viewer.figure.kinematics.frames[0]).toArray());
    const off = ends.map((end) => Math.min(...places.map((place) => Math.hypot(...place.map((x, i) => x - end[i])))));
    return { paths: marked, lines: crane.strength?.stability?.lines.length ?? 0, feet: viewer.tipping.visible ? off : null, duration: player.duration };
  });
  for (const { colours, curves, colour } of paths) {
    assert.equal(colours.length, curves, "a dot per path");
    assert.equal(new Set(colours).size, new Set(colour).size, `a colour per point: ${colours}`);
  }
  assert.equal(feet !== null, lines > 0, "a tipping line where there are margins");
  if (feet) assert(feet.every((off) => off < 1e-4), `the tipping line ends ${feet} m beside the feet`);
  const png = await download(page, () => page.click("#picture"), null);
  assert(png.length > 10_000 && png.subarray(1, 4).toString() === "PNG", "a picture of the view");
  // A film takes as long as the motion: the end of it will do, on one page.
  if (!csvFiles.length || !duration || !(await page.locator("#video").count())) return;
  const film = await download(page, async () => {
    await page.click("#video");
    await seek(page, duration - 3);
  }, null);
  assert(film.length > 1000, `a film of ${film.length} bytes`);
}

/** Paper is narrower than the screen: plots fit it, and nothing on it is folded. */
async function paper(page) {
  // In one call: this is not paper, and observed plots would take the screen's width again.
  const sizes = (after) => page.evaluate((after) => {
    if (after) dispatchEvent(new Event(after));
    return { widths: globalThis.report.plots.map(({ plot }) => plot.width), folded: document.querySelectorAll("details.table:not([open])").length };
  }, after);
  const screen = await sizes();
  const { widths, folded } = await sizes("beforeprint");
  assert(widths.every((width) => width <= 680), `${widths}`);
  assert.equal(folded, 0);
  assert.deepEqual(await sizes("afterprint"), screen, "as it was");
}

const begin = Date.now();
assert((await stat(file)).size < MOST_BYTES);
const text = await readFile(file, "utf8");
assert.match(text, /http-equiv="Content-Security-Policy" content="default-src 'none'/);
const browser = await launch({ swift: true });
let count = 0;
const said = await open(browser, { viewport: { width: 1440, height: 900 }, colorScheme: "light" }, async (page) => {
  await seek(page, (await page.evaluate(() => globalThis.report.player.duration)) * 0.32);
  await page.waitForFunction(() => !globalThis.report.viewer.moves);
  await page.screenshot({ path: picture("light") });
  count = (await panels(page)).length;
  if (csvFiles.length) {
    const files = await Promise.all(csvFiles.map(async (path) => columns(await readFile(path, "utf8"))));
    await values(page, files);
  }
  const { every, outlines } = await page.evaluate(() => {
    const { data, viewer } = globalThis.report;
    // Height and width of the first ring of a box, from its corners.
    const size = ({ array }) => [[1, 3], [0, 1]].map(([a, b]) => Math.hypot(...[0, 1, 2].map((i) => array[3 * a + i] - array[3 * b + i])));
    const boxed = data.crane.scene.beams.map((beam, index) => ({ ...beam, ...viewer.figure.beams[index] })).filter(({ round }) => !round);
    const drawn = boxed.map(({ along, geometry }) => ({ drawn: size(geometry.getAttribute("position")), spec: along[0].slice(1) }));
    return { every: data.crane.run.every, outlines: drawn };
  });
  assert.equal(await page.locator("#thinned").isVisible(), every > 1, "a thinned run says so");
  for (const { drawn, spec } of outlines) {
    // Corners are in single precision, some metres from the origin.
    spec.forEach((side, i) => assert(Math.abs(drawn[i] - side) < 1e-5, `a beam drawn ${drawn} m high and wide, ${spec} in the spec`));
  }
  await moves(page);
  await rests(page);
  await plots(page);
  await strength(page);
  await cylinders(page);
  await marks(page);
  await paper(page);
  assert((await page.$$eval("#tables table", (tables) => tables.filter((table) => table.rows.length > 1).length)) >= 3);
  assert((await page.locator("#repeat").textContent()).includes("hash of the spec"));
  await page.click("#theme");
  assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), "dark");
});
said.push(...(await open(browser, { viewport: { width: 1440, height: 900 }, colorScheme: "dark" }, async (page) => {
  assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), "dark");
  await page.waitForFunction(() => !globalThis.report.viewer.moves);
  await page.screenshot({ path: picture("dark") });
})));
const phone = { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true };
said.push(...(await open(browser, phone, async (page) => {
  const [width, screen] = await page.evaluate(() => [document.documentElement.scrollWidth, innerWidth]);
  assert(width <= screen, `the page is ${width} wide on a screen of ${screen}`);
  await page.waitForFunction(() => !globalThis.report.viewer.moves);
  await page.screenshot({ path: picture("phone") });
})));
assert.deepEqual(said, [], "the page says or asks for something");
// The reader sees what fails in the page.
const failures = await open(browser, { viewport: { width: 1000, height: 700 } }, async (page) => {
  assert.equal(await page.locator("#fault").isVisible(), false);
  await page.evaluate(() => setTimeout(() => { throw new Error("a mistake of the test"); }));
  await eventually(page, async () => assert.match(await page.locator("#fault").textContent(), /failed \(a mistake of the test\)/));
});
assert(failures.length === 1 && failures[0].includes("a mistake of the test"), failures.join("\n"));
await browser.close();

// Without 3-D, everything else is there.
const flat = await launch({ flat: true });
const complaints = await open(flat, { viewport: { width: 1000, height: 700 } }, async (page) => {
  assert.match(await page.locator("#view").textContent(), /3-D is not available/);
  assert.equal((await panels(page)).length, count);
});
assert(complaints.every((line) => !/^(error: (?!.*WebGL)|request)/.test(line)), complaints.join("\n"));
await flat.close();
console.log(`${basename(file)}: ${count} panels, ${(text.length / 1e6).toFixed(2)} MB, ${((Date.now() - begin) / 1000).toFixed(0)} s`);
