// Where parts and numbers of a crane are in the text of its spec.
import { DEGREES } from "../../src/data.js";
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

/** A number as it is written: with the unit of what it replaces. */
function written(value, before) {
  const turns = /\bdeg\b/.test(before);
  const number = Number((turns ? value * DEGREES : value).toPrecision(6));
  return before.replace(/^[^\s"']+|(?<=["'])[^\s"']+/, String(number));
}

/**
 * Changes of a text, `{from, to, insert}`, by which live parameters and positions of drives, by name, become those of the spec; and the names of those
 * that have no number of their own in it.
 */
export function rewritten(text, { parameters = {}, positions = {} }) {
  const [changes, left] = [[], []];
  const change = (name, value, found) => {
    if (!found) return left.push(name);
    const before = text.slice(found.from, found.to);
    const [, key, old] = /^(\w+:\s*)([^]*)$/.exec(before);
    return changes.push({ from: found.from + key.length, to: found.to, insert: written(value, old) });
  };
  const number = "[-+]?[\\d.][\\w.+-]*(?: deg)?|([\"'])[-+\\d.e]+ deg\\2";
  for (const [name, value] of Object.entries(parameters)) change(name, value, [...places(text, "value", number, `parameters/${name}`)][0]);
  for (const [name, value] of Object.entries(positions)) {
    const begin = entry(text, "drives", name, "coordinate");
    const after = begin === null ? null : [...places(text, "coordinate", "\\S+", "drives/[]")].find(({ from }) => from > begin)?.from ?? text.length;
    const held = begin === null ? null : [...places(text, "hold", number, "drives/[]/motion")].find(({ from }) => from > begin && from < after);
    change(name, value, held);
  }
  return { changes, left };
}
