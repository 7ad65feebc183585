// Driving: the motion of the crane in real time, with levers.
import uPlot from "uplot";
import { curve, style } from "../../src/colours.js";
import { DEGREES, known, readable, scaled, spoken, tickText } from "../../src/data.js";
import { save, table } from "../../src/download.js";
import { element } from "../../src/element.js";
import { Levers } from "./levers.js";

/** Error per step that is accepted, m and rad: as long as there is time, and where there is none. */
const TOLERANCE = { fine: 1e-4, coarse: 1e-2, change: 3 };
/** Parts of real time that computing may take before the tolerance is raised, and below which it is lowered. */
const SHARE = { high: 0.6, low: 0.2 };
/** Time between two pictures up to which the crane keeps pace, s; what is more is given up, and the page says so. */
const LAG = 0.5;
/** Time over which the pace is measured, s, and that of the strip, s. */
const PACE = 1;
const STRIP = 20;
/** Longest record, s. */
const RECORD = 600;
/** Interval of the gauges, s: faster numbers cannot be read. */
const GAUGES = 0.1;
/** End of the scale of pressures of a cylinder whose spec gives no maximum, Pa. */
const USUAL = 3e7;

const $ = (selector) => document.querySelector(selector);

export class Drive {
  /** `ask(request, seconds)` asks the engine, `given()` is what the sliders say, `before()` ends everything else, `note(words)` is the line under the crane. */
  constructor(stage, { ask, given, before, note }) {
    Object.assign(this, { stage, ask, given, before, note, on: false });
    this.levers = new Levers($("#levers"));
    $("#engage").addEventListener("click", () => (this.on ? this.stop() : this.start()));
    $("#record").addEventListener("click", () => this.export());
  }

  /** Another spec: what was driven until now can still be saved. */
  open(crane) {
    const words = this.on ? `ended at ${this.t.toFixed(1)} s: the spec was changed` : "";
    this.stop();
    this.opened = crane;
    $("#cockpit").hidden = true;
    $("#engage").disabled = !crane.drives.length;
    $("#drive_state").textContent = crane.drives.length ? words : "This crane has no drives.";
  }

  async start() {
    this.before();
    $("#engage").disabled = true;
    $("#drive_state").textContent = "coming to rest …";
    try {
      const data = await this.ask({ ask: "drive", ...this.given() });
      const { crane } = this.stage.show(data);
      this.crane = crane;
      this.begin(crane);
    } catch ({ message }) {
      $("#drive_state").textContent = message;
    }
    $("#engage").disabled = false;
  }

  begin(crane) {
    const { list } = crane.run;
    this.rest = Float64Array.from(list, ({ values }) => values[0]);
    this.levers.open(this.opened.drives);
    Object.assign(this, { on: true, tolerance: TOLERANCE.fine, t: 0, zero: null, rows: [], pictures: [], spent: [], gauged: 0 });
    this.stage.drive(true);
    $("#drive_state").textContent = "";
    this.note("Driven in real time");
    $("#cockpit").hidden = false;
    $("#engage").textContent = "Stop";
    $("#record").hidden = true;
    this.instruments(crane);
    this.turn = (this.turn ?? 0) + 1;
    requestAnimationFrame((now) => this.frame(now, this.turn));
    $("#levers .track")?.focus({ preventScroll: true });
  }

  stop(words = "") {
    if (!this.on) return;
    this.on = false;
    this.levers.release();
    this.stage.drive(false);
    $("#engage").textContent = "Drive";
    $("#pace").textContent = "";
    $("#drive_state").textContent = words || `driven for ${this.t.toFixed(1)} s`;
    this.note(`Where it was after ${this.t.toFixed(1)} s of driving`);
    $("#record").hidden = !this.rows?.length;
  }

