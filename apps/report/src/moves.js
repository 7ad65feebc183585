// What moves what: for every output at rest a bar for each number, to the right where the output grows.
import { element } from "./element.js";

/** Largest number of lines of the scale to each side. */
const TICKS = 4;

/** Shows bars, their scale and the command that computes the same. */
export function moves({ moves: found }) {
  const host = document.querySelector("#moves .panels");
  if (!found) return;
  const greatest = Math.max(...found.outputs.flatMap(({ bars }) => bars.map(({ relative }) => Math.abs(relative))));
  const change = `${Number((100 * found.change).toPrecision(4))} %`;
  document.querySelector("#moves_change").textContent = change;
  host.append(element("div", { className: "card moves" }, scale(greatest), ...found.outputs.map((output) => block(output, greatest))));
  host.append(element("div", { className: "card" }, element("p", { className: "soft", textContent: "All changes, and those of other numbers" }), element("code", { textContent: found.command })));
}

/** Where a change is on the scale, % of its width. */
const at = (share, greatest) => 50 * (1 + share / greatest);

/** Numbers above the bars: round ones. */
function scale(greatest) {
  const magnitude = 10 ** Math.floor(Math.log10(greatest / TICKS));
  const step = [1, 2, 5, 10].map((factor) => factor * magnitude).find((step) => greatest / step <= TICKS) ?? greatest;
  const most = Math.floor(greatest / step);
  const track = element("span", { className: "track" });
  for (let count = -most; count <= most; count++) {
    const text = `${Number((100 * count * step).toPrecision(3))} %`.replace("-", "−");
    // Where there is little room, only the middle and the ends have numbers.
    const tick = element("i", { className: count % most ? "tick between" : "tick", textContent: text });
    tick.style.left = `${at(count * step, greatest)}%`;
    track.append(tick);
  }
  return element("div", { className: "move scale" }, element("span", { className: "number", textContent: "change of the output, relative to it" }), track, element("span"));
}

/** An output with its bars. */
function block({ output, value, place, bars }, greatest) {
  const head = element("h3", {}, output, element("span", { className: "soft", textContent: ` ${[value, place].filter(Boolean).join(" – ")}` }));
  return element("div", { className: "block" }, head, ...bars.map((bar) => row(bar, greatest)));
}

function row({ number, relative, text }, greatest) {
  const bar = element("b", { className: relative < 0 ? "falls" : "grows" });
  const [from, to] = [0, relative].sort((a, b) => a - b).map((share) => at(share, greatest));
  Object.assign(bar.style, { left: `${from}%`, width: `${to - from}%` });
  const track = element("span", { className: "track" }, bar);
  // Names may break after a dot and an underscore.
  const name = number.split(/(?<=[._])/).flatMap((part) => [part, document.createElement("wbr")]);
  return element("div", { className: "move" }, element("span", { className: "number" }, ...name.slice(0, -1)), track, element("span", { className: "change", textContent: text }));
}
