// A page to print and to sign: what was computed, with what, and what came out.
import { spoken } from "./data.js";

const element = (name, attributes = {}, ...children) => {
  const made = Object.assign(document.createElement(name), attributes);
  made.append(...children);
  return made;
};

/** Largest differences from a finer run, for each unit. */
function errors(crane) {
  const differences = crane.record.differences_from_a_finer_run;
  if (!differences) return "not estimated";
  const greatest = new Map();
  for (const { name, unit } of crane.run.list) {
    const difference = differences[name];
    if (unit && Number.isFinite(difference) && name !== "t") greatest.set(unit, Math.max(greatest.get(unit) ?? 0, difference));
  }
  const shown = ["N", "N m", "m", "rad"].filter((unit) => greatest.has(unit));
  return shown.map((unit) => `${Number(greatest.get(unit).toPrecision(2))} ${unit}`).join("; ") || "not estimated";
}

/** Fills the page. */
export function sign({ crane, command }) {
  const host = document.querySelector("#sign .card");
  const { record } = crane;
  const row = (name, value) => element("tr", {}, element("th", { textContent: name }), element("td", { textContent: value }));
  const parameters = Object.entries(record.parameters).map(([name, { value, unit }]) => `${name} = ${value} ${unit}`);
  const results = [...document.querySelectorAll("#tiles > div")].map((tile) => {
    const [title, value, note] = [...tile.children].map((part) => part.textContent);
    return row(title, note ? `${value} (${note})` : value);
  });
  const tolerance = record.tolerance ? `, tolerance ${record.tolerance}` : "";
  host.append(
    element("table", {}, element("tbody", {},
      row("crane", `${record.title} (${record.crane})`),
      row("load and other parameters", parameters.join(", ") || "none"),
      row("analysis", `${record.duration_s} s from the ${record.start}; ${record.method}${tolerance}`),
      row("limits", "utilisation 1: equivalent stress of beam theory equals yield stress over the safety factor of the spec; tipping margin 0: overturning equals stabilising moment"),
      ...results,
      row("largest difference from a finer run", errors(crane)),
      row("cautions", record.cautions.join("; ") || "none"),
      row("program", `${spoken(record.program)} ${record.version}`),
      row("hash of the spec", record.spec_hash),
      ...(command ? [row("command", command)] : []),
    )),
    element("div", { className: "signatures" }, ...["computed by", "checked by", "place and date"].map((who) => element("p", { textContent: who }))),
  );
}
