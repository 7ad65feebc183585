// The report page: puts viewer, plots and tables together.
import "uplot/dist/uPlot.min.css";
import "./style.css";
import { fragment } from "../instrument/src/link.js";
import { chart } from "./chart.js";
import { moves } from "./moves.js";
import { PULLS, gradient } from "./colours.js";
import { at, measured, place, read, scaled, spoken } from "./data.js";
import { save, table } from "./download.js";
import { faults } from "./faults.js";
import { follow, panels } from "./panels.js";
import { Player } from "./player.js";
import { sign } from "./sign.js";
import { modeText, tables } from "./tables.js";
import { tiles } from "./tiles.js";
import { Viewer, exaggeration } from "./viewer.js";

/** Width of a plot on paper, two of which fit on A4 side by side, CSS pixels; that of a path, which has a line to itself. */
const PAPER = { plot: 312, path: 520 };
/** Time in which a crane at rest shows a mode, s. */
const REST = 10;
/** Time step of the arrow keys, s. */
const STEP = 0.1;

const $ = (selector) => document.querySelector(selector);
faults((textContent) => Object.assign($("#fault"), { textContent, hidden: false }));
const data = read();
const { crane, rigid } = data;
/** Without a record of a run, the crane is at rest. */
const atRest = !crane.record;
document.documentElement.classList.toggle("at_rest", atRest);
const player = new Player(atRest ? REST : (crane.run.t.at(-1) ?? 0));

document.title = `${crane.title} · report`;
$("h1").textContent = crane.title;
$("#name").textContent = crane.name;
instrument();
thinned();
tables(data);
tiles(data);
if (!atRest) sign(data);
chart(data);
moves(data);
document.documentElement.dataset.theme = matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
const shown = [];
const { plots, along } = atRest ? { plots: [], along: [] } : panels(data, player);
// Sections that do not apply to this crane.
const missing = [...document.querySelectorAll("section:has(> .panels:empty)")];
if (!data.tables) missing.push($("#tables"));
if (atRest) missing.push($("#repeat"), $("#sign"));
for (const section of missing) {
  $(`nav [href="#${section.id}"]`).remove();
  section.remove();
}
navigation();
const viewer = threeD();
controls();
now();
keys();
printing();

let waiting = false;
player.follow((t) => {
  const here = place(crane.run.t, t);
  $("#time").value = t;
  $("#clock").textContent = `${t.toFixed(2)} s`;
  if (waiting) return;
  // Plots are updated once per frame of the screen, however often time is set.
  waiting = true;
  requestAnimationFrame(() => {
    waiting = false;
    plotsFollow();
  });
  readings(here);
});
// Plots that come into view have missed changes of time.
addEventListener("scroll", plotsFollow, { passive: true });
// For the console of the browser, and for the test.
globalThis.report = { data, player, plots, viewer };
document.documentElement.dataset.ready = "yes";
if (!matchMedia("(prefers-reduced-motion: reduce)").matches && viewer && !atRest) player.play(true);

/** Scrolls to sections by script: in the frame of a notebook, a fragment would open the notebook itself. */
function navigation() {
  for (const link of document.querySelectorAll("nav a")) {
    link.addEventListener("click", (event) => {
      event.preventDefault();
      $(link.getAttribute("href")).scrollIntoView();
    });
  }
}

/** Offers to open the spec in the page as an instrument, if its address is known. */
async function instrument() {
  if (!data.instrument || !data.spec) return;
  const href = data.instrument + (await fragment(data.spec));
  Object.assign($("#instrument"), { href, hidden: false, title: "The spec as it is written, with its own parameters, in the page as an instrument" });
}

/** Adds a note if a run has more samples than the page. */
function thinned() {
  const { every, rows } = crane.run;
  if (every === 1) return;
  const text = `This page shows one of every ${every} recorded samples, ${rows} in all. Tables and the CSV files of crane run contain every sample.`;
  Object.assign($("#thinned"), { textContent: text, hidden: false });
}

