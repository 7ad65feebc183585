// Load charts: the largest load within limits over the positions of one or two drives.
import { DEGREES, measured, readable, spoken, always } from "../../src/data.js";
import { element } from "../../src/element.js";
import { Plot } from "../../src/plot.js";
import { grid } from "../../src/tables.js";
import { typed } from "./engine.js";

/** Longest chart of a page, s of computing. */
const PATIENCE = 300;
/** Values of the first and of the second drive unless chosen otherwise; more curves have no colours of their own. */
const COUNTS = [13, 4];
const MOST = [61, 8];

export class LoadChart {
  /** `ask(request, seconds)` asks the engine, `given()` is what the sliders say. */
  constructor(host, { ask, given }) {
    Object.assign(this, { ask, given, plots: [], axes: [] });
    this.form = host.querySelector("form");
    this.state = host.querySelector("#chart_state");
    this.results = host.querySelector(".results");
    this.form.addEventListener("submit", (event) => {
      event.preventDefault();
      this.start();
    });
  }

  /** Another crane; `given`: what was chosen for it (see `chosen`). */
  open(crane, given = {}) {
    this.crane = crane;
    this.clear();
    this.axes = [];
    const loads = crane.parameters.filter(({ unit }) => unit !== "rad" && unit !== "m");
    const masses = loads.filter(({ unit }) => unit === "kg");
    this.state.textContent = "";
    if (!loads.length || !crane.drives.length) {
      this.form.replaceChildren();
      this.state.textContent = "A load chart varies positions of drives and a live parameter that is the load: this crane does not have both.";
      return;
    }
    this.load = element("select", {}, ...loads.map(({ name, unit }) => new Option(`${spoken(name)} [${unit}]`, name)));
    this.load.value = (loads.find(({ name }) => name === given.load) ?? masses[0] ?? loads[0]).name;
    // Most charts vary what lifts and what reaches; what slews comes first in a crane.
    const usual = [[0, 1], [0, 1], [0, 1], [0, 2]][crane.drives.length] ?? [1, 3];
    this.axes = usual.map((chosen, axis) => this.axis(axis, chosen, given.axes?.[axis]));
    const submit = element("button", { type: "submit", className: "main", textContent: "Compute" });
    this.form.replaceChildren(
      element("label", {}, "load ", this.load), ...this.axes.map(({ host }) => host), submit,
      element("p", { className: "soft", textContent: "Limits: stable rest, tipping, utilisation of beams 1, and the pressures, strokes, stops and efforts that the spec gives. No dynamic factor, no wind, no buckling; not a rating to any standard." }),
    );
  }

  /** What is chosen. */
  get chosen() {
    return this.axes.length ? { load: this.load.value, axes: this.axes.map(({ fields }) => fields.map(({ value }) => value)) } : {};
  }

  /** A drive and its range; `given`: values of its fields. */
  axis(axis, chosen, given) {
    const { drives } = this.crane;
    const select = element("select", {}, ...drives.map(({ name }, index) => new Option(spoken(name), index)));
    if (axis === 1) select.prepend(new Option("none", ""));
    select.value = drives[chosen] ? chosen : "";
    const number = (ariaLabel, attributes) => element("input", { className: "number", autocomplete: "off", ariaLabel, ...attributes });
    const [from, to] = [number("from"), number("to")];
    const count = number("how many", { type: "number", value: COUNTS[axis], min: 1, max: MOST[axis], step: 1 });
    const unit = element("span", { className: "soft" });
    const fit = () => {
      const drive = drives[select.value];
      if (!drive) return;
      const turns = drive.unit === "rad";
      const [before, after] = turns ? [30, 30] : [0, 0.5];
      const factor = turns ? DEGREES : 1;
      const [low, high] = drive.stops;
      const shown = (value) => Number(value.toPrecision(4));
      from.value = shown(low === null ? drive.start * factor - before : low * factor);
      to.value = shown(high === null ? drive.start * factor + after : high * factor);
      unit.textContent = turns ? "°" : "m";
    };
    select.addEventListener("change", fit);
    fit();
    const fields = [select, from, to, count];
    if (Array.isArray(given) && given.length === fields.length && given.every((value) => typeof value === "string")) {
      fields.forEach((field, index) => (field.value = given[index]));
      unit.textContent = drives[select.value]?.unit === "rad" ? "°" : "m";
    }
    const host = element("fieldset", { className: "axis" }, element("legend", { textContent: axis === 0 ? "along the axis" : "curve by curve" }), select, from, " … ", to, unit, count, element("span", { className: "soft", textContent: "values" }));
    const range = async () => {
      const drive = drives[select.value];
      if (!drive) return null;
      const factor = drive.unit === "rad" ? DEGREES : 1;
      const [first, last] = await Promise.all([from, to].map(({ value }) => typed(this.ask, value, { ...drive, factor })));
      const counted = Math.min(Math.max(Math.round(Number(count.value)) || 1, 1), MOST[axis]);
      return { drive: Number(select.value), from: first, to: last, count: counted };
    };
    return { host, range, fields };
  }

