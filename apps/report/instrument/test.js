// Uses the instrument in a headless browser: `node instrument/test.js INSTRUMENT.html REPORT.html`; saves pictures next to it. The report, of the
// knuckle boom, links to the instrument.
import assert from "node:assert/strict";
import { readFile, stat } from "node:fs/promises";
import { dirname, join } from "node:path";
import { pathToFileURL } from "node:url";
import { deflateRawSync } from "node:zlib";
import { PATIENCE, launch } from "../browser.js";

const [file, report] = process.argv.slice(2);
const address = pathToFileURL(file).href;
const picture = (name) => join(dirname(file), `instrument_${name}.png`);

/** Largest size of the page: engine, 3-D, editor and examples. */
const MOST_BYTES = 4e6;
/** Times until the first crane is there, and from an edit to statics of 25 coordinates, ms: printed, since they are those of a machine that may be busy. */
const times = {};

const fragment = (text) => `#spec=${deflateRawSync(text).toString("base64url")}`;
const state = (page) => page.locator("#state").textContent();
const at = (page, expression, given) => page.evaluate(expression, given);

/** Waits until a check passes. */
async function eventually(page, check, patience = 20_000) {
  const end = Date.now() + patience;
  for (;;) {
    try {
      return await check();
    } catch (error) {
      if (Date.now() > end) throw error;
      await page.waitForTimeout(50);
    }
  }
}

/** Opens the page in a context of its own; fails on anything it says or asks for. */
async function open(browser, options, use, { hash = "", silent = true } = {}) {
  const context = await browser.newContext(options);
  const page = await context.newPage();
  page.setDefaultTimeout(PATIENCE);
  const said = [];
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && said.push(`${message.type()}: ${message.text()}`));
  page.on("pageerror", (error) => said.push(`error: ${error.message}`));
  page.on("dialog", (dialog) => {
    said.push(`dialog: ${dialog.message()}`);
    dialog.dismiss();
  });
  page.on("request", (request) => {
    if (!/^(blob|data):/.test(request.url()) && !request.url().startsWith(address)) said.push(`request: ${request.url()}`);
  });
  // Software rendering says that it is slow.
  const own = () => said.filter((line) => !/GPU stall|GL Driver Message/.test(line));
  await context.setOffline(true);
  const begin = Date.now();
  try {
    await page.goto(address + hash);
    await page.waitForSelector("html[data-ready]");
    await use(page, Date.now() - begin);
  } catch (error) {
    await page.screenshot({ path: picture("failed") }).catch(() => {});
    error.message += `\nthe page said: ${own().join("\n")}\nits state: ${await state(page).catch(() => "")}`;
    throw error;
  }
  if (silent) assert.deepEqual(own(), [], "the page says or asks for something");
  await context.close();
}

const example = async (page, name, crane = name.replaceAll(" ", "_")) => {
  await page.click("#new");
  await page.locator("#gallery .cards button").filter({ hasText: name.replaceAll(" ", "_") }).click();
  await eventually(page, async () => assert.equal(await at(page, () => globalThis.instrument.stage.crane?.name), crane));
  await eventually(page, async () => assert.match(await state(page), /^At rest/));
};

/** Waits until the page has read what is in the editor: what it says of it replaces other words, and fields are made anew. */
const settled = (page) => eventually(page, async () => assert(!(await at(page, () => globalThis.instrument.reading))));

/** Replaces text in the editor, as an edit would, and waits until the page has read it. */
const edit = async (page, from, to) => {
  await page.evaluate(([from, to]) => {
    const { view } = globalThis.instrument.editor;
    const found = view.state.doc.toString().indexOf(from);
    if (found < 0) throw new Error(`no ${from} in the spec`);
    view.dispatch({ changes: { from: found, to: found + from.length, insert: to } });
  }, [from, to]);
  await settled(page);
};

/** Edits: statics follow at once; mistakes are shown where they are, with their remedies. */
async function edits(page) {
  await example(page, "eight link flexible");
  const force = () => at(page, () => globalThis.instrument.atRest.results.drives.map(({ value }) => value));
  const before = await force();
  const took = [];
  for (let mass = 500; mass < 540; mass += 10) {
    await at(page, () => (globalThis.instrument.took = null));
    await edit(page, `value: ${mass}`, `value: ${mass + 10}`);
    await eventually(page, async () => assert(await at(page, () => globalThis.instrument.took)));
    took.push(await at(page, () => globalThis.instrument.took));
  }
  times.edit = Math.round(Math.min(...took));
  assert.notDeepEqual(await force(), before, "statics of the edited spec");
  await edit(page, "stiffness:", "stifness:");
  await eventually(page, async () => assert.match(await state(page), /mistake/));
  const problem = page.locator("#problems li.error").first();
  const text = await problem.textContent();
  assert(/unknown key `stifness`/.test(text) && /\[E010\]/.test(text) && /stiffness/.test(text), text);
  const [line] = /^(\d+):/.exec(text).slice(1);
  await problem.locator("button").click();
  const here = await at(page, () => {
    const { view } = globalThis.instrument.editor;
    return view.state.doc.lineAt(view.state.selection.main.head).number;
  });
  assert.equal(here, Number(line), "a click goes to the mistake");
  assert((await page.locator("#editor .cm-lintRange-error").count()) > 0, "it is underlined");
  await edit(page, "stifness:", "stiffness:");
  await eventually(page, async () => assert.match(await state(page), /^At rest/));
}

