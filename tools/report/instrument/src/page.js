// The page as an instrument: a spec at one side, the crane and what is computed of it at the other.
import "uplot/dist/uPlot.min.css";
import "../../src/style.css";
import "./style.css";
import { spoken } from "../../src/data.js";
import { save } from "../../src/download.js";
import { element } from "../../src/element.js";
import { Drive } from "./drive.js";
import { Editor } from "./editor.js";
import { Engine, compile } from "./engine.js";
import { MOST, fragment, text as textOf } from "./link.js";
import { LoadChart } from "./load_chart.js";
import { Modes } from "./modes.js";
import { Rest } from "./rest.js";
import { Run } from "./run.js";
import { context } from "./schema.js";
import { Stage } from "./stage.js";

/** Time after the last key until the spec is read, ms. */
const PAUSE = 80;
/** Longest time for reading a spec or for statics, s. */
const PATIENCE = 10;
/** Name of a spec that came from nowhere. */
const UNNAMED = "crane.yaml";

const $ = (selector) => document.querySelector(selector);
const { examples, schema } = JSON.parse($("#given").textContent);
const root = document.documentElement;
root.dataset.theme = matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";

const stage = new Stage();
let engine = null;
/** The crane of the last spec without mistakes, as the engine describes it, and as it is at rest. */
let crane = null;
let atRest = null;
let name = UNNAMED;
/** The text as it was opened or saved. */
let kept = "";
let tab = "rest";

const ask = (request, seconds = PATIENCE) => engine.ask(request, seconds);
const editor = new Editor($("#editor"), schema, { changed: edited, names });
const rest = new Rest($("#rest"), moved);
const modes = new Modes($("#modes"), { choose: (mode) => stage.vibrate(mode), swell: (factor) => stage.viewer?.set({ factor }) });
const run = new Run($("#run"), stage, { ask, end: (words) => engine.end(words), given: () => rest.given });
const chart = new LoadChart($("#load_chart"), { ask, given: () => rest.given });
const drive = new Drive(stage, { ask, given: () => rest.given, before: () => stage.player.play(false) });

controls();
globalThis.instrument = { stage, editor, run, drive, chart, rest, context, get engine() { return engine; }, get crane() { return crane; }, get atRest() { return atRest; } };
begin();

async function begin() {
  let refused = null;
  const linked = textOf(location.hash).catch(({ message }) => {
    refused = message;
    return null;
  });
  try {
    engine = new Engine(await compile($("#engine").textContent));
  } catch (error) {
    note(`This browser cannot run the engine (${error.message}): it needs WebAssembly with 128-bit SIMD, as all browsers since 2023 have it.`, true);
    return;
  }
  globalThis.instrument.compiled = performance.now();
  const text = await linked;
  const opened = text === null ? load(examples[0].name, examples[0].text) : load(UNNAMED, text);
  await opened.catch(({ message }) => note(`The spec cannot be shown: ${message}.`, true));
  if (refused) note(`${refused}. This is an example instead.`, true);
  root.dataset.ready = "yes";
}

/** Puts a spec into the editor and reads it. */
async function load(given, text) {
  name = given;
  editor.text = text;
  kept = editor.text;
  clearTimeout(edited.waiting);
  return read();
}

/** The spec was changed: it is read when the keys rest. */
function edited() {
  clearTimeout(edited.waiting);
  edited.waiting = setTimeout(read, PAUSE);
}