  clear() {
    for (const plot of this.plots) plot.plot.destroy();
    this.plots = [];
    this.results.replaceChildren();
  }

  async start() {
    this.clear();
    try {
      const [along, by] = await Promise.all(this.axes.map(({ range }) => range()));
      if (!along || along.drive === by?.drive) {
        this.state.textContent = "Choose two different drives, or none for the curves.";
        return;
      }
      this.state.textContent = "computing …";
      const ranges = by ? [by, along] : [along];
      const chart = await this.ask({ ask: "chart", ...this.given(), load: this.load.value, ranges }, PATIENCE);
      const free = chart.poses.filter(({ load, limit }) => load !== null && limit === null).length;
      const words = free ? `; ${free} without a limit up to the largest load that was tried: this crane has no rating there` : "";
      this.state.textContent = `${chart.poses.length} poses in ${(chart.took / 1000).toFixed(2)} s${words}`;
      this.show(chart, along, by);
    } catch ({ message }) {
      this.state.textContent = message;
    }
  }

  show({ poses, load, unit, point, radius_from: axle }, along, by) {
    const { drives, name } = this.crane;
    const drive = (range) => drives[range.drive];
    const shown = (range) => always(drive(range).unit);
    const [x, y] = [shown(along), by && shown(by)];
    const rows = Array.from({ length: by?.count ?? 1 }, (_, k) => poses.slice(k * along.count, (k + 1) * along.count));
    const label = (row) => (by ? `${spoken(drive(by).name)} ${measured(row[0].at[0] * y.factor, y.unit)}` : spoken(load));
    const axis = { label: spoken(drive(along).name), unit: x.unit, values: Float64Array.from(rows[0], ({ at }) => at.at(-1) * x.factor) };
    const host = element("div", { className: "panels" });
    this.results.append(host);
    this.plots = [new Plot(host, {
      prefix: name, id: "load_chart_plot", kind: "along", title: `Largest ${spoken(load)}`, height: 320, x: axis, y: { label: spoken(load), unit },
      curves: rows.map((row, colour) => ({ label: label(row), colour, values: row.map((pose) => pose.load) })),
    })];
    this.results.append(grid({
      key: "chart", title: `Largest ${spoken(load)}, and what limits it`,
      headers: [...(by ? [`${spoken(drive(by).name)} [${y.unit}]`] : []), `${axis.label} [${x.unit}]`, `radius of ${spoken(point)} from ${spoken(axle)} [m]`, "height [m]", `${spoken(load)} [${unit}]`, "limit", "where"],
      numeric: [...(by ? [true] : []), true, true, true, true, false, false],
      rows: poses.map((pose) => [
        ...(by ? [readable(pose.at[0] * y.factor)] : []), readable(pose.at.at(-1) * x.factor), readable(pose.radius), readable(pose.height), readable(pose.load), pose.limit ?? "none", spoken(pose.where ?? ""),
      ]),
    }));
  }

  theme() {
    for (const plot of this.plots) plot.theme();
  }
}
