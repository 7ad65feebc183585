// A plot with hover, zoom, keyboard, and downloads as SVG and CSV.
import uPlot from "uplot";
import { curve, style } from "./colours.js";
import { at, measured, range, readable, tickText, times } from "./data.js";
import { csv, save } from "./download.js";
import { svg } from "./svg.js";

/** Factor on the range by which a key zooms. */
const ZOOM = 0.7;

/** Font of the axes. */
const FONT = "12px system-ui, sans-serif";

const element = (name, attributes = {}, ...children) => {
  const made = Object.assign(document.createElement(name), attributes);
  made.append(...children);
  return made;
};

export class Plot {
  /**
   * `x`: `{label, unit, values}`; `curves`: `{label, values, dashed, colour}`, colour an index of the palette;
   * `y`: `{label, unit, factor}`, values are shown times the factor. `kind`: `time` for curves over time, which share
   * their cursor and zoom and follow the player; `path` for curves of places, each with its own values along x;
   * `along` for other curves.
   */
  constructor(host, options) {
    Object.assign(this, { kind: "time", ...options, height: options.height ?? 240 });
    this.factor = this.y.factor ?? 1;
    this.frame = element("figure", { className: `panel ${this.kind}`, tabIndex: 0, id: options.id });
    const button = (text, title, act) => {
      const made = element("button", { type: "button", textContent: text, title });
      made.addEventListener("click", act);
      return made;
    };
    this.tools = element(
      "span", { className: "tools" },
      button("⤢", "Show everything (0)", () => this.reset()),
      button("SVG", "Download this plot as SVG, at the current zoom", () => save(`${this.file}.svg`, svg(this), "image/svg+xml")),
      button("CSV", "Download these curves as CSV", () => save(`${this.file}.csv`, csv(this), "text/csv")),
    );
    this.head = element("figcaption", {}, element("span", { textContent: this.title }), this.tools);
    this.body = element("div", { className: "plot" });
    // A line at the present time, or a dot on each path.
    const mark = (className) => element("div", { className, hidden: this.kind === "along" });
    this.marks = this.kind === "path" ? this.curves.map(() => mark("dot")) : [mark("marker")];
    this.frame.append(this.head, this.body);
    this.frame.setAttribute("aria-label", `${this.title}: arrow keys move the cursor, + and − zoom, 0 shows everything`);
    host.append(this.frame);
    this.make();
    this.frame.addEventListener("keydown", (event) => this.key(event));
    new ResizeObserver(() => matchMedia("print").matches || this.resize()).observe(this.body);
  }

  get file() {
    return `${this.prefix}_${this.id}`;
  }

  /** Data as uPlot wants them. */
  data() {
    const values = this.curves.map((one) => times(one.values, this.factor));
    return this.kind === "path" ? [null, ...this.curves.map((one) => [one.x, one.values])] : [this.x.values, ...values];
  }

