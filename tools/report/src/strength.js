// Utilisation of the beams and margins against tipping over, as the command computed them along the run.

/** 32-bit numbers from base 64. */
export function unpacked(data) {
  return new Float32Array(Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0)).buffer);
}

/** Columns of a table that is stored row by row. */
function columns(data, count) {
  const numbers = unpacked(data);
  const rows = numbers.length / count;
  return Array.from({ length: count }, (_, column) => Float32Array.from({ length: rows }, (_, row) => numbers[row * count + column]));
}

/** Beams with their sections, `{name, sections: [{x, values, most}]}`, with the maximum of the whole run; empty if their stresses are not known. */
export function used(crane) {
  const sections = crane.strength?.sections;
  if (!sections) return { beams: [], unit: "1" };
  const values = columns(sections.data, sections.places.length);
  const beams = [];
  sections.places.forEach(({ beam, x, most }, index) => {
    if (beams.at(-1)?.name !== beam) beams.push({ name: beam, sections: [] });
    beams.at(-1).sections.push({ x, values: values[index], most });
  });
  // Without beams that have no yield stress, if others have one.
  return { beams: beams.filter(({ sections: of }) => of.every((section) => Number.isFinite(section.values[0]))), unit: sections.unit };
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