  /** One picture: asks for the state now, and draws it when it is known. */
  async frame(now, turn) {
    if (!this.on || turn !== this.turn) return;
    if (document.hidden) this.zero = null;
    this.zero ??= now / 1000 - this.t;
    let to = now / 1000 - this.zero;
    if (to - this.t > LAG) {
      // What cannot be computed in time is given up.
      this.zero += to - this.t - LAG;
      to = this.t + LAG;
    }
    try {
      const { t, row, margins, took } = await this.ask({ ask: "advance", to: Math.max(to, this.t), levers: this.levers.read(), tolerance: this.tolerance });
      if (!this.on || turn !== this.turn) return;
      this.spend(t - this.t, took / 1000);
      this.t = t;
      this.stage.follow(row, margins, took / 1000);
      this.keep(row);
      this.pictures.push(performance.now() / 1000);
      if (t - this.gauged > GAUGES || t < this.gauged) {
        this.gauged = t;
        this.gauge(row, margins);
      }
    } catch ({ message }) {
      if (turn === this.turn) this.stop(`ended at ${this.t.toFixed(2)} s: ${message}`);
      return;
    }
    requestAnimationFrame((next) => this.frame(next, turn));
  }

  /** Chooses the tolerance by the share of real time that computing takes. */
  spend(passed, took) {
    this.spent.push([passed, took]);
    const sum = (index) => this.spent.reduce((total, one) => total + one[index], 0);
    while (this.spent.length > 1 && sum(0) > PACE) this.spent.shift();
    const share = sum(1) / Math.max(sum(0), 1e-3);
    this.share = share;
    if (this.spent.length < 5) return;
    const { fine, coarse, change } = TOLERANCE;
    const next = share > SHARE.high ? this.tolerance * change : share < SHARE.low ? this.tolerance / change : this.tolerance;
    const bounded = Math.min(Math.max(next, fine), coarse);
    if (bounded !== this.tolerance) {
      this.tolerance = bounded;
      this.spent = [];
    }
  }

  keep(row) {
    if (this.t <= RECORD) this.rows.push(Float32Array.from(row));
    else if (!$("#drive_state").textContent) $("#drive_state").textContent = `Only the first ${RECORD / 60} minutes are recorded.`;
  }

  /** What is shown all the time. */
  instruments(crane) {
    const { list } = crane.run;
    const named = (ending) => list.map(({ name }, index) => ({ name, index })).filter(({ name }) => name.endsWith(ending));
    this.free = crane.coordinates.map(({ role, unit }, index) => ({ role, unit, index: index + 1 })).filter(({ role, unit }) => role === "passive" && unit === "rad");
    this.feet = named("_reaction_z");
    const most = (cylinder) => this.opened.cylinders.find(({ name }) => name === cylinder)?.most;
    this.pressures = [...named("_piston_pressure"), ...named("_rod_pressure")].sort((a, b) => a.index - b.index)
      .map((one) => ({ ...one, most: most(one.name.replace(/_(piston|rod)_pressure$/, "")) ?? Infinity }));
    this.greatest = Math.max(...this.feet.map(({ index }) => Math.abs(this.rest[index])), 1);
    const gauge = (title) => {
      const fill = element("i", {});
      const value = element("output", {});
      value.setAttribute("aria-live", "off");
      return { fill, value, dom: element("div", { className: "gauge" }, element("span", { textContent: title }), element("div", { className: "scale" }, fill), value) };
    };
    const group = (title, gauges) => (gauges.length ? [element("div", { className: "group" }, element("h3", { textContent: title }), ...gauges.map(({ dom }) => dom))] : []);
    this.gauges = {
      tipping: crane.strength?.stability?.lines.length ? [gauge("tipping margin")] : [],
      swing: this.free.length ? [gauge("swing")] : [],
      feet: this.feet.map(({ name }) => gauge(spoken(name.replace("_reaction_z", "")))),
      pressures: this.pressures.map(({ name }) => gauge(spoken(name.replace("_piston_pressure", ", piston").replace("_rod_pressure", ", rod")))),
    };
    const { tipping, swing, feet, pressures } = this.gauges;
    $("#gauges").replaceChildren(...group("Safety", [...tipping, ...swing]), ...group("Forces of the feet", feet), ...group("Pressures", pressures));
    this.strip(list);
  }

