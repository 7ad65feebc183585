// The page as an instrument: a spec at one side, the crane and what is computed of it at the other.
import "uplot/dist/uPlot.min.css";
import "../../src/style.css";
import "./style.css";
import { spoken } from "../../src/data.js";
import { save } from "../../src/download.js";
import { element } from "../../src/element.js";
import { faults } from "../../src/faults.js";
import { Drive } from "./drive.js";
import { Editor } from "./editor.js";
import { Engine, compile, typed } from "./engine.js";
import { Gallery } from "./gallery.js";
import { MOST, fragment, shown as shownOf, text as textOf } from "./link.js";
import { LoadChart } from "./load_chart.js";
import { looks } from "./looks.js";
import { Modes } from "./modes.js";
import { Parts } from "./parts.js";
import { entry, rewritten } from "./places.js";
import { Rest } from "./rest.js";
import { Run } from "./run.js";
import { context } from "./schema.js";
import { Stage } from "./stage.js";

/** Time after the last key until the spec is read, ms. */
const PAUSE = 80;
/** Time without an edit or a moved slider until modes are computed, which take longer than statics, ms. */
const CALM = 250;
/** Modes that take no longer than this are waited for: another start of the engine would take as long, ms. */
const BRIEF = 150;
/** Longest time for reading a spec or for statics, s. */
const PATIENCE = 10;
/** Name of a spec that came from nowhere. */
const UNNAMED = "crane.yaml";
/** Where the browser keeps the spec while its tab is open. */
const KEPT = "crane";

const $ = (selector) => document.querySelector(selector);
const { lessons, examples, fresh, schema } = JSON.parse($("#given").textContent);
const root = document.documentElement;
root.dataset.theme = matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";

const stage = new Stage();
let engine = null;
/** The crane of the last spec without mistakes, as the engine describes it, and as it is at rest. */
let crane = null;
let atRest = null;
/** What the line under the crane says of the crane at rest; and of mistakes and warnings. */
let restNote = null;
let counts = { mistakes: 0, warnings: 0 };
let name = UNNAMED;
/** The text as it was opened or saved. */
let kept = "";
let tab = "rest";

const ask = (request, seconds = PATIENCE) => engine.ask(request, seconds);
const editor = new Editor($("#editor"), schema, { changed: edited, names });
const rest = new Rest($("#rest"), { ask, changed: moved, write, refuse: (words) => note(words, "bad") });
faults((words) => note(words, "bad"));
const modes = new Modes($("#modes"), { choose: (mode) => stage.vibrate(mode), swell: (factor) => stage.viewer?.set({ factor }) });
const run = new Run($("#run"), stage, { ask, end: (words) => engine.end(words), given: () => rest.given, note });
const chart = new LoadChart($("#load_chart"), { ask, given: () => rest.given });
const gallery = new Gallery($("#gallery"), { lessons, examples, fresh }, start);
const parts = new Parts($("#part"), $("#view canvas"), stage, {
  find: ({ kind, name: own }) => entry(editor.text, kind, own),
  go: (place) => {
    if (isNarrow()) choose("spec");
    editor.go(place);
  },
});
/** Specs that were open before in this page, by the number of their entry in the browser's history; the number of the present entry, and of the last. */
const before = new Map();
const visits = { now: 0, last: 0 };
const drive = new Drive(stage, { ask, given: () => rest.given, note, before: () => stage.player.play(false) });

controls();
globalThis.instrument = { stage, editor, run, drive, chart, rest, parts, context, get engine() { return engine; }, get crane() { return crane; }, get atRest() { return atRest; }, get reading() { return Boolean(edited.waiting || read.busy); } };
begin();

async function begin() {
  let refused = null;
  const linked = linkedSpec().catch(({ message }) => {
    refused = message;
    return null;
  });
  history.replaceState({ entry: 0 }, "");
  try {
    engine = new Engine(await compile($("#engine").textContent));
  } catch (error) {
    note(`This browser cannot run the engine (${error.message}): it needs WebAssembly with 128-bit SIMD, as all browsers since 2023 have it.`, "bad");
    return;
  }
  globalThis.instrument.compiled = performance.now();
  const link = await linked;
  await load(remembered() ?? link ?? examples[0]).catch(({ message }) => note(`The spec cannot be shown: ${message}.`, "bad"));
  if (refused) note(`${refused}. This is an example instead.`, "bad");
  root.dataset.ready = "yes";
}

