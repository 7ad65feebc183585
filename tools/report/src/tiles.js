// The figures to look at first.
import { range, readable, scaled, spoken } from "./data.js";
import { margins, used } from "./strength.js";

/** Largest magnitude in some columns, with its time and the other properties of its column. */
function greatest(columns, t) {
  let best = { size: -1 };
  for (const { values, ...rest } of columns) {
    values.forEach((value, row) => {
      if (Math.abs(value) > best.size) best = { ...rest, size: Math.abs(value), value, t: t[row] };
    });
  }
  return best;
}

const text = (value, unit) => {
  const { unit: shown, factor } = scaled(unit, [value]);
  return `${Number((value * factor).toPrecision(4))} ${shown}`;
};
/** Fills the tiles. */
export function tiles({ crane, rigid }) {
  const host = document.querySelector("#tiles");
  const { run, scene, coordinates, drives, modes } = crane;
  const { t } = run;
  const when = (time) => (crane.record ? `at ${Number(time.toPrecision(3))} s` : "at rest");
  const add = (title, value, note) => {
    const tile = document.createElement("div");
    const lines = [["span", title], ["strong", value], ["span", note]];
    tile.append(...lines.map(([tag, textContent]) => Object.assign(document.createElement(tag), { textContent })));
    host.append(tile);
  };
  if (rigid && scene.points.length) {
    const ways = scene.points.map(({ name }) => {
      const axes = ["x", "y", "z"].map((axis) => [crane, rigid].map((one) => one.run.column(`${name}_${axis}`).values));
      return { name, values: t.map((_, row) => Math.hypot(...axes.map(([own, other]) => own[row] - other[row]))) };
    });
    const most = greatest(ways, t);
    const rest = greatest(ways.map(({ values, ...way }) => ({ ...way, values: values.slice(0, 1) })), t);
    add("deflection at rest", text(rest.size, "m"), `compared with the rigid crane; up to ${text(most.size, "m")} in motion (${spoken(most.name)}, ${when(most.t)})`);
  }
  for (const [effort, unit] of [["torque", "N m"], ["force", "N"]]) {
    const columns = drives.map((j) => coordinates[j].name).map((name) => ({ name, values: run.column(`${name}_drive_${effort}`)?.values }));
    const known = columns.filter(({ values }) => values);
    if (!known.length) continue;
    const most = greatest(known, t);
    add(`largest drive ${effort}`, text(most.value, unit), `${spoken(most.name)}, ${when(most.t)}`);
  }
  if (scene.supports.length) {
    const columns = scene.supports.map(({ name }) => ({ name, values: run.column(`${name}_reaction_z`).values }));
    const [high, low] = [1, 0].map((end) => {
      const ends = columns.map(({ values }) => range(values)[end]);
      const value = end ? Math.max(...ends) : Math.min(...ends);
      return { value, name: columns[ends.indexOf(value)].name };
    });
    const { unit, factor } = scaled("N", [high.value, low.value]);
    const [from, to] = [low, high].map(({ value }) => Number((value * factor).toPrecision(4)));
    add("vertical reactions", `${from} … ${to} ${unit}`, low.value < 0 ? `${low.name} pulls on the ground: a real foot would lift` : `smallest ${low.name}, largest ${high.name}: no foot lifts`);
  }
  const { beams, unit: of } = used(crane);
  if (beams.length) {
    const most = greatest(beams.flatMap(({ name, sections }) => sections.map(({ x, values }) => ({ name, x, values }))), t);
    const what = of === "1" ? "maximum utilisation" : "maximum equivalent stress";
    const value = of === "1" ? `${Number((100 * most.value).toPrecision(3))} %` : `${Number(most.value.toPrecision(4))} MPa`;
    add(what, value, `${spoken(most.name)}, ${Number(most.x.toFixed(2))} m from its start, ${when(most.t)}`);
  }
  const lines = margins(crane);
  if (lines.length) {
    const least = greatest(lines.map(({ name, values }) => ({ name, values: values.map((margin) => 2e3 - margin) })), t);
    const margin = 2e3 - least.value;
    add("minimum tipping margin", `${Number(margin.toFixed(3))}`, `${margin <= 0 ? "it tips over" : "about"} ${spoken(least.name)}, ${when(least.t)}`);
  }
  if (modes.length && modes[0].frequency !== null) {
    add("lowest frequency", `${readable(Number(modes[0].frequency.toPrecision(4)))} Hz`, modes[0].moves.slice(0, 2).map(spoken).join(", "));
  }
  if (!crane.record) return;
  const error = greatest([{ values: run.column("energy_balance").values }], t);
  add("error of the energy balance", `${readable(Number(error.size.toPrecision(2)))} J`, `largest, ${when(error.t)}`);
}
