// The crane at rest: sliders for live parameters and positions of drives, key figures, tables.
import { DEGREES, spoken } from "../../src/data.js";
import { element } from "../../src/element.js";
import { results } from "../../src/tables.js";
import { tile, tiles } from "../../src/tiles.js";
import { typed } from "./engine.js";

/** Travel of a slider to either side of where a drive begins, if it has no stops: degrees, m. */
const TRAVEL = { rad: 60, m: 1 };

/** A slider and a field for the same number. `change(value)` gets it in SI units, `refuse(words)` why what was typed is none. */
function slider({ name, about, unit, least, most }, value, { ask, change, refuse }) {
  const turns = unit === "rad";
  const factor = turns ? DEGREES : 1;
  const shown = (number) => Number((number * factor).toPrecision(6));
  const [low, high] = [shown(least), shown(most)];
  const label = `${spoken(name)}${unit || turns ? `, ${turns ? "°" : unit}` : ""}`;
  const step = 10 ** Math.floor(Math.log10((high - low) / 200));
  const bar = element("input", { type: "range", min: low, max: high, step, value: shown(value) });
  const field = element("input", { className: "number", autocomplete: "off", value: shown(value) });
  bar.setAttribute("aria-label", label);
  field.setAttribute("aria-label", `${label}, exact`);
  const take = (number) => {
    field.ariaInvalid = false;
    change(number);
  };
  bar.addEventListener("input", () => {
    field.value = bar.value;
    take(Number(bar.value) / factor);
  });
  field.addEventListener("input", async () => {
    const text = field.value;
    const isCurrent = () => text.trim() && field.value === text;
    try {
      const number = await typed(ask, text, { name, unit, factor });
      if (!isCurrent()) return;
      bar.value = shown(number);
      take(number);
    } catch ({ message }) {
      if (!isCurrent()) return;
      field.ariaInvalid = true;
      refuse(message);
    }
  });
  return element("div", { className: "slider", title: about }, element("span", { textContent: spoken(name) }), bar, field, element("span", { className: "soft", textContent: turns ? "°" : unit }));
}

export class Rest {
  /** `changed()` is called when a slider moves, `write()` when its numbers are to be those of the spec, `refuse(words)` when a text is no number. */
  constructor(host, { ask, changed, write, refuse }) {
    this.sliders = host.querySelector(".sliders");
    this.results = host.querySelector(".results");
    Object.assign(this, { ask, changed, write, refuse });
  }

  /** Sliders of another crane; `given`: where they stand, if not at the numbers of the spec (see `state`). */
  open(crane, given = {}) {
    const number = (numbers, name, usual) => (Number.isFinite(numbers?.[name]) ? numbers[name] : usual);
    this.crane = crane;
    this.parameters = crane.parameters.map(({ name, value }) => number(given.parameters, name, value));
    this.positions = crane.drives.map(({ name, start }) => number(given.positions, name, start));
    this.moved = crane.drives.some(({ start }, index) => this.positions[index] !== start);
    const again = () => this.open(crane);
    const parameters = crane.parameters.map((one, index) => {
      const around = Math.abs(one.value) || 1;
      const least = Math.max(one.least, one.value < 0 ? -2 * around : 0);
      const slide = { ...one, least: one.value === 0 && one.least < 0 ? -1 : least, most: Math.min(one.most, one.value <= 0 && one.value !== 0 ? 0 : 2 * around) };
      return this.slider(slide, this.parameters, index);
    });
    const drives = crane.drives.map((one, index) => {
      const way = TRAVEL[one.unit] / (one.unit === "rad" ? DEGREES : 1);
      const [low, high] = one.stops;
      const slide = { ...one, about: "position of the drive", least: low ?? one.start - way, most: high ?? one.start + way };
      return this.slider(slide, this.positions, index, true);
    });
    const group = (title, rows) => (rows.length ? [element("fieldset", {}, element("legend", { textContent: title }), ...rows)] : []);
    const reset = element("button", { type: "button", textContent: "As in the spec", title: "All sliders back to the numbers of the spec" });
    reset.addEventListener("click", () => {
      again();
      this.changed();
    });
    const write = element("button", { type: "button", textContent: "Into the spec", title: "Write the numbers of the sliders into the spec" });
    write.addEventListener("click", this.write);
    const buttons = parameters.length + drives.length ? [element("div", { className: "bar" }, reset, write)] : [];
    this.sliders.replaceChildren(...group("Live parameters", parameters), ...group("Positions of the drives", drives), ...buttons);
  }

  slider(slide, numbers, index, moves = false) {
    const change = (value) => {
      numbers[index] = value;
      if (moves) this.moved = true;
      this.changed();
    };
    return slider(slide, numbers[index], { ...this, change });
  }

  /** The numbers of the sliders that are not those of the spec, by name. */
  get state() {
    const other = (all, numbers, own) => Object.fromEntries(all.map((one, index) => [one.name, numbers[index], own(one)]).filter(([, now, usual]) => now !== usual));
    const { parameters, drives } = this.crane ?? { parameters: [], drives: [] };
    return { parameters: other(parameters, this.parameters, ({ value }) => value), positions: other(drives, this.positions, ({ start }) => start) };
  }

  /** What to ask the engine: positions only once a drive was moved. */
  get given() {
    return { parameters: this.parameters, positions: this.moved ? this.positions : [] };
  }

  /** Shows figures and tables; figures of modes, which follow later, fade until then. */
  show({ figures, verdict, tables, rest: { stable } }) {
    const [sentence, host, grids] = [element("p", { id: "rest_verdict" }), element("div", { id: "rest_tiles" }), element("div", { className: "tables" })];
    const open = new Set([...this.results.querySelectorAll("details[open]")].map(({ id }) => id));
    const waiting = stable ? [...this.results.querySelectorAll("#rest_tiles .later")] : [];
    this.results.replaceChildren(sentence, host, grids);
    tiles({ figures, verdict }, sentence, host);
    for (const tile of waiting) tile.classList.add("old");
    host.append(...waiting);
    this.statics = figures.length;
    results(tables, grids);
    for (const one of this.results.querySelectorAll("details")) one.open = open.has(one.id);
  }

  /** Shows all figures, now also those of modes. */
  vibrates(figures) {
    const host = this.results.querySelector("#rest_tiles");
    for (const old of host.querySelectorAll(".later")) old.remove();
    host.append(...figures.slice(this.statics).map((figure) => {
      const made = tile(figure);
      made.classList.add("later");
      return made;
    }));
  }
}