/** The spec in the address, if there is one, with what is shown of it. */
async function linkedSpec(hash = location.hash) {
  const text = await textOf(hash);
  return text === null ? null : { name: UNNAMED, text, shown: await shownOf(hash) };
}

/** What is shown beside the spec: for links, for reloads, and for the way back. */
function shown() {
  return { tab, ...rest.state, chart: chart.chosen, duration: $("#duration").value, part: $("#part select").value, seenFrom: stage.viewer?.seenFrom };
}

/** The spec as it was when this tab was reloaded, unless another link is open now. */
function remembered() {
  try {
    const kept = JSON.parse(sessionStorage.getItem(KEPT));
    return kept?.hash === location.hash ? kept : null;
  } catch {
    return null;
  }
}

/** Keeps the spec, in case this tab is reloaded. */
function remember() {
  try {
    sessionStorage.setItem(KEPT, JSON.stringify({ hash: location.hash, name, text: editor.text, shown: shown() }));
  } catch {
    // Some browsers keep nothing for files, or not so much.
  }
}

/** Puts a spec into the editor and reads it; `shown`: what is shown of it, if that is known. */
async function load({ name: given, text, kept: saved = text, shown: wanted = null }) {
  name = given;
  editor.text = text;
  kept = saved;
  clearTimeout(edited.waiting);
  edited.waiting = null;
  load.wanted = wanted;
  return read();
}

/** Starts with another spec; the browser's way back leads to the one before. */
function start(spec) {
  leave();
  visits.now = visits.last += 1;
  history.pushState({ entry: visits.now }, "", location.href.split("#")[0]);
  load(spec);
}

/** Keeps the spec for the way back to it. */
function leave() {
  before.set(visits.now, { name, text: editor.text, kept, shown: shown() });
}

/** Another entry of the browser's history: a spec that was open before, or a link that was pasted into the address. */
async function goBack({ state }) {
  leave();
  const known = before.get(state?.entry);
  if (known) {
    visits.now = state.entry;
    load(known);
    return;
  }
  visits.now = visits.last += 1;
  history.replaceState({ entry: visits.now }, "");
  try {
    const linked = await linkedSpec();
    if (linked && (linked.text !== editor.text || linked.shown)) load(linked);
  } catch ({ message }) {
    note(message, "bad");
  }
}

/** Shows what is wanted of a crane that was read: its tab, and where it is seen from. */
function present({ tab: chosen, seenFrom, duration, part }) {
  if (document.getElementById(`tab_${chosen}`)) choose(chosen === "spec" && !isNarrow() ? "rest" : chosen);
  if (typeof duration === "string") $("#duration").value = duration;
  if (stage.viewer) stage.viewer.seenFrom = seenFrom;
  parts.choose(String(part));
}

/** Whether spec and crane do not fit side by side. */
function isNarrow() {
  return matchMedia("(max-width: 900px)").matches;
}

/** Writes the numbers of the sliders into the spec. */
async function write() {
  const { text } = editor;
  const unitOf = (name) => [...crane.parameters, ...crane.drives].find((one) => one.name === name).unit;
  const { changes, left } = await rewritten(text, rest.state, (name, unit) => typed(ask, `1 ${unit}`, { name, unit: unitOf(name) }));
  if (editor.text === text) editor.change(changes);
  if (left.length) note(`Not one number of this spec: ${left.map(spoken).join(", ")}`, "warned");
}

/** The spec was changed: it is read when the keys rest. */
function edited() {
  clearTimeout(edited.waiting);
  edited.waiting = setTimeout(() => {
    edited.waiting = null;
    read();
  }, PAUSE);
}

/** Reads the spec, and shows its mistakes or the crane at rest. Reads again if it was changed meanwhile. */
async function read() {
  if (!engine) return;
  if (read.busy) {
    read.again = true;
    return;
  }
  read.busy = true;
  const { wanted } = load;
  load.wanted = null;
  const begin = performance.now();
  remember();
  clearTimeout(vibrations.waiting);
  engine.abandon(["run", "chart", ...(vibrations.took > BRIEF ? ["modes"] : [])], "ended: the spec was changed");
  try {
    const opened = await ask({ ask: "open", name, text: editor.text });
    problems(opened.diagnostics);
    if (opened.name) {
      const same = crane && !wanted && alike(crane, opened);
      crane = opened;
      document.title = `${crane.title || spoken(crane.name)} · Crane`;
      $("h1").textContent = crane.title || spoken(crane.name);
      if (!same) {
        rest.open(crane, wanted ?? {});
        chart.open(crane, wanted?.chart ?? {});
      }
      drive.open(crane);
      run.open(crane);
      await statics(begin);
      if (wanted) present(wanted);
    } else {
      note(`${[counted("mistake"), counted("warning")].filter(Boolean).join(", ")}: ${crane ? "the crane is as before" : "there is no crane yet"}`, "bad");
    }
  } catch ({ message }) {
    problems([]);
    note(message, "bad");
  }
  read.busy = false;
  if (read.again) {
    read.again = false;
    read();
  }
}

