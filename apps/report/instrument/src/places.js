// Where parts and numbers of a crane are in the text of its spec.
import { context } from "./schema.js";

const plain = (text) => text.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");

/** Places of a key with some value in a text, where the path of the mapping is this one. */
function* places(text, key, value, path) {
  for (const { index, 0: all } of text.matchAll(new RegExp(`(?<![\\w.])${key}:\\s*(${value})(?=[\\s,}\\]]|$)`, "g"))) {
    const here = context(text, index);
    if (here.key && here.path.join("/") === path) yield { from: index, to: index + all.length };
  }
}

/** Where an entry of a list, such as `links`, with a name begins; `null` if the text has none: what a spec extends is elsewhere. */
export function entry(text, list, name, key = "name") {
  const [first] = places(text, key, `(["']?)${plain(name)}\\2`, `${list}/[]`);
  return first?.from ?? null;
}

/** A number as it is written, with the unit of what it replaces; `factor(unit)` is such a unit in SI units. */
async function written(value, before, factor) {
  const [, quote, unit] = /^(["']?)[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?\s*(.*)\1$/i.exec(before);
  const number = Number((unit ? value / (await factor(unit)) : value).toPrecision(6));
  return `${quote}${number}${unit && ` ${unit}`}${quote}`;
}

/**
 * Changes of a text, `{from, to, insert}`, by which live parameters and positions of drives, by name, become those of the spec; and the names of those
 * that have no number of their own in it. `factor(name, unit)` is a unit in that of the number with this name.
 */
export async function rewritten(text, { parameters = {}, positions = {} }, factor) {
  const [changes, left] = [[], []];
  const change = async (name, value, found) => {
    if (!found) return left.push(name);
    const before = text.slice(found.from, found.to);
    const [, key, old] = /^(\w+:\s*)([^]*)$/.exec(before);
    return changes.push({ from: found.from + key.length, to: found.to, insert: await written(value, old, (unit) => factor(name, unit)) });
  };
  // A number alone or with its unit, quoted or not.
  const number = "[-+]?\\.?\\d[^\\s,}\\]#\"']*(?: +[^\\s,}\\]#\"']+)*|([\"'])[-+]?\\.?\\d[^\"']*\\2";
  for (const [name, value] of Object.entries(parameters)) await change(name, value, [...places(text, "value", number, `parameters/${name}`)][0]);
  for (const [name, value] of Object.entries(positions)) {
    const begin = entry(text, "drives", name, "coordinate");
    const after = begin === null ? null : [...places(text, "coordinate", "\\S+", "drives/[]")].find(({ from }) => from > begin)?.from ?? text.length;
    const held = begin === null ? null : [...places(text, "hold", number, "drives/[]/motion")].find(({ from }) => from > begin && from < after);
    await change(name, value, held);
  }
  return { changes, left };
}
