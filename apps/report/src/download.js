// Files to download from the page.
import { known, times } from "./data.js";

/** Offers text, or a blob, as a file. */
export function save(name, text, type) {
  const url = URL.createObjectURL(new Blob([text], { type }));
  const link = Object.assign(document.createElement("a"), { href: url, download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}

/** The shortest text of a 32-bit number: the digits that the page has; of what is absent, none. */
const exact = (value) => {
  if (!known(value)) return "";
  for (let digits = 6; digits <= 9; digits += 1) {
    const text = value.toPrecision(digits);
    if (Math.fround(Number(text)) === Math.fround(value)) return String(Number(text));
  }
  return String(value);
};

/** Columns `{name, unit, values}` as CSV, units in the header. */
export function table(columns) {
  const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  const lines = [columns.map(({ name, unit }) => quoted(`${name} [${unit}]`)).join(",")];
  const rows = Math.max(...columns.map(({ values }) => values.length));
  for (let row = 0; row < rows; row += 1) {
    lines.push(columns.map(({ values }) => (row < values.length ? exact(values[row]) : "")).join(","));
  }
  return `${lines.join("\n")}\n`;
}

/** The curves of a plot as CSV. */
export function csv(plot) {
  const { x, y, curves, factor } = plot;
  const columns = curves.flatMap(({ label, values, x: own }) =>
    own
      ? [{ name: `${label} ${x.label}`, unit: x.unit, values: own }, { name: `${label} ${y.label}`, unit: y.unit, values }]
      : [{ name: label, unit: y.unit, values: times(values, factor) }],
  );
  return table(plot.kind === "path" ? columns : [{ name: x.label, unit: x.unit, values: x.values }, ...columns]);
}