/** Whether sliders fit both cranes: an edit elsewhere does not move them. */
function alike(one, other) {
  const key = ({ parameters, drives, name }) => JSON.stringify([name, parameters, drives]);
  return key(one) === key(other);
}

/** A slider moved: statics with its number; the last one if there are many. */
async function moved() {
  if (moved.busy) {
    moved.again = true;
    return;
  }
  moved.busy = true;
  if (vibrations.took > BRIEF) engine.abandon(["modes"], "ended: a slider was moved");
  do {
    moved.again = false;
    drive.stop();
    await statics(performance.now());
  } while (moved.again);
  moved.busy = false;
}

/** The crane at rest; its modes when nothing else is asked. */
async function statics(begin) {
  clearTimeout(vibrations.waiting);
  try {
    const shown = stage.show(await ask({ ask: "rest", ...rest.given }));
    atRest = shown;
    rest.show(shown);
    parts.open(shown.crane);
    modes.wait(shown.rest.stable);
    const took = performance.now() - begin;
    globalThis.instrument.took = took;
    const { stable, words, why } = shown.rest;
    const said = [stable ? `At rest: ${words}` : why ?? words, counted("warning"), `${crane.coordinates} coordinate${crane.coordinates === 1 ? "" : "s"}`, `${Math.round(took)} ms`];
    restNote = [said.filter(Boolean).join(" · "), stable ? (counts.warnings ? "warned" : "") : "bad"];
    note(...restNote);
    if (stable) vibrations.waiting = setTimeout(vibrations, tab === "modes" ? 0 : CALM);
  } catch ({ message }) {
    note(message, "bad");
  }
}

/** Modes about the pose at rest: they do not keep its numbers waiting, nor a crane that is driven. */
async function vibrations() {
  clearTimeout(vibrations.waiting);
  const of = atRest;
  if (!of?.rest.stable || of.modes || drive.on) return;
  try {
    const found = await ask({ ask: "modes" });
    vibrations.took = found.took;
    if (of !== atRest) return;
    Object.assign(of, { modes: found.modes, figures: [...of.figures, ...found.figures] });
    of.crane.modes = found.modes;
    rest.vibrates(of.figures);
    modes.show(found.modes);
  } catch ({ message }) {
    if (of === atRest) modes.fail(message);
  }
}

/** Time that modes took, ms; before the first ones, unknown. */
vibrations.took = Infinity;

/** The line under the crane; `kind`: bad, warned or nothing. */
function note(words, kind = "") {
  Object.assign($("#state"), { textContent: words, className: kind });
}

/** How many mistakes or warnings there are, in words; nothing if there are none. */
function counted(what) {
  const count = counts[`${what}s`];
  return count ? `${count} ${what}${count === 1 ? "" : "s"}` : "";
}

/** Mistakes and warnings under the editor, as in the terminal, and underlined in it. */
function problems(diagnostics) {
  editor.mark(diagnostics, name);
  $("#problems").replaceChildren(...diagnostics.map(({ code, severity, file, line, column, message, label, help }) => {
    const place = element("button", { type: "button", textContent: `${file === name ? "" : `${file}:`}${line}:${column}`, title: "Go there" });
    place.disabled = file !== name;
    place.addEventListener("click", () => {
      if (isNarrow()) choose("spec");
      editor.show(line, column);
    });
    const words = element("div", {}, element("strong", { textContent: `${message} [${code}]` }));
    if (label) words.append(element("span", { textContent: label }));
    if (help) words.append(element("span", { className: "help", textContent: `help: ${help}` }));
    // What the help refers to is in the schema of the page.
    const lacking = /^add `(\w+):`/.exec(help ?? "");
    const about = lacking && file === name ? editor.about(line, column, lacking[1]) : "";
    if (about) words.append(element("span", { className: "help", textContent: `${lacking[1]}: ${about}` }));
    return element("li", { className: severity }, place, words);
  }));
  const mistakes = diagnostics.filter(({ severity }) => severity === "error").length;
  counts = { mistakes, warnings: diagnostics.length - mistakes };
  root.classList.toggle("mistaken", mistakes > 0);
  // Where the spec is a tab of its own, its tab says what is in it.
  const badge = $("#tab_spec .badge");
  Object.assign(badge, { textContent: diagnostics.length || "", className: `badge ${mistakes ? "bad" : "warned"}`, hidden: !diagnostics.length });
  badge.setAttribute("aria-label", [counted("mistake"), counted("warning")].filter(Boolean).join(", "));
}