/** Brings the plots on the screen to the present time. */
function plotsFollow() {
  const here = place(crane.run.t, player.t);
  for (const plot of plots) if (seen(plot.frame)) plot.now(player.t, here);
  follow(along.filter(({ plot }) => seen(plot.frame)), here);
}

/** Whether an element is on the screen. */
function seen(element) {
  const { top, bottom } = element.getBoundingClientRect();
  return bottom > 0 && top < innerHeight;
}

/** The view in three dimensions; without WebGL, a message instead. */
function threeD() {
  try {
    return new Viewer($("#view canvas"), data, player);
  } catch (error) {
    const text = `3-D is not available in this browser (${error.message}). Plots and tables are complete.`;
    for (const overlay of document.querySelectorAll("#view .overlay")) overlay.hidden = true;
    $("#view canvas").replaceWith(Object.assign(document.createElement("p"), { textContent: text, className: "sorry" }));
    return null;
  }
}

function controls() {
  const play = $("#play");
  player.changed = () => {
    play.textContent = player.playing ? "❚❚" : "▶";
    play.setAttribute("aria-label", player.playing ? "Pause" : "Play");
  };
  play.addEventListener("click", () => player.play(!player.playing));
  $("#whole").textContent = `of ${player.duration.toFixed(2)} s`;
  Object.assign($("#time"), { max: player.duration, step: "any" });
  $("#time").addEventListener("input", ({ target }) => player.seek(Number(target.value)));
  $("#speed").addEventListener("change", ({ target }) => (player.speed = Number(target.value)));
  $("#theme").addEventListener("click", () => theme(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));
  $("#all")?.addEventListener("click", () => save(`${crane.name}.csv`, table(crane.run.list), "text/csv"));
  if (rigid) $("#all_rigid")?.addEventListener("click", () => save(`${rigid.name}.csv`, table(rigid.run.list), "text/csv"));
  else $("#all_rigid")?.remove();
  if (!viewer) return;
  const flexible = crane.scene.bodies.some((body) => body.length > 0);
  const factor = $("#factor");
  const exaggerate = () => {
    const { factor: larger, words } = exaggeration(factor.value);
    $("#factor_text").textContent = words;
    viewer.set({ factor: larger });
  };
  factor.addEventListener("input", exaggerate);
  exaggerate();
  if (!flexible && !crane.modes.length) factor.closest("label").remove();
  const check = (id, key, has) => {
    if (!has) return $(id).closest("label").remove();
    return $(id).addEventListener("change", ({ target }) => viewer.set({ [key]: target.checked }));
  };
  check("#ghost", "ghost", rigid);
  check("#trace", "trace", !atRest && crane.scene.points.length);
  check("#arrows", "arrows", crane.scene.supports.length);
  check("#tipping", "tipping", viewer.lines.length);
  check("#used", "use", viewer.used.beams.length);
  $("#used")?.addEventListener("change", ({ target }) => ($("#use_scale").hidden = !target.checked));
  $("#use_scale i").style.background = gradient;
  [$("#use_scale span").textContent, $("#use_scale b").textContent] = viewer.useInWords;
  recording();
  document.querySelectorAll("[data-view]").forEach((button) => button.addEventListener("click", () => viewer.look(button.dataset.view)));
  const mode = $("#mode");
  crane.modes.forEach((one, index) => mode.append(new Option(modeText(one, index), index)));
  // A crane at rest moves only in a mode.
  if (atRest) mode.options[0].textContent = "at rest";
  mode.addEventListener("change", () => {
    viewer.vibrate(mode.value === "" ? null : crane.modes[Number(mode.value)]);
    $("#mode_note").hidden = mode.value === "";
    if (mode.value !== "") $("#mode_note").textContent = `mode ${modeText(crane.modes[Number(mode.value)], Number(mode.value))}: about the static pose, not to scale, slowed down`;
    // Values and time are those of the motion, not of the mode.
    $("#now").classList.toggle("idle", mode.value !== "");
    if (mode.value !== "") player.play(true);
  });
  if (!crane.modes.length) mode.closest("label").remove();
  if (crane.scene.supports.length) {
    $("#scale i").style.background = gradient;
    const { unit, factor: larger } = scaled("N", [viewer.greatest]);
    $("#scale b").textContent = measured(viewer.greatest * larger, unit);
    $("#pulls").hidden = !viewer.pulls;
    $("#pulls i").style.background = PULLS;
  } else $("#scale").remove();
}