  /** A curve of the last seconds, of any column. */
  strip(list) {
    this.chart?.destroy();
    const choice = element("select", {}, ...list.slice(1).map(({ name, unit }, index) => new Option(`${spoken(name)} [${unit}]`, index + 1)));
    choice.setAttribute("aria-label", "Column of the strip");
    choice.value = this.free.at(-1)?.index ?? 1;
    const host = element("div", { className: "plot" });
    $("#strip").replaceChildren(element("label", {}, "last 20 s of ", choice), host);
    const axis = (label, more) => ({ label, labelSize: 18, labelGap: 2, font: "12px system-ui", labelFont: "12px system-ui", stroke: () => style("--ink"), grid: { stroke: () => style("--line"), width: 1 }, ticks: { stroke: () => style("--line"), width: 1 }, values: (_, ticks) => ticks.map((tick) => (tick === null ? "" : tickText(tick))), ...more });
    const make = () => {
      this.chart?.destroy();
      this.column = Number(choice.value);
      const { name, unit } = list[this.column];
      this.shown = scaled(unit, [this.rest[this.column] || 1]);
      this.chart = new uPlot({
        width: host.clientWidth || 400, height: 170, legend: { show: false }, cursor: { show: false }, scales: { x: { time: false } },
        axes: [axis("t [s]", { size: 34 }), axis(`${spoken(name)} [${this.shown.unit}]`, { size: 58 })],
        series: [{}, { stroke: () => curve(0), width: 1.6 }],
      }, [[], []], host);
    };
    choice.addEventListener("change", make);
    make();
    this.observer?.disconnect();
    this.observer = new ResizeObserver(() => host.clientWidth && this.chart.setSize({ width: host.clientWidth, height: 170 }));
    this.observer.observe(host);
  }

  gauge(row, margins) {
    const set = ({ fill, value, dom }, share, text, bad) => {
      fill.style.width = `${100 * Math.min(Math.max(share, 0), 1)}%`;
      value.textContent = text;
      dom.classList.toggle("beyond", bad);
    };
    const { tipping: [tipping], swing: [swing], feet, pressures } = this.gauges;
    if (tipping) {
      // Where nothing stabilises there is none.
      const margin = Math.min(...margins.map((one) => one.margin ?? -Infinity));
      set(tipping, margin, known(margin) ? margin.toFixed(2) : "none", margin <= 0);
    }
    if (swing) {
      const angle = Math.max(...this.free.map(({ index }) => Math.abs(row[index] - this.rest[index]))) * DEGREES;
      set(swing, angle / 45, `${angle.toFixed(1)} °`, angle > 45);
    }
    this.feet.forEach(({ index }, at) => set(feet[at], row[index] / (2 * this.greatest), `${(row[index] / 1000).toFixed(1)} kN`, row[index] < 1));
    this.pressures.forEach(({ index, most }, at) => set(pressures[at], row[index] / Math.min(most, USUAL), `${(row[index] / 1e5).toFixed(0)} bar`, row[index] > most));
    const since = this.rows.findLastIndex(([t]) => t < this.t - STRIP) + 1;
    const last = this.rows.slice(since);
    this.chart.setData([last.map(([t]) => t), last.map((one) => one[this.column] * this.shown.factor)]);
    const now = performance.now() / 1000;
    while (this.pictures.length > 1 && now - this.pictures[0] > 2) this.pictures.shift();
    const rate = this.pictures.length > 1 ? (this.pictures.length - 1) / (this.pictures.at(-1) - this.pictures[0]) : 0;
    const first = this.paced?.find(({ at }) => now - at < 2);
    this.paced = [...(this.paced ?? []).filter(({ at, t }) => now - at < 2 && t <= this.t), { at: now, t: this.t }];
    const pace = first && now > first.at + 0.5 ? (this.t - first.t) / (now - first.at) : 1;
    this.rate = rate;
    this.pace = pace;
    const slow = pace < 0.97;
    $("#pace").textContent = `${this.t.toFixed(1)} s · ${slow ? `behind: ${readable(pace)} × real time` : "real time"} · ${Math.round(rate)} pictures/s`;
    $("#pace").classList.toggle("behind", slow);
  }

  /** Saves what was driven. */
  export() {
    const { list } = this.crane.run;
    const recorded = list.slice(0, this.rows[0].length);
    save(`${this.crane.name}_driven.csv`, table(recorded.map(({ name, unit }, index) => ({ name, unit, values: this.rows.map((row) => row[index]) }))), "text/csv");
  }

  theme() {
    this.chart?.redraw(false, true);
  }
}