/** What the parts of the crane are called, for completion. */
function names() {
  const data = stage.crane;
  return {
    parameters: crane?.parameters.map((one) => one.name) ?? [],
    coordinates: data?.coordinates.map((one) => one.name) ?? [],
    links: [...new Set(data?.scene.bodies.map(({ link }) => link))],
  };
}

/** Chooses a tab. */
function choose(chosen) {
  const left = tab;
  tab = chosen;
  root.dataset.tab = chosen;
  for (const button of document.querySelectorAll("[role=tab]")) {
    const own = button.id === `tab_${chosen}`;
    button.setAttribute("aria-selected", own);
    button.tabIndex = own ? 0 : -1;
  }
  for (const panel of document.querySelectorAll("#panel > [role=tabpanel]")) panel.hidden = panel.getAttribute("aria-labelledby") !== `tab_${chosen}`;
  if (left === chosen) return;
  if (left === "drive") drive.stop();
  if (chosen === "modes" && engine) vibrations();
  if (chosen === "run") run.again();
  else if (["rest", "modes", "chart"].includes(chosen) && atRest && stage.crane !== atRest.crane) {
    stage.present(atRest.crane);
    note(...restNote);
    if (chosen === "modes") stage.vibrate(modes.chosen);
  } else if (left === "modes") stage.vibrate(null);
  else if (chosen === "modes") stage.vibrate(modes.chosen);
}

function controls() {
  choose("rest");
  const tabs = [...document.querySelectorAll("[role=tab]")];
  tabs.forEach((button, index) => {
    button.addEventListener("click", () => choose(button.id.slice(4)));
    button.addEventListener("keydown", ({ key }) => {
      const step = { ArrowRight: 1, ArrowLeft: -1 }[key];
      if (!step) return;
      const shown = tabs.filter((one) => one.offsetParent);
      const next = shown[(shown.indexOf(tabs[index]) + step + shown.length) % shown.length];
      next.focus();
      choose(next.id.slice(4));
    });
  });
  document.querySelectorAll("[data-view]").forEach((button) => button.addEventListener("click", () => stage.viewer?.look(button.dataset.view)));
  looks($("#looks"), stage);
  $("#new").addEventListener("click", () => gallery.show(name));
  const file = $("#file");
  $("#open").addEventListener("click", () => file.click());
  file.addEventListener("change", () => {
    take(file.files[0]);
    file.value = "";
  });
  addEventListener("dragover", (event) => event.preventDefault());
  addEventListener("drop", (event) => {
    event.preventDefault();
    take(event.dataTransfer.files[0]);
  });
  const keep = () => {
    kept = editor.text;
    save(name, kept, "text/yaml");
  };
  $("#save").addEventListener("click", keep);
  addEventListener("keydown", (event) => {
    if (event.key === "s" && (event.ctrlKey || event.metaKey)) {
      event.preventDefault();
      keep();
    }
  });
  // The browser asks before what was written is lost.
  addEventListener("beforeunload", (event) => editor.text !== kept && event.preventDefault());
  addEventListener("pagehide", remember);
  $("#share").addEventListener("click", share);
  addEventListener("popstate", goBack);
  $("#theme").addEventListener("click", () => {
    root.dataset.theme = root.dataset.theme === "dark" ? "light" : "dark";
    stage.theme();
    for (const plot of run.plots) plot.theme();
    chart.theme();
    drive.theme();
  });
}

/** Opens a file. */
async function take(file) {
  if (!file) return;
  if (file.size > MOST) note(`${file.name} is longer than ${MOST >> 20} MB: that is not a spec`, "bad");
  else start({ name: file.name, text: await file.text() });
}

/** Puts the spec into the address, and the address where it can be pasted from. */
async function share() {
  history.replaceState(history.state, "", await fragment(editor.text, shown()));
  kept = editor.text;
  remember();
  const words = "The address now contains the whole spec, and what is shown of it";
  try {
    await navigator.clipboard.writeText(location.href);
    note(`${words}, and is copied`);
  } catch {
    note(`${words}: copy it from the browser's address bar`);
  }
}
