// A plot as SVG for a paper: black on white, labelled axes with units, the colours of the figures, plain fonts.
import { CURVES } from "./colours.js";
import { known, tickText } from "./data.js";

const WIDTH = 640;
const HEIGHT = 400;
const MARGIN = { left: 76, right: 16, bottom: 52 };
const ROW = 20;

const escape = (text) => text.replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]);
const round = (value) => String(+value.toFixed(2));

/** Round numbers between two others. */
function ticks(low, high, count) {
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].find((factor) => factor * power >= rough) * power;
  const found = [];
  for (let k = Math.ceil(low / step); k * step <= high + 1e-9 * step; k += 1) found.push(k * step);
  return found;
}

/** The plot as it is zoomed now. */
export function svg(plot) {
  const { curves, x, y, factor, kind } = plot;
  const [sx, sy] = [plot.plot.scales.x, plot.plot.scales.y];
  const top = 14 + ROW * Math.ceil(curves.length / 3);
  const [width, height] = [WIDTH - MARGIN.left - MARGIN.right, HEIGHT - top - MARGIN.bottom];
  const px = (value) => MARGIN.left + ((value - sx.min) / (sx.max - sx.min)) * width;
  const py = (value) => top + (1 - (value - sy.min) / (sy.max - sy.min)) * height;
  const line = (x1, y1, x2, y2, colour) =>
    `<line x1="${round(x1)}" y1="${round(y1)}" x2="${round(x2)}" y2="${round(y2)}" stroke="${colour}"/>`;
  const text = (tx, ty, anchor, what, more = "") =>
    `<text x="${round(tx)}" y="${round(ty)}" text-anchor="${anchor}" ${more}>${escape(what)}</text>`;
  const parts = [];
  for (const value of ticks(sx.min, sx.max, 7)) {
    parts.push(line(px(value), top, px(value), top + height, "#ddd"), text(px(value), top + height + 18, "middle", tickText(value)));
  }
  for (const value of ticks(sy.min, sy.max, 6)) {
    parts.push(line(MARGIN.left, py(value), MARGIN.left + width, py(value), "#ddd"), text(MARGIN.left - 7, py(value) + 4, "end", tickText(value)));
  }
  parts.push(line(MARGIN.left, top, MARGIN.left, top + height, "#000"), line(MARGIN.left, top + height, MARGIN.left + width, top + height, "#000"));
  parts.push(text(MARGIN.left + width / 2, HEIGHT - 12, "middle", `${x.label} [${x.unit}]`));
  parts.push(text(0, 0, "middle", `${y.label} [${y.unit}]`, `transform="translate(16 ${round(top + height / 2)}) rotate(-90)"`));
  curves.forEach((one, index) => {
    const xs = kind === "path" ? one.x : x.values;
    // A line for each stretch between gaps.
    const lines = [[]];
    one.values.forEach((value, i) => {
      if (known(value)) lines.at(-1).push(`${round(px(xs[i]))},${round(py(kind === "path" ? value : value * factor))}`);
      else if (lines.at(-1).length) lines.push([]);
    });
    const look = `fill="none" stroke="${CURVES.light[(one.colour ?? index) % 8]}" stroke-width="1.6" ${one.dashed ? 'stroke-dasharray="6 4"' : ""}`;
    for (const points of lines) parts.push(`<polyline clip-path="url(#area)" points="${points.join(" ")}" ${look}/>`);
    const [lx, ly] = [MARGIN.left + (index % 3) * (width / 3), 16 + ROW * Math.floor(index / 3)];
    parts.push(`<line x1="${round(lx)}" y1="${ly}" x2="${round(lx + 28)}" y2="${ly}" ${look}/>`, text(lx + 34, ly + 4, "start", one.label));
  });
  return `<svg xmlns="http://www.w3.org/2000/svg" width="${WIDTH}" height="${HEIGHT}" viewBox="0 0 ${WIDTH} ${HEIGHT}" font-family="sans-serif" font-size="13">
<title>${escape(plot.title)}</title>
<clipPath id="area"><rect x="${MARGIN.left}" y="${top}" width="${width}" height="${height}"/></clipPath>
<rect width="100%" height="100%" fill="#fff"/>
${parts.join("\n")}
</svg>
`;
}
