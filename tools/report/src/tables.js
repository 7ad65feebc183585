// Tables of the page.
import { spoken } from "./data.js";

const element = (name, attributes = {}, ...children) => {
  const made = Object.assign(document.createElement(name), attributes);
  made.append(...children);
  return made;
};

/** Tables of this many rows and more are folded. */
const LONG = 14;

/** Tables of this many columns and more span two columns of the layout. */
const WIDE = 6;

/** A table of the command as it prints it. */
function grid({ key, title, headers, numeric, rows, exact }) {
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
  return made;
}

/** Names and values side by side. */
function pairs(title, entries, id) {
  return grid({ key: id, title, headers: ["", ""], numeric: [false, false], rows: entries });
}

/** What a record says, in words: names with units, nested values flattened. */
function entries(record) {
  return Object.entries(record).flatMap(([name, value]) => {
    if (value !== null && typeof value === "object") {
      return Object.entries(value).map(([inner, { value: number, unit }]) => [inner, `${number} ${unit}`]);
    }
    const unit = name.match(/_(s)$/)?.[1];
    const text = typeof value === "number" ? String(+value.toPrecision(9)) : String(value);
    return [[spoken(unit ? name.slice(0, -2) : name), unit ? `${text} ${unit}` : text]];
  });
}

/** Fills the tables. */
export function tables(data) {
  if (data.tables) results(data.tables);
  const again = document.querySelector("#repeat .tables");
  for (const { name, record } of data.cranes) if (record) again.append(pairs(spoken(name), entries(record), `record_${name}`));
  const command = document.querySelector("#command");
  if (data.command) command.textContent = data.command;
  else command.closest(".card").remove();
  if (data.spec) document.querySelector("#spec pre").textContent = data.spec;
  else document.querySelector("#spec").remove();
}

/** Outcome and results. */
function results({ facts, grids }) {
  const host = document.querySelector("#tables .tables");
  if (facts.length) {
    host.append(pairs("Outcome", facts.map(([name, value, unit]) => [spoken(name), `${value} ${unit}`.trim()]), "facts"));
  }
  host.append(...grids.map(grid));
}

/** A mode in words. */
export const modeText = ({ frequency, moves }, index) =>
  `${index + 1}: ${frequency === null ? "unstable" : `${frequency.toPrecision(3)} Hz`}, ${moves.slice(0, 3).map(spoken).join(", ")}`;