  make() {
    const path = this.kind === "path";
    const axis = (label, more) => ({
      label, labelFont: FONT, font: FONT, labelSize: 18, labelGap: 2, stroke: () => style("--ink"),
      grid: { stroke: () => style("--line"), width: 1 }, ticks: { stroke: () => style("--line"), width: 1 },
      values: (_, ticks) => ticks.map((tick) => (tick === null ? "" : tickText(tick))), ...more,
    });
    const value = (unit) => (_, v) => measured(v, unit);
    const series = this.curves.map(({ label, dashed, colour }, index) => ({
      label, scale: "y", width: 1.6, dash: dashed ? [6, 4] : undefined, stroke: () => curve(colour ?? index),
      points: { show: this.kind === "along", size: 5 }, value: value(this.y.unit),
      ...(path && {
        facets: [{ scale: "x", auto: true }, { scale: "y", auto: true }], paths: drawPath,
        value: (u, _, s, i) => (i == null ? "–" : `${readable(u.data[s][0][i])}, ${readable(u.data[s][1][i])} ${this.y.unit} at ${this.curves[s - 1].t[i].toFixed(2)} s`),
      }),
    }));
    const seek = (u) => {
      const chosen = this.kind === "time" && u.cursor.idx != null && u.select.width === 0;
      if (chosen) this.player?.seek(this.x.values[u.cursor.idx]);
    };
    this.plot = new uPlot(
      {
        mode: path ? 2 : 1,
        width: this.body.clientWidth || 400,
        height: this.height,
        legend: { live: true, markers: { dash: (_, s) => (this.curves[s - 1]?.dashed ? "dashed" : "solid") } },
        cursor: {
          focus: { prox: 24 },
          drag: { x: true, y: path, uni: 30, setScale: !path },
          ...(this.kind === "time" && { sync: { key: "time", setSeries: false } }),
          ...(path && { dataIdx: (u, s) => nearest(u, s), points: { show: true } }),
        },
        scales: { x: { time: false, ...(path && { range: (_, low, high) => [low, high] }) }, y: path ? { range: (_, low, high) => [low, high] } : {} },
        axes: [axis(`${this.x.label} [${this.x.unit}]`, { size: 34 }), axis(`${this.y.label} [${this.y.unit}]`, { size: 58, scale: "y" })],
        series: path ? [{}, ...series] : [{ label: this.x.label, value: value(this.x.unit) }, ...series],
        focus: { alpha: 0.35 },
        hooks: {
          ready: [(u) => {
            u.over.append(...this.marks);
            u.over.addEventListener("click", () => seek(u));
          }],
          setScale: [() => this.mark()],
          ...(path && { setSelect: [(u) => this.chose(u)] }),
        },
      },
      this.data(),
      this.body,
    );
    if (path) this.reset();
  }

  /** Takes the available width, or another one. */
  resize(width = this.body.clientWidth) {
    if (!width || width === this.plot.width) return;
    this.plot.setSize({ width, height: this.height });
    if (this.kind === "path") this.fit(this.window);
    this.mark();
  }

  /** Shows everything. */
  reset() {
    if (this.kind === "path") {
      const [x, y] = ["x", "values"].map((key) => this.curves.map((one) => range(one[key])));
      const span = (ranges) => [Math.min(...ranges.map((r) => r[0])), Math.max(...ranges.map((r) => r[1]))];
      this.fit([span(x), span(y)]);
    } else {
      this.zoom(...range(this.x.values));
    }
  }

  zoom(min, max) {
    if (max > min) this.plot.setScale("x", { min, max });
  }

  /** Shows this window of a path, wider or higher if needed, so that a metre is equally long along x and y. */
  fit(window) {
    this.window = window;
    const { width, height } = this.plot.bbox;
    const [x, y] = window.map(([low, high]) => ({ middle: (low + high) / 2, size: Math.max(high - low, 1e-6) * 1.08 }));
    const metre = Math.min(width / x.size, height / y.size);
    const around = ({ middle }, pixels) => ({ min: middle - pixels / metre / 2, max: middle + pixels / metre / 2 });
    this.plot.batch(() => {
      this.plot.setScale("x", around(x, width));
      this.plot.setScale("y", around(y, height));
    });
  }

  /** A window drawn with the mouse. */
  chose(u) {
    const { left, top, width, height } = u.select;
    if (width < 5 && height < 5) return;
    const [x, y] = [[left, left + width], [top + height, top]];
    const window = [x.map((p) => u.posToVal(p, "x")), y.map((p) => u.posToVal(p, "y"))];
    u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    this.fit(window);
  }

  key(event) {
    if (event.target !== this.frame || event.ctrlKey || event.metaKey || event.altKey) return;
    const u = this.plot;
    const { min, max } = u.scales.x;
    const values = this.kind === "path" ? this.curves[0].x : this.x.values;
    const acts = {
      ArrowLeft: () => this.step(-1), ArrowRight: () => this.step(1), 0: () => this.reset(),
      "+": () => this.closer(ZOOM), "=": () => this.closer(ZOOM), "-": () => this.closer(1 / ZOOM),
    };
    if (!acts[event.key] || !values.length || !(max > min)) return;
    event.preventDefault();
    event.stopPropagation();
    acts[event.key]();
  }

