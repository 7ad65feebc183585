// Utilisation of the beams and margins against tipping over, as the command computed them along the run.

/** 32-bit numbers from base 64. */
export function unpacked(data) {
  return new Float32Array(Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0)).buffer);
}

/** Columns of a table that is stored row by row. */
function columns(data, count) {
  const numbers = unpacked(data);
  if (!count) return [];
  const rows = numbers.length / count;
  return Array.from({ length: count }, (_, column) => Float32Array.from({ length: rows }, (_, row) => numbers[row * count + column]));
}

/** Places by beam, in the order of the sections, each with what `more` adds; `way` of a place that slides is where it is over time. */
function byBeam(crane, places, more) {
  const sliding = crane.strength.carried.places.filter(({ slides }) => slides);
  const ways = columns(crane.strength.carried.x, sliding.length);
  const beams = [];
  places.forEach((place, index) => {
    if (beams.at(-1)?.name !== place.beam) beams.push({ name: place.beam, sections: [] });
    const slid = place.slides ? sliding.findIndex((other) => other.beam === place.beam && other.place === place.place) : -1;
    beams.at(-1).sections.push({ x: place.x, place: place.place, way: ways[slid], ...more(place, index) });
  });
  return beams;
}

/** Beams with what their places carry, `{name, sections: [{x, way, moments, ranges}]}`: moments about x, y and z over time, their least and most. */
export function carried(crane) {
  const all = crane.strength?.carried;
  if (!all) return [];
  const moments = columns(all.data, 3 * all.places.length);
  return byBeam(crane, all.places, ({ ranges }, index) => ({ ranges, moments: moments.slice(3 * index, 3 * index + 3) }));
}

/** Beams with their sections, `{name, sections: [{x, way, values, most}]}`, with the maximum of the whole run; empty if their stresses are not known. */
export function used(crane) {
  const sections = crane.strength?.sections;
  if (!sections) return { beams: [], unit: "1" };
  const values = columns(sections.data, sections.places.length);
  const beams = byBeam(crane, sections.places, ({ most }, index) => ({ values: values[index], most }));
  // Without beams that have no yield stress, if others have one.
  return { beams: beams.filter(({ sections: of }) => of.every((section) => Number.isFinite(section.values[0]))), unit: sections.unit };
}

/** Places of a beam at a time of the run, in their order along it: those at pads move. */
export function ordered(joints, { low, high, part }) {
  const here = joints.map(({ x, way }) => (way ? way[low] + (way[high] - way[low]) * part : x));
  const order = here.map((_, index) => index).sort((a, b) => here[a] - here[b] || a - b);
  return { order, x: order.map((index) => here[index]) };
}

/** Margins about the tipping lines, `{name, values}`. */
export function margins(crane) {
  const stability = crane.strength?.stability;
  if (!stability) return [];
  const values = columns(stability.data, stability.lines.length);
  return stability.lines.map((name, index) => ({ name, values: values[index] }));
}

/** Maximum of some columns, row by row. */
export const envelope = (columns, pick = Math.max) => columns[0].map((_, row) => pick(...columns.map((values) => values[row])));