/** Completion and help come from the schema. */
async function schema(page) {
  await at(page, () => {
    const { editor: { view } } = globalThis.instrument;
    view.dispatch({ changes: { from: view.state.doc.length, insert: "\nru" }, selection: { anchor: view.state.doc.length + 3 } });
    view.focus();
  });
  await page.keyboard.type("n");
  const list = page.locator("#editor .cm-tooltip-autocomplete");
  await list.waitFor();
  assert.match(await list.textContent(), /run/);
  await page.keyboard.press("Escape");
  await at(page, () => {
    const { editor: { view } } = globalThis.instrument;
    const { length } = view.state.doc;
    view.dispatch({ changes: { from: length - 4, to: length, insert: "" }, selection: { anchor: 0 }, scrollIntoView: true });
  });
  await page.locator("#editor .cm-content").getByText("links", { exact: true }).first().hover();
  await page.locator("#editor .cm-help").waitFor();
  await eventually(page, async () => assert.match(await state(page), /^At rest/));
  // The key of a choice, a word for it, and names as keys.
  const { key, word, names } = await at(page, () => {
    const { editor } = globalThis.instrument;
    const { schema } = editor;
    const text = "damping:\n  ";
    const from = { state: editor.view.state.update({ changes: { from: 0, to: editor.view.state.doc.length, insert: text } }).state, pos: text.length, explicit: true };
    return { key: schema.about(["links", "[]", "joint", "revolute"]), word: schema.values(["links", "[]", "joint"]).get("revolute"), names: editor.complete(from).options.map(({ label }) => label) };
  });
  assert.match(key, /Rotates about its axis/);
  assert.equal(word, key);
  assert(names.includes("boom_psi"), names.join());
  // Every key of the examples is found, and has a description; those of overlays are not in the schema.
  const lacking = await at(page, () => {
    const { editor: { schema }, context } = globalThis.instrument;
    const found = [];
    for (const { name, text } of JSON.parse(document.querySelector("#given").textContent).examples) {
      let begin = 0;
      for (const line of text.split("\n")) {
        const code = line.replace(/(^|\s)#.*$/, "").replace(/"[^"]*"|'[^']*'/g, (quoted) => " ".repeat(quoted.length));
        for (const { index, 1: key } of code.matchAll(/(?<![\w.`])([A-Za-z_]\w*):(?=\s|$)/g)) {
          const { path, key: isKey } = context(text, begin + index);
          if (!isKey || !schema.about([...path, key])) found.push(`${name}: ${[...path, key].join(".")}`);
        }
        begin += line.length + 1;
      }
    }
    return found;
  });
  assert.deepEqual(lacking.filter((one) => !/\.(after|remove)$/.test(one)), []);
}

/** Warnings are in the line under the crane, and on a phone at the tab of the spec. */
async function warnings(page, phone) {
  await example(page, "knuckle boom");
  const badge = page.locator("#tab_spec .badge");
  assert.equal(await badge.isVisible(), false);
  await edit(page, "mass: 420", "mass: 420000");
  await eventually(page, async () => assert.match(await state(page), /^At rest.* · 1 warning · /));
  assert.equal(await page.locator("#state").getAttribute("class"), "warned");
  assert.equal(await badge.isVisible(), phone);
  assert.equal(await badge.textContent(), "1");
  await edit(page, "mass: 420000", "mass: 420");
  await eventually(page, async () => assert.doesNotMatch(await state(page), /warning/));
  await eventually(page, async () => assert.equal(await page.locator("#state").getAttribute("class"), ""));
}

/** A new crane, and the pictures of the examples; the browser's way back leads to the spec before, as it was left. */
async function start(page) {
  await example(page, "knuckle boom");
  await edit(page, "mass: 420", "mass: 430");
  await eventually(page, async () => assert.match(await state(page), /^At rest/));
  await page.click("#new");
  const cards = page.locator("#gallery .cards button");
  const shown = await cards.evaluateAll((all) => all.map((card) => ({ open: card.ariaCurrent, drawn: card.querySelector("img")?.naturalWidth })));
  assert.equal(shown.length, 22);
  // The first card and the eight lessons have no picture; the knuckle boom is open.
  assert(shown.every(({ drawn }, index) => (index && index < 14 ? drawn > 0 : drawn === undefined)), JSON.stringify(shown));
  assert.deepEqual(shown.flatMap(({ open }, index) => (open ? [index] : [])), [1]);
  await page.screenshot({ path: picture("gallery") });
  await cards.first().click();
  await eventually(page, async () => assert.equal(await at(page, () => globalThis.instrument.crane.name), "new_crane"));
  await eventually(page, async () => assert.match(await state(page), /^At rest: [^·]* · 2 coordinates/));
  assert.equal(await page.locator("#problems li").count(), 0);
  // (250 kg at 2 m and 500 kg at 4 m) g cos ψ, held by 2e6 N m/rad from -20°: the torque is that of the spring.
  const { positions, torque } = await at(page, () => {
    const { results, rest } = globalThis.instrument.atRest;
    return { positions: rest.q, torque: results.drives[1].value };
  });
  assert(Math.abs(torque + (250 * 2 + 500 * 4) * 9.81 * Math.cos(positions[1])) < 1e-6 * Math.abs(torque), `${torque} N m at ${positions[1]}`);
  await page.goBack();
  await eventually(page, async () => assert.equal(await at(page, () => globalThis.instrument.crane.name), "knuckle_boom"));
  assert.match(await at(page, () => globalThis.instrument.editor.text), /mass: 430/);
  await page.goForward();
  await eventually(page, async () => assert.equal(await at(page, () => globalThis.instrument.crane.name), "new_crane"));
  await eventually(page, async () => assert.match(await state(page), /^At rest/));
  // Whole entries of lists are parts of a crane.
  const insert = (list) => at(page, (list) => {
    const { editor } = globalThis.instrument;
    const { view } = editor;
    const { index, 0: { length } } = view.state.doc.toString().match(new RegExp(`^${list}:.*\n`, "m"));
    view.dispatch({ changes: { from: index + length, insert: "  \n" } });
    const pos = index + length + 2;
    const [entry] = editor.complete({ state: view.state, pos, explicit: true }).options;
    entry.apply(view, entry, pos, pos);
    return entry.label;
  }, list);
  const rests = (check) => eventually(page, async () => {
    assert(await at(page, check));
    assert.match(await state(page), /^At rest/);
  });
  assert.deepEqual([await insert("links"), await insert("points"), await insert("drives")], ["link", "point", "drive"]);
  await edit(page, "coordinate: coordinate", "coordinate: link_theta");
  await rests(() => globalThis.instrument.crane.drives.length === 3 && globalThis.instrument.crane.points.length === 2);
  // What a key that is missing would be.
  await edit(page, "    mass: 300\n", "");
  await eventually(page, async () => assert.match(await page.textContent("#problems"), /has `com` but no mass.*mass: Mass\. In kg, above 0\./s));
  await example(page, "loader tipping");
  assert.equal(await insert("supports"), "support");
  await rests(() => globalThis.instrument.stage.crane.scene.supports.length === 5);
}

/** A click on a part names it, says what is known of it, and leads to its lines in the spec. */
async function parts(page, phone) {
  await example(page, "knuckle boom");
  await page.getByRole("tab", { name: "At rest" }).click();
  // Where the page shows the middle of the way from one frame to another, by the frames that the engine gives.
  const middle = (from, to) => at(page, ([from, to]) => {
    const { viewer, crane } = globalThis.instrument.stage;
    const origin = (name) => viewer.figure.kinematics.frames[crane.scene.bodies.findIndex(({ link }) => link === name)].elements.slice(12, 15);
    const place = viewer.camera.position.clone().set(...origin(from).map((x, i) => (x + origin(to)[i]) / 2)).project(viewer.camera);
    const { left, top, width, height } = viewer.canvas.getBoundingClientRect();
    return [left + ((place.x + 1) / 2) * width, top + ((1 - place.y) / 2) * height];
  }, [from, to]);
  const tap = async (place) => (phone ? page.touchscreen.tap(...place) : page.mouse.click(...place));
  const seen = () => at(page, () => [globalThis.instrument.parts.part?.name ?? null, document.querySelector("#part output").textContent]);
  await tap(await middle("main_boom", "knuckle"));
  const [name, words] = await seen();
  assert.equal(name, "main_boom");
  const angle = await at(page, () => globalThis.instrument.atRest.rest.q[0]);
  assert.equal(words.replace("−", "-"), `420 kg · main boom theta ${((angle * 180) / Math.PI).toPrecision(4)} °`);
  const marked = await at(page, () => [...globalThis.instrument.stage.viewer.figure.marked].every(({ userData }) => userData.part.name === "main_boom"));
  assert(marked, "only the part is marked");
  await page.screenshot({ path: picture(phone ? "phone_part" : "part") });
  await page.getByRole("button", { name: "In the spec", exact: true }).click();
  const line = await at(page, () => {
    const { state } = globalThis.instrument.editor.view;
    return state.doc.lineAt(state.selection.main.head).text;
  });
  assert.match(line, /- name: main_boom/);
  if (phone) await page.getByRole("tab", { name: "At rest" }).click();
  // The mark stays while the crane changes; what is known of the part follows.
  await page.locator("#part select").selectOption({ label: "hook" });
  const payload = page.locator("#sliders input.number").first();
  await payload.fill("650");
  await eventually(page, async () => assert.match((await seen())[1], /^675 kg/));
  // Beside the crane there is none.
  const { left, top } = await at(page, () => document.querySelector("#view canvas").getBoundingClientRect().toJSON());
  await tap([left + 3, top + 120]);
  assert.deepEqual(await seen(), [null, ""]);
  // What the picture shows stays so for the next crane, and the picture is a file.
  await page.locator("#looks summary").click();
  await page.locator("#factor").fill("1");
  await page.locator("[data-look=arrows]").uncheck();
  await page.locator("[data-look=use]").check();
  assert.match(await at(page, () => document.querySelector("#looks b").textContent), /stress|utilisation|no beam/);
  await page.screenshot({ path: picture(phone ? "phone_looks" : "looks") });
  const download = page.waitForEvent("download");
  await page.locator("#picture").click();
  assert.match((await download).suggestedFilename(), /^knuckle_boom\.png$/);
  await page.locator("#looks summary").click();
  const look = () => at(page, () => {
    const { factor, arrows, use } = globalThis.instrument.stage.viewer;
    return { factor, arrows, use };
  });
  assert.deepEqual(await look(), { factor: 10, arrows: false, use: true });
  // Sliders become numbers of the spec, where it has one for them.
  await page.getByRole("button", { name: "Into the spec" }).click();
  await eventually(page, async () => assert.match(await at(page, () => globalThis.instrument.editor.text), /payload: \{value: 650, unit: kg/));
  await eventually(page, async () => assert.deepEqual(await at(page, () => globalThis.instrument.rest.state), { parameters: {}, positions: {} }));
}

/** A link keeps what is shown: sliders, tab, chart, part, and where the crane is seen from; so does a reload. */
async function shown(browser) {
  const wide = { viewport: { width: 1280, height: 800 }, acceptDownloads: true };
  const what = (page) => at(page, () => {
    const { rest, chart, parts: { part }, stage: { viewer: { view, camera, controls } } } = globalThis.instrument;
    // In a lower picture the camera is as much farther away.
    const towards = camera.position.clone().sub(controls.target).normalize();
    const from = view ?? [...towards, ...controls.target].map((number) => number.toFixed(3));
    return { ...rest.state, chart: chart.chosen, part, tab: document.documentElement.dataset.tab, from, duration: document.querySelector("#duration").value };
  });
  const [link, before] = await new Promise((done, fail) => {
    open(browser, wide, async (page) => {
      await page.locator("#sliders input.number").first().fill("650");
      await page.locator("#sliders input.number").nth(1).fill("-30");
      await page.getByRole("tab", { name: "Load chart" }).click();
      await page.locator("#asked input[aria-label='how many']").first().fill("7");
      await at(page, () => (document.querySelector("#duration").value = "2.5"));
      await page.locator("#part select").selectOption({ label: "knuckle" });
      await page.locator("#view canvas").focus();
      await page.mouse.move(900, 200);
      await page.mouse.down();
      await page.mouse.move(960, 190, { steps: 3 });
      await page.mouse.up();
      await eventually(page, async () => assert.equal((await what(page)).parameters.payload, 650));
      await page.click("#share");
      await eventually(page, async () => assert.match(await at(page, () => location.hash), /^#spec=.*&shown=/));
      const before = await what(page);
      assert.equal(before.from.length, 6);
      assert.equal(before.positions.main_boom_theta, -Math.PI / 6);
      await page.reload();
      await page.waitForSelector("html[data-ready]");
      assert.deepEqual(await what(page), before);
      done([await at(page, () => location.hash), before]);
    }).catch(fail);
  });
  await open(browser, wide, async (page) => {
    assert.deepEqual(await what(page), before);
    await eventually(page, async () => assert.match(await state(page), /^At rest/));
  }, { hash: link });
  // What no page has written changes nothing.
  const packed = (text) => deflateRawSync(text).toString("base64url");
  const { hash } = new URL(`${address}${link}`);
  for (const wrong of [packed("[1]"), packed("{"), "!", packed(JSON.stringify({ tab: "x", parameters: [], positions: 3, chart: { axes: [[1]] }, part: {}, seenFrom: [1e300, 0, 0, 0, 0, 0, "a"], duration: -1 }))]) {
    await open(browser, wide, async (page) => {
      const found = await what(page);
      assert.deepEqual([found.parameters, found.part, found.tab, found.from], [{}, null, "rest", "corner"]);
    }, { hash: `${hash.split("&")[0]}&shown=${wrong}` });
  }
}

/** Statics are shown before modes are asked for, and sliders that move ask for none. */
async function first(page) {
  await example(page, "knuckle boom");
  await eventually(page, async () => assert.equal(await page.locator("#rest_tiles .later:not(.old)").count(), 1));
  await at(page, () => {
    const { engine } = globalThis.instrument;
    const ask = engine.ask.bind(engine);
    globalThis.asked = [];
    engine.ask = (request, ...more) => {
      globalThis.asked.push([request.ask, document.querySelector("#state").textContent]);
      return ask(request, ...more);
    };
  });
  const slider = page.locator("#sliders input[type=range]").first();
  await slider.evaluate(async (one) => {
    for (let step = 1; step <= 5; step += 1) {
      one.value = 800 + 40 * step;
      one.dispatchEvent(new Event("input"));
      await new Promise(requestAnimationFrame);
    }
  });
  await eventually(page, async () => assert((await at(page, () => globalThis.asked)).some(([ask]) => ask === "modes")));
  const asked = (await at(page, () => globalThis.asked)).map(([ask]) => ask);
  assert.equal(asked.at(-1), "modes", asked.join());
  assert(asked.filter((one) => one === "modes").length === 1 && asked.filter((one) => one === "rest").length >= 1, asked.join());
  await eventually(page, async () => assert.equal(await page.locator("#rest_tiles .later:not(.old)").count(), 1));
  await at(page, () => delete globalThis.instrument.engine.ask);
  await page.getByRole("button", { name: "As in the spec" }).click();
  await eventually(page, async () => assert.equal(await at(page, () => globalThis.instrument.rest.parameters[0]), 800));
}

/** Sliders move the crane and its numbers. */
async function sliders(page) {
  await example(page, "knuckle boom");
  const torque = () => at(page, () => globalThis.instrument.stage.crane.run.list.map(({ values }) => values[0]));
  const before = await torque();
  const slider = page.locator("#sliders input[type=range]").first();
  await slider.focus();
  for (let press = 0; press < 5; press += 1) await page.keyboard.press("ArrowRight");
  await eventually(page, async () => assert.notDeepEqual(await torque(), before));
  const moved = await torque();
  const angle = page.locator("#sliders fieldset:last-of-type input.number").first();
  await angle.fill("33");
  await eventually(page, async () => {
    assert.notDeepEqual(await torque(), moved);
    const positions = await at(page, () => globalThis.instrument.atRest.rest.drives);
    assert(Math.abs(positions[0] - (33 * Math.PI) / 180) < 1e-4, `${positions}`);
  });
  await page.getByRole("button", { name: "As in the spec" }).click();
  await eventually(page, async () => assert.deepEqual(await torque(), before));
  await units(page);
}

/** Fields take numbers with units, which the engine reads or refuses; what goes into the spec has the unit that stands there. */
async function units(page) {
  const numbers = () => at(page, () => [globalThis.instrument.rest.parameters[0], globalThis.instrument.rest.positions[0]]);
  const [payload, angle] = ["first", "last"].map((which) => page.locator(`#sliders fieldset:${which}-of-type input.number`).first());
  await payload.fill("1.2 t");
  await eventually(page, async () => assert.equal((await numbers())[0], 1200));
  assert.equal(await page.locator("#sliders input[type=range]").first().inputValue(), "1200");
  await angle.fill("-0.5 rad");
  await eventually(page, async () => assert.equal((await numbers())[1], -0.5));
  await payload.fill("320 bar");
  await eventually(page, async () => assert.match(await state(page), /^payload is in kg, and `320 bar` is a pressure \(Pa\); /));
  assert.deepEqual([await payload.getAttribute("aria-invalid"), (await numbers())[0]], ["true", 1200]);
  await payload.fill("1.2 t");
  await eventually(page, async () => assert.match(await state(page), /^At rest/));
  await edit(page, "value: 800", "value: 0.8 t");
  await eventually(page, async () => assert.match(await state(page), /^At rest/));
  await page.getByRole("button", { name: "Into the spec" }).click();
  await eventually(page, async () => assert.match(await at(page, () => globalThis.instrument.editor.text), /payload: \{value: 1\.2 t, unit: kg/));
  await settled(page);
  // Ranges of load charts, and the duration of a run.
  await page.getByRole("tab", { name: "Load chart" }).click();
  const from = page.locator("#asked input[aria-label=from]").first();
  const before = await from.inputValue();
  await from.fill("1 m");
  await page.getByRole("button", { name: "Compute" }).click();
  await eventually(page, async () => assert.match(await page.textContent("#chart_state"), /^main_boom_theta is in rad, and `1 m` is a length/));
  await from.fill(before);
  await page.getByRole("tab", { name: "Run" }).click();
  await page.fill("#duration", "500 ms");
  await page.click("#start");
  await page.waitForSelector("#run .panel");
  assert(Math.abs((await at(page, () => globalThis.instrument.stage.crane.run.t.at(-1))) - 0.5) < 1e-6);
  await page.getByRole("tab", { name: "At rest" }).click();
  await example(page, "knuckle boom");
}

/** Modes move the crane; runs and load charts have plots with labels. */
async function analyses(page) {
  await page.getByRole("tab", { name: "Modes" }).click();
  await page.locator("#modes .mode input").first().check();
  const pose = () => at(page, () => globalThis.instrument.stage.viewer.figure.kinematics.frames.at(-1).elements.join());
  const still = await pose();
  await eventually(page, async () => assert.notEqual(await pose(), still));
  await page.getByRole("tab", { name: "Run" }).click();
  await page.fill("#duration", "3");
  await page.click("#start");
  await page.waitForSelector("#run .panel");
  const ids = await page.$$eval("#run .panel", (panels) => panels.map(({ id }) => id));
  assert(ids.includes("path") && ids.some((id) => id.startsWith("drive_")) && ids.includes("balance"), ids.join());
  const rows = await at(page, () => globalThis.instrument.stage.crane.run.t.at(-1));
  assert(Math.abs(rows - 3) < 1e-6);
  assert.match(await state(page), /^The run of the spec, 3.00 s$/);
  // The page has no clock of its own for the engine.
  assert.doesNotMatch(await page.locator("#run .tables").textContent(), /wall time|real-time factor|\binf\b|NaN/);
  await page.screenshot({ path: picture("run") });
  await page.getByRole("tab", { name: "Load chart" }).click();
  await page.getByRole("button", { name: "Compute" }).click();
  await page.waitForSelector("#load_chart .panel");
  assert((await page.locator("#table_chart tbody tr").count()) > 10);
  await page.screenshot({ path: picture("chart") });
  await page.getByRole("tab", { name: "At rest" }).click();
  assert.match(await state(page), /^At rest/);
}

/** Poses that bear no load: "–" in the table, an empty field in the file, a gap in the picture. */
async function absent(page) {
  await example(page, "loader crane", "my_loader_crane");
  await page.getByRole("tab", { name: "Load chart" }).click();
  await page.getByRole("button", { name: "Compute" }).click();
  await page.waitForSelector("#load_chart .panel");
  const panel = page.locator("#load_chart_plot");
  const load = async (button) => {
    const [download] = await Promise.all([page.waitForEvent("download"), panel.locator("button", { hasText: button }).click()]);
    return readFile(await download.path(), "utf8");
  };
  const csv = await load("CSV");
  const [, ...lines] = csv.trimEnd().split("\n").map((line) => line.split(","));
  const empty = lines.flat().filter((field) => field === "").length;
  const dashes = await page.$$eval("#table_chart tbody tr", (rows) => rows.filter(({ cells }) => cells[4].textContent === "–").length);
  assert(empty > 0 && empty === dashes, `${empty} empty fields, ${dashes} dashes`);
  const numbers = lines.flat().filter((field) => field !== "").map(Number);
  assert(numbers.every(Number.isFinite), csv);
  const svg = await load("SVG");
  const points = [...svg.matchAll(/<polyline [^>]*points="([^"]*)"/g)].flatMap(([, text]) => text.split(" ").filter(Boolean));
  assert.equal(points.length, numbers.length - lines.length, "a point of a curve for every load");
  await page.getByRole("tab", { name: "At rest" }).click();
}

/** Pictures of motions that the processor draws: a few calls instead of one for each part, and the crane where it is, in its colours. */
async function plainly(page) {
  await example(page, "eight link hydraulic");
  const { calls, parts, kept } = await at(page, () => {
    const { viewer } = globalThis.instrument.stage;
    const picture = (moves) => {
      clearTimeout(viewer.quiet);
      viewer.move(moves);
      viewer.paint();
      const { width, height } = viewer.canvas.getBoundingClientRect();
      const flat = Object.assign(document.createElement("canvas"), { width, height }).getContext("2d", { willReadFrequently: true });
      flat.drawImage(viewer.canvas, 0, 0, width, height);
      return { pixels: flat.getImageData(0, 0, width, height).data, calls: viewer.renderer.info.render.calls };
    };
    const [fine, plain] = [picture(false), picture(true)];
    viewer.draw();
    // The crane has colours, the ground has none.
    const coloured = [];
    for (let at = 0; at < fine.pixels.length; at += 4) {
      const [r, g, b] = fine.pixels.subarray(at, at + 3);
      if (Math.max(r, g, b) - Math.min(r, g, b) > 90) coloured.push(at);
    }
    const alike = coloured.filter((at) => [0, 1, 2].every((part) => Math.abs(fine.pixels[at + part] - plain.pixels[at + part]) < 70));
    return { calls: plain.calls, parts: viewer.figure.group.children.length, kept: coloured.length > 500 ? alike.length / coloured.length : 0 };
  });
  assert(calls < 30 && parts > 40, `${calls} calls for ${parts} parts`);
  assert(kept > 0.85, `${kept} of the crane looks the same`);
  // With little room for numbers, the parts are drawn in several calls.
  const several = await at(page, () => {
    const { viewer } = globalThis.instrument.stage;
    const { figure, floor, grid, extent: { size } } = viewer;
    return new viewer.plain.constructor({ figure, floor, grid, size, vectors: 164 }).batches.map(({ meshes }) => meshes.length);
  });
  assert(several.length > 2 && several.every((count) => count <= 20) && several.reduce((sum, count) => sum + count) > 40, several.join());
}

/** The reader sees what fails in the page. */
async function faults(browser) {
  await open(browser, { viewport: { width: 640, height: 480 } }, async (page) => {
    await at(page, () => setTimeout(() => { throw new Error("a mistake of the test"); }));
    await eventually(page, async () => assert.match(await state(page), /failed \(a mistake of the test\)/));
    await at(page, () => void Promise.reject(new Error("another one")));
    await eventually(page, async () => assert.match(await state(page), /failed \(another one\)/));
  }, { silent: false });
}

/** Driving by keys: the crane moves in real time, levers spring back, the record is a file. */
async function drive(page) {
  await example(page, "eight link hydraulic");
  await page.getByRole("tab", { name: "Drive" }).click();
  await page.click("#engage");
  await page.waitForSelector("#cockpit:not([hidden])");
  const seen = () => at(page, () => {
    const { drive } = globalThis.instrument;
    return { t: drive.t, row: [...(drive.rows.at(-1) ?? [])], pace: drive.pace, rate: drive.rate, share: drive.share, tolerance: drive.tolerance };
  });
  await eventually(page, async () => assert((await seen()).t > 0.3));
  const still = await seen();
  const boom = await at(page, () => globalThis.instrument.stage.crane.run.list.findIndex(({ name }) => name === "boom_psi"));
  await page.keyboard.down("KeyW");
  await eventually(page, async () => assert.equal(await page.locator("#levers .track").nth(1).getAttribute("aria-valuenow"), "100"));
  await eventually(page, async () => assert((await seen()).t > still.t + 2));
  assert.equal(await state(page), "Driven in real time");
  await page.screenshot({ path: picture("drive") });
  const moved = await seen();
  await page.keyboard.up("KeyW");
  assert(moved.row[boom] - still.row[boom] > 0.02, `the boom lifts: ${still.row[boom]} … ${moved.row[boom]} rad`);
  await eventually(page, async () => assert.equal(await page.locator("#levers .track").nth(1).getAttribute("aria-valuenow"), "0"));
  assert.match(await page.locator("#gauges").textContent(), /tipping margin.*swing.*bar/s);
  await eventually(page, async () => assert((await seen()).t > moved.t + 1));
  const last = await seen();
  Object.assign(times, { pictures: Math.round(last.rate), pace: last.pace.toFixed(2), share: last.share.toFixed(2), tolerance: last.tolerance });
  // A gamepad: its second axis is the second lever, pushed away from oneself.
  await at(page, () => (navigator.getGamepads = () => [{ axes: [0, -1, 0, 0], buttons: [] }]));
  await eventually(page, async () => assert.equal(await page.locator("#levers .track").nth(1).getAttribute("aria-valuenow"), "100"));
  await at(page, () => (navigator.getGamepads = () => []));
  // What was driven outlasts an edit.
  await edit(page, "title:", "title: Driven");
  await eventually(page, async () => assert.match(await page.textContent("#drive_state"), /the spec was changed/));
  const [download] = await Promise.all([page.waitForEvent("download"), page.click("#record")]);
  const csv = await readFile(await download.path(), "utf8");
  const [head, ...lines] = csv.trim().split("\n");
  assert(head.startsWith("t [s],") && head.includes("boom_psi [rad]") && lines.length > 10, head.slice(0, 200));
}

/** Times of the page without anything else to do: accelerations of 25 coordinates, a second of driving. */
async function speeds(page) {
  await example(page, "eight link flexible");
  times.accelerationMicroseconds = await at(page, async () => {
    const { engine } = globalThis.instrument;
    const least = async (calls) => {
      const took = [];
      for (let time = 0; time < 20; time += 1) took.push((await engine.ask({ ask: "repeat", calls })).took);
      return Math.min(...took);
    };
    return Number((((await least(4000)) - (await least(0))) / 4).toFixed(2));
  });
  await example(page, "eight link hydraulic");
  const computing = await at(page, async () => {
    const { engine, crane } = globalThis.instrument;
    await engine.ask({ ask: "drive" });
    const levers = crane.drives.map(() => 0);
    let took = 0;
    for (let picture = 1; picture <= 60; picture += 1) took += (await engine.ask({ ask: "advance", to: picture / 60, levers: levers.map((_, at) => (at === 1 ? 0.5 : 0)), tolerance: 1e-3 })).took;
    return took;
  });
  times.secondOfDriving = Math.round(computing);
}

/** A link contains the spec; hostile ones are refused or harmless. */
async function links(browser) {
  const small = { viewport: { width: 640, height: 480 } };
  const text = "format: 1\nname: linked\nlinks:\n  - {name: rod, placement: {transform: {rotation: {x: 90 deg}}}, joint: revolute, mass: 3, com: [0, -1, 0]}\ndamping: {rod_psi: 1}\n";
  await open(browser, small, async (page) => {
    assert.equal(await at(page, () => globalThis.instrument.crane.name), "linked");
    // What was written outlasts a reload, and is not that of another link.
    await edit(page, "mass: 3", "mass: 4");
    await eventually(page, async () => assert(await at(page, () => sessionStorage.getItem("crane").includes("mass: 4"))));
    // What is saved is not asked about.
    await page.click("#save");
    await page.reload();
    await page.waitForSelector("html[data-ready]");
    assert.equal(await at(page, () => globalThis.instrument.editor.text), text.replace("mass: 3", "mass: 4"));
    await edit(page, "mass: 4", "mass: 3");
    await page.click("#share");
    await eventually(page, async () => assert.match(await page.textContent("#state"), /address now contains the whole spec/));
    const hash = await at(page, () => location.hash);
    assert(hash.startsWith("#spec="));
    await page.goto("about:blank");
    await page.goto(address + hash);
    await page.waitForSelector("html[data-ready]");
    assert.equal(await at(page, () => globalThis.instrument.editor.text), text);
  }, { hash: fragment(text) });
  const script = '</script><img src=x onerror="alert(1)"><script>alert(2)</script>';
  const named = `${text}title: '${script.replaceAll("'", "''")}'\n`;
  await open(browser, small, async (page) => {
    await eventually(page, async () => assert.match(await page.title(), /onerror/));
    assert.equal(await page.locator("h1 img, #rest img").count(), 0);
  }, { hash: fragment(named) });
  const bomb = `a: &a [x,x,x,x,x,x,x,x,x]\n${[..."bcdefghij"].map((name, at) => `${name}: &${name} [${Array(9).fill(`*${"abcdefghij"[at]}`).join(",")}]`).join("\n")}\n`;
  await open(browser, small, async (page) => {
    assert((await page.locator("#problems li.error").count()) > 0, "the bomb is a mistake");
  }, { hash: fragment(bomb) });
  // Deeper than any browser's stack.
  const deep = `format: 1\nname: deep\nlinks: ${"[".repeat(1_000_000)}`;
  await open(browser, small, async (page) => {
    await eventually(page, async () => assert.match(await state(page), /mistake|ended|failed/));
    // The page still works.
    await example(page, "knuckle boom");
  }, { hash: fragment(deep) });
  // More links than there is memory for.
  const many = Array.from({ length: 2900 }, (_, link) => `  - {name: l${link}, placement: {transform: {translation: [0.1, 0, 0], rotation: {x: ${link ? 0 : 90} deg}}}, joint: revolute, mass: 1, com: [0.05, 0, 0]}\n`);
  await open(browser, small, async (page) => {
    await eventually(page, async () => assert.match(await state(page), /needs more memory|took longer/));
  }, { hash: fragment(`format: 1\nname: many\nlinks:\n${many.join("")}`) });
  // A gigabyte of text in a link of a megabyte.
  const zeros = deflateRawSync(Buffer.alloc(1 << 28, "#"));
  await open(browser, small, async (page) => {
    await eventually(page, async () => assert.match(await state(page), /longer than 4 MB/));
  }, { hash: `#spec=${zeros.toString("base64url")}` });
  await open(browser, small, async (page) => assert.match(await state(page), /damaged/), { hash: "#spec=!!!" });
}

/** A calculation that takes too long is ended, and the page says so and goes on. */
async function patience(page) {
  await example(page, "knuckle boom");
  const words = await at(page, () => globalThis.instrument.engine.ask({ ask: "repeat", calls: 4_000_000_000 }, 0.5).catch(({ message }) => message));
  assert.match(words, /took longer than 0.5 s/);
  await edit(page, "format: 1", "format: 1 ");
  await eventually(page, async () => assert.match(await state(page), /^At rest/));
  // What waits is not what takes long.
  const [long, short] = await at(page, () => {
    const { engine } = globalThis.instrument;
    return Promise.all([engine.ask({ ask: "repeat", calls: 2_000_000 }, 20), engine.ask({ ask: "repeat", calls: 1 }, 0.3)]).then((both) => both.map(({ took }) => took));
  });
  assert(long > 400 && short < 300, `${long} ms, then ${short} ms`);
  // An edit ends a run of the spec as it was.
  await page.getByRole("tab", { name: "Run" }).click();
  await page.fill("#duration", "9000");
  await page.click("#start");
  await at(page, () => (globalThis.instrument.took = null));
  await edit(page, "format: 1", "format: 1 ");
  await eventually(page, async () => assert(await at(page, () => globalThis.instrument.took)), 8_000);
  assert.equal(await page.textContent("#run_state"), "ended: the spec was changed");
}

/** The report opens its crane in the instrument. */
async function fromReport(browser) {
  const page = await browser.newPage();
  await page.goto(pathToFileURL(report).href);
  const link = page.locator("#instrument");
  await link.waitFor();
  const href = await link.evaluate(({ href }) => href);
  await page.close();
  assert(href.startsWith(`${address}#spec=`), href);
  await open(browser, {}, async (page) => {
    await eventually(page, async () => assert.equal(await at(page, () => globalThis.instrument.crane?.name), "knuckle_boom"));
  }, { hash: new URL(href).hash });
}

const begin = Date.now();
const bytes = (await stat(file)).size;
assert(bytes < MOST_BYTES, `${bytes} bytes`);
const browser = await launch({ swift: true });
await open(browser, { viewport: { width: 1440, height: 900 }, colorScheme: "light", acceptDownloads: true }, async (page, ready) => {
  const loaded = await at(page, () => performance.now());
  times.ready = Math.round(Math.min(ready, loaded));
  await page.waitForTimeout(500);
  await page.screenshot({ path: picture("first") });
  await edits(page);
  await page.screenshot({ path: picture("light") });
  await schema(page);
  await start(page);
  await parts(page, false);
  await first(page);
  await sliders(page);
  await warnings(page, false);
  await analyses(page);
  await absent(page);
  await plainly(page);
  await drive(page);
  await speeds(page);
  await patience(page);
});
await open(browser, { viewport: { width: 1440, height: 900 }, colorScheme: "dark" }, async (page) => {
  assert.equal(await at(page, () => document.documentElement.dataset.theme), "dark");
  await example(page, "loader tipping");
  await edit(page, "joint: revolute", "joint: revolut");
  await eventually(page, async () => assert.match(await state(page), /mistake/));
  await page.screenshot({ path: picture("dark") });
});
const phone = { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true };
await open(browser, phone, async (page) => {
  for (const tab of ["At rest", "Modes", "Run", "Load chart", "Drive", "Spec"]) {
    await page.getByRole("tab", { name: tab }).click();
    const [width, screen] = await at(page, () => [document.documentElement.scrollWidth, innerWidth]);
    assert(width <= screen, `${tab} is ${width} wide on a screen of ${screen}`);
  }
  await page.screenshot({ path: picture("phone_spec") });
  await page.getByRole("tab", { name: "At rest" }).click();
  await page.screenshot({ path: picture("phone") });
  await page.getByRole("tab", { name: "Drive" }).click();
  await page.click("#engage");
  await page.waitForSelector("#cockpit:not([hidden])");
  const track = await page.locator("#levers .track").first().boundingBox();
  await page.touchscreen.tap(track.x + track.width * 0.9, track.y + track.height / 2);
  await page.waitForTimeout(500);
  await page.screenshot({ path: picture("phone_drive") });
  await warnings(page, true);
  await parts(page, true);
  // Nothing that can be pressed lies over the crane.
  const over = await at(page, () => {
    const { bottom } = document.querySelector("#view canvas").getBoundingClientRect();
    return [...document.querySelectorAll("#crane button, #crane select")].filter((one) => one.offsetParent && one.getBoundingClientRect().top < bottom).length;
  });
  assert.equal(over, 0);
});
await faults(browser);
await links(browser);
await shown(browser);
await fromReport(browser);
await browser.close();

// Without 3-D, everything else is there.
const flat = await launch({ flat: true });
await open(flat, { viewport: { width: 1000, height: 700 } }, async (page) => {
  assert.match(await page.locator("#view").textContent(), /3-D is not available/);
  await eventually(page, async () => assert.match(await state(page), /^At rest/));
}, { silent: false });
await flat.close();
console.log(`instrument: ${(bytes / 1e6).toFixed(2)} MB, ${JSON.stringify(times)}, ${((Date.now() - begin) / 1000).toFixed(0)} s`);