/** Pictures and films of the view. */
function recording() {
  $("#picture").addEventListener("click", async () => save(`${crane.name}_${player.t.toFixed(2)}s.png`, await viewer.picture(), "image/png"));
  const film = $("#video");
  const type = ["video/webm;codecs=vp9", "video/webm", "video/mp4"].find((type) => globalThis.MediaRecorder?.isTypeSupported(type));
  if (!type || !player.duration) return film.remove();
  film.addEventListener("click", () => {
    const recorder = new MediaRecorder($("#view canvas").captureStream(), { mimeType: type, videoBitsPerSecond: 8e6 });
    const parts = [];
    recorder.addEventListener("dataavailable", ({ data }) => parts.push(data));
    recorder.addEventListener("stop", () => {
      Object.assign(film, { textContent: "Video", disabled: false });
      save(`${crane.name}.${type.startsWith("video/mp4") ? "mp4" : "webm"}`, new Blob(parts, { type }), type);
    });
    Object.assign(film, { textContent: "Recording …", disabled: true });
    player.once(() => recorder.stop());
    recorder.start();
  });
}

/** Values next to the view, at the present time. */
function now() {
  const list = $("#now dl");
  const value = (label, name, from = crane) => {
    const column = from.run.column(name);
    if (!column) return;
    const { unit, factor } = scaled(column.unit, column.values);
    const term = Object.assign(document.createElement("dt"), { textContent: label });
    const number = document.createElement("dd");
    list.append(term, number);
    shown.push((here) => (number.textContent = measured(at(column.values, here) * factor, unit)));
  };
  const { points } = crane.scene;
  const [point] = points.slice(points.length >> 1);
  if (point) for (const axis of ["x", "y", "z"]) value(`${spoken(point.name)} ${axis}`, `${point.name}_${axis}`);
  for (const j of crane.drives) {
    const { name, force_unit: unit } = crane.coordinates[j];
    const effort = unit === "N" ? "force" : "torque";
    value(`${spoken(name)}, ${effort}`, `${name}_drive_${effort}`);
  }
  if (!atRest) value("kinetic energy", "kinetic_energy");
}

function readings(here) {
  for (const show of shown) show(here);
}

function keys() {
  addEventListener("keydown", (event) => {
    const own = event.target.closest("input, select, textarea, button, summary, figure, canvas, a");
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const acts = {
      " ": () => player.play(!player.playing),
      ArrowLeft: () => player.seek(player.t - STEP),
      ArrowRight: () => player.seek(player.t + STEP),
      Home: () => player.seek(0),
      End: () => player.seek(player.duration),
    };
    if (own || !acts[event.key]) return;
    event.preventDefault();
    acts[event.key]();
  });
}

/** Paper has another width, and nothing on it unfolds. */
function printing() {
  let unfolded = [];
  addEventListener("beforeprint", () => {
    unfolded = [...document.querySelectorAll("details.table:not([open])")];
    for (const details of unfolded) details.open = true;
    for (const plot of plots) plot.resize(plot.kind === "path" ? PAPER.path : PAPER.plot);
    viewer?.finish();
  });
  addEventListener("afterprint", () => {
    for (const details of unfolded) details.open = false;
    for (const plot of plots) plot.resize();
  });
}

function theme(name) {
  document.documentElement.dataset.theme = name;
  viewer?.theme();
  plots.forEach((plot) => plot.theme());
}