  closer(part) {
    const about = ({ min, max }) => [(min + max) / 2 - ((max - min) / 2) * part, (min + max) / 2 + ((max - min) / 2) * part];
    const { x, y } = this.plot.scales;
    if (this.kind === "path") this.fit([about(x), about(y)].map(([low, high]) => [low + (high - low) * 0.037, high - (high - low) * 0.037]));
    else this.zoom(...about(x));
  }

  step(by) {
    const u = this.plot;
    const count = this.kind === "path" ? this.curves[0].x.length : this.x.values.length;
    const stride = Math.max(1, Math.round(count / 200));
    this.index = Math.min(Math.max((this.index ?? 0) + by * stride, 0), count - 1);
    const [x, y] = this.kind === "path" ? [this.curves[0].x, this.curves[0].values] : [this.x.values, u.data[1]];
    u.setCursor({ left: u.valToPos(x[this.index], "x"), top: u.valToPos(y[this.index], "y") });
  }

  /** Marks the player's time; the legend shows its values unless the cursor selects others. */
  now(t, here) {
    this.at = { t, here };
    this.mark();
    const u = this.plot;
    if (this.kind === "along" || u.cursor.left >= 0) return;
    const row = here.part < 0.5 ? here.low : here.high;
    u.setLegend(this.kind === "path" ? { idxs: [null, ...this.curves.map(() => row)] } : { idx: row });
  }

  mark() {
    if (!this.at || !this.plot || this.kind === "along") return;
    const u = this.plot;
    const { t, here } = this.at;
    this.marks.forEach((mark, index) => {
      const path = this.kind === "path" && this.curves[index];
      const left = u.valToPos(path ? at(path.x, here) : t, "x");
      const top = path ? u.valToPos(at(path.values, here), "y") : 0;
      mark.style.display = left >= 0 && left <= u.over.clientWidth ? "" : "none";
      mark.style.transform = `translate(${left}px, ${top}px)`;
      if (path) mark.style.background = curve(path.colour ?? index);
    });
  }

  /** New values of the curves, in the same order. */
  update(values) {
    this.curves.forEach((one, index) => (one.values = values[index]));
    this.plot.setData(this.data(), false);
    this.plot.redraw();
  }

  theme() {
    this.plot.redraw(false, true);
    this.mark();
    this.plot.root.querySelectorAll(".u-series").forEach((row, index) => {
      const mark = row.querySelector(".u-marker");
      const one = this.curves[this.kind === "path" ? index : index - 1];
      if (mark && one) mark.style.borderColor = curve(one.colour ?? this.curves.indexOf(one));
    });
  }
}

/** Curve of a path: straight from place to place, in any direction. */
function drawPath(u, seriesIdx) {
  const path = new Path2D();
  uPlot.orient(u, seriesIdx, (series, xs, ys, scaleX, scaleY, valToPosX, valToPosY, left, top, width, height) => {
    const [x, y] = u.data[seriesIdx];
    for (let i = 0; i < x.length; i += 1) {
      path.lineTo(valToPosX(x[i], scaleX, width, left), valToPosY(y[i], scaleY, height, top));
    }
  });
  return { stroke: path, fill: null, clip: null, band: null, gaps: null, flags: 0 };
}

/** Point of a path that is nearest to the cursor. */
function nearest(u, seriesIdx) {
  const { left, top } = u.cursor;
  if (seriesIdx === 0 || left < 0) return null;
  const [xs, ys] = u.data[seriesIdx];
  const [x, y] = [u.posToVal(left, "x"), u.posToVal(top, "y")];
  let best = 0;
  let least = Infinity;
  for (let i = 0; i < xs.length; i += 1) {
    const way = (xs[i] - x) ** 2 + (ys[i] - y) ** 2;
    if (way < least) [best, least] = [i, way];
  }
  return best;
}
