// Load charts that the command was given: what they are valid for, loads over the radius, pictures.
import { element } from "./element.js";
import { readable, spoken } from "./data.js";
import { grid } from "./tables.js";

/** Shows facts, table and pictures. */
export function chart({ chart, load_chart: facts, crane }) {
  const host = document.querySelector("#chart .panels");
  if (facts) {
    host.append(card(facts, crane));
    if (facts.load_chart?.length) host.append(loads(facts));
  }
  for (const { name, svg } of chart ?? []) {
    const image = element("img", { src: `data:image/svg+xml;base64,${svg}`, alt: name });
    host.append(element("figure", { className: "card picture" }, element("figcaption", { textContent: name }), image));
  }
}

/** Crane, load, parameters and limits of a chart. */
function card({ crane: name, load, parameters, limits, spec_hash: hash, cautions, poses, point, radius_from: axis }, { title }) {
  const given = Object.entries(parameters ?? {}).map(([name, value]) => `${name} = ${readable(value)}`);
  const rows = [
    ["crane", [`${title} (${name})`]],
    ["load", [spoken(load)]],
    ["other parameters", given],
    ["point", point ? [`${spoken(point)}, its radius from ${spoken(axis)}`] : []],
    ["limits", limits?.considered ?? []],
    ["not considered", limits?.not_considered ?? []],
    ["cautions", cautions ?? []],
    ["poses", [String(poses)]],
    ["hash of the spec", [hash]],
  ].filter(([, texts]) => texts.length > 0);
  const body = rows.map(([name, texts]) => element("tr", {}, element("th", { textContent: name }), element("td", { textContent: texts.join("; ") })));
  return element("div", { className: "table facts" }, element("h3", { textContent: `Load chart: ${title}` }), element("table", {}, element("tbody", {}, ...body)));
}

/** Loads over the radius: in the best and in the worst pose that reaches it, with what limits them. */
function loads({ load_chart: rows, units }) {
  const of = (value, key) => (value !== null && typeof value === "object" ? Object.keys(value).map((label) => [key, label]) : [[key, null]]);
  const order = ["radius", "largest_load", "height_of_largest_load", "limit_of_largest_load", "least_load", "height_of_least_load", "limit_of_least_load"];
  const columns = order.filter((key) => key in rows[0]).flatMap((key) => of(rows[0][key], key));
  const value = (row, [key, label]) => (label === null ? row[key] : row[key]?.[label]);
  const cell = (value) => (typeof value === "string" ? value : readable(value));
  return grid({
    key: "load_chart",
    title: "Loads over the radius: the largest and the least load of all poses that reach it, rounded down",
    headers: columns.map(([key, label]) => [label, spoken(key), units?.load_chart?.[key] && `[${units.load_chart[key]}]`].filter(Boolean).join(" ")),
    numeric: columns.map(([key]) => !key.startsWith("limit")),
    rows: rows.map((row) => columns.map((column) => cell(value(row, column)))),
  });
}
