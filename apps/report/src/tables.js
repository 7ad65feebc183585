// Tables of the page.
import { readable, significant, spoken } from "./data.js";
import { element } from "./element.js";

/** Tables of this many rows and more are folded. */
const LONG = 14;

/** Rows of a table that are printed (`style.css`). */
const PRINTED = 24;

/** Tables of this many columns and more span two columns of the layout. */
const WIDE = 6;

/** A table of the command as it prints it. */
export function grid({ key, title, headers, numeric, rows, exact }) {
  const cell = (tag, all) => (text, column) => element(tag, { textContent: text, className: numeric[column] ? "number" : "", title: all?.[column] ?? "" });
  const table = element(
    "table", {},
    element("thead", {}, element("tr", {}, ...headers.map(cell("th")))),
    element("tbody", {}, ...rows.map((row, index) => element("tr", {}, ...row.map(cell("td", exact?.[index]))))),
  );
  const scroll = element("div", { className: "scroll", tabIndex: 0 }, table);
  scroll.setAttribute("role", "region");
  scroll.setAttribute("aria-label", title);
  const heading = `${title}`;
  const made = rows.length >= LONG
    ? element("details", { className: "table" }, element("summary", { textContent: `${heading} (${rows.length} rows)` }), scroll)
    : element("div", { className: "table" }, element("h3", { textContent: heading }), scroll);
  made.id = `table_${key}`;
  made.classList.toggle("wide", headers.length >= WIDE);
  made.classList.toggle("long", rows.length > PRINTED);
  return made;
}

/** Names and values side by side. */
function pairs(title, entries, id) {
  return grid({ key: id, title, headers: ["", ""], numeric: [false, false], rows: entries });
}

/** Fills the tables. */
export function tables(data) {
  if (data.tables) results(data.tables);
  const again = document.querySelector("#repeat .tables");
  for (const { name, repeat } of data.cranes) if (repeat) again.append(pairs(spoken(name), repeat, `record_${name}`));
  const command = document.querySelector("#command");
  if (data.command) command.textContent = data.command;
  else command.closest(".card").remove();
  if (data.spec) document.querySelector("#spec pre").textContent = data.spec;
  else document.querySelector("#spec").remove();
}

/** Outcome and results. */
export function results({ facts, grids }, host = document.querySelector("#tables .tables")) {
  if (facts.length) {
    host.append(pairs("Outcome", facts.map(([name, value, unit]) => [spoken(name), `${value} ${unit}`.trim()]), "facts"));
  }
  host.append(...grids.map(grid));
}

/** A mode in words. */
export const modeText = ({ frequency, damping, moves }, index) => {
  const damped = damping === null ? "" : `, damping ${significant(damping, 2)}`;
  return `${index + 1}: ${frequency === null ? "unstable" : `${readable(frequency)} Hz`}${damped}, ${moves.slice(0, 3).map(spoken).join(", ")}`;
};
