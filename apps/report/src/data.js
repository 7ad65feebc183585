// The data that the command put into the page.

/** All data of the page: cranes, tables, spec, command. The crane the page is about comes last. */
export const read = () => decoded(JSON.parse(document.getElementById("data").textContent));

/** The same with the numbers of runs unpacked. */
export function decoded(data) {
  display = data.display;
  for (const crane of data.cranes) crane.run = run(crane.run);
  const crane = data.cranes.at(-1);
  return { ...data, crane, rigid: data.cranes.length > 1 ? data.cranes[0] : null };
}

/**
 * Whether there is a number. What is absent is null in JSON and not finite in the packed numbers of a run: no load that a pose could bear, no margin where
 * nothing stabilises. In tables it is "–", in files an empty field, in curves a gap.
 */
export const known = (value) => value != null && Number.isFinite(value);

/** Numbers of 32 bits from base 64. */
export const unpacked = (data) => new Float32Array(Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0)).buffer);

/** A recorded run: columns by name, each `{name, unit, part, kind, values, least, most}`: what it shows of which part; the extremes are those of the whole run, also where rows are left out. */
function run({ columns, rows, every, data }) {
  const numbers = unpacked(data);
  const list = columns.map((column, i) => ({ ...column, values: numbers.subarray(i * rows, (i + 1) * rows) }));
  const byName = new Map(list.map((column) => [column.name, column]));
  return { list, rows, every, t: list[0].values, column: (name) => byName.get(name) };
}

/** Position of time `t` among the samples: indices before and after it, and the fraction of the way between them. */
export function place(times, t) {
  let low = 0;
  let high = times.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle;
    else high = middle;
  }
  const width = times[high] - times[low];
  const part = width > 0 ? Math.min(Math.max((t - times[low]) / width, 0), 1) : 0;
  return { low, high, part };
}

/** Value of a column between samples; beside an absent one, the nearer sample. */
export const at = (values, { low, high, part }) => {
  const way = values[high] - values[low];
  if (!known(way)) return values[part < 0.5 ? low : high];
  return values[low] + way * part;
};

/** Minimum and maximum of the numbers that are known. */
export function range(values) {
  let low = Infinity;
  let high = -Infinity;
  for (const value of values) {
    if (!known(value)) continue;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return [low, high];
}

/** Numbers times a factor; what is absent stays so, as null. */
export const times = (values, factor) => Array.from(values, (value) => (known(value) ? value * factor : null));

/** Some significant digits, as the command prints them (`apps/page/src/tables/cell.rs`); digits before the point are never dropped. */
export function significant(value, digits) {
  if (!known(value)) return "–";
  const size = Math.abs(value);
  if (size < 1e-10) return "0";
  const plain = String(value);
  if (size >= 1e-6 && plain.length <= digits + 1) return plain;
  if (size < 1e-3 || size >= 1e7) return value.toExponential(digits - 1).replace("e+", "e");
  return value.toFixed(Math.max(digits - 1 - Math.floor(Math.log10(size)), 0));
}

/** Four digits, as the command prints them. */
export const readable = (value) => significant(value, 4);

/** A number with its unit; a ratio has none. */
export const measured = (value, unit) => (unit && unit !== "1" ? `${readable(value)} ${unit}` : readable(value));

/** Units in which people read numbers: rows of the table that the command puts into the page. */
let display = [];

/** The unit for readers of numbers in a unit of SI, and its factor: bar for Pa; kN for large forces. */
export function scaled(unit, values) {
  const [low, high] = range(values);
  const size = Math.max(Math.abs(low), Math.abs(high), 0);
  const fits = ({ si, least, below }) => si === unit && size >= least && (below === null || size < below);
  return display.find(fits) ?? { unit, factor: 1 };
}

/** Degrees in a radian. */
export const DEGREES = 180 / Math.PI;

/** The unit in which numbers of any size are shown, and its factor: ° for rad; that of SI where there is none. */
export const always = (unit) => display.find(({ si, least, below }) => si === unit && least === 0 && below === null) ?? { unit, factor: 1 };

/** A name for readers: spaces instead of underscores. */
export const spoken = (name) => name.replaceAll("_", " ");

/** Text of a tick: without the digits that rounding leaves. */
export function tickText(value) {
  const text = Math.abs(value) >= 1e6 || (value !== 0 && Math.abs(value) < 1e-4) ? value.toExponential() : String(+value.toFixed(6));
  return text.replace("-", "−");
}