/** Reads the spec, and shows its mistakes or the crane at rest. Reads again if it was changed meanwhile. */
async function read() {
  if (!engine) return;
  if (read.busy) {
    read.again = true;
    return;
  }
  read.busy = true;
  const begin = performance.now();
  engine.abandon(["run", "chart"], "ended: the spec was changed");
  try {
    const opened = await ask({ ask: "open", name, text: editor.text });
    problems(opened.diagnostics);
    if (opened.name) {
      const same = crane && alike(crane, opened);
      crane = opened;
      document.title = `${crane.title || spoken(crane.name)} · Crane`;
      $("h1").textContent = crane.title || spoken(crane.name);
      if (!same) {
        rest.open(crane);
        chart.open(crane);
      }
      drive.open(crane);
      run.open(crane);
      await statics(begin);
    } else {
      const count = opened.diagnostics.length;
      note(`${count} mistake${count === 1 ? "" : "s"}: ${crane ? "the crane is as before" : "there is no crane yet"}`, true);
    }
  } catch ({ message }) {
    problems([]);
    note(message, true);
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
  do {
    moved.again = false;
    drive.stop();
    await statics(performance.now());
  } while (moved.again);
  moved.busy = false;
}

/** The crane at rest. */
async function statics(begin) {
  try {
    const shown = stage.show(await ask({ ask: "rest", ...rest.given }));
    atRest = shown;
    rest.show(shown);
    modes.show(shown.crane, shown.rest.stable);
    const took = performance.now() - begin;
    globalThis.instrument.took = took;
    const { stable, words, why } = shown.rest;
    note(`${stable ? `At rest: ${words}` : why ?? words} · ${crane.coordinates} coordinate${crane.coordinates === 1 ? "" : "s"} · ${Math.round(took)} ms`, !stable);
  } catch ({ message }) {
    note(message, true);
  }
}

/** The line under the crane. */
function note(words, bad = false) {
  $("#state").textContent = words;
  $("#state").classList.toggle("bad", bad);
}

/** Mistakes and warnings under the editor, as in the terminal, and underlined in it. */
function problems(diagnostics) {
  editor.mark(diagnostics, name);
  $("#problems").replaceChildren(...diagnostics.map(({ code, severity, file, line, column, message, label, help }) => {
    const place = element("button", { type: "button", textContent: `${file === name ? "" : `${file}:`}${line}:${column}`, title: "Go there" });
    place.disabled = file !== name;
    place.addEventListener("click", () => {
      choose(matchMedia("(max-width: 900px)").matches ? "spec" : tab);
      editor.show(line, column);
    });
    const words = element("div", {}, element("strong", { textContent: `${message} [${code}]` }));
    if (label) words.append(element("span", { textContent: label }));
    if (help) words.append(element("span", { className: "help", textContent: `help: ${help}` }));
    return element("li", { className: severity }, place, words);
  }));
  root.classList.toggle("mistaken", diagnostics.some(({ severity }) => severity === "error"));
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
  if (chosen === "run") run.again();
  else if (["rest", "modes", "chart"].includes(chosen) && atRest && ["run", "drive"].includes(left)) {
    stage.present(atRest.crane);
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
  const example = $("#example");
  examples.forEach(({ name: own, about }, index) => example.append(new Option(`${spoken(own.replace(".yaml", ""))}${about ? ` – ${about}` : ""}`, index)));
  example.addEventListener("change", () => {
    const chosen = examples[example.value];
    example.value = "";
    if (chosen) load(chosen.name, chosen.text);
  });
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
  $("#share").addEventListener("click", share);
  addEventListener("hashchange", async () => {
    try {
      const text = await textOf(location.hash);
      if (text !== null && text !== editor.text) load(UNNAMED, text);
    } catch ({ message }) {
      note(message, true);
    }
  });
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
  if (file.size > MOST) note(`${file.name} is longer than ${MOST >> 20} MB: that is not a spec`, true);
  else load(file.name, await file.text());
}

/** Puts the spec into the address, and the address where it can be pasted from. */
async function share() {
  history.replaceState(null, "", await fragment(editor.text));
  kept = editor.text;
  const words = "The address now contains the whole spec";
  try {
    await navigator.clipboard.writeText(location.href);
    note(`${words}, and is copied.`);
  } catch {
    note(`${words}: copy it from the browser's address bar.`);
  }
}
