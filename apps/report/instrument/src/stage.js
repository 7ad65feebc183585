// The crane in three dimensions, whatever is known of it: at rest, in a mode, in a run, driven.
import { decoded, measured, scaled } from "../../src/data.js";
import { gradient } from "../../src/colours.js";
import { element } from "../../src/element.js";
import { Player } from "../../src/player.js";
import { Viewer } from "../../src/viewer.js";

/** Time in which a mode is shown over and over, s. */
const WAVES = 10;
/** The world's axes: name, colour, direction. */
const AXES = [["x", "#d55e00", 1, 0, 0], ["y", "#009e73", 0, 1, 0], ["z", "#0072b2", 0, 0, 1]];
/** Logarithm of the ratio of sizes from which the camera moves to a crane again. */
const GROWN = 0.2;

export class Stage {
  constructor() {
    this.player = new Player(WAVES);
    this.viewer = null;
    this.crane = null;
  }

  /** Shows data of the engine: `{cranes}`; returns them with the numbers unpacked. */
  show(data, { run = false } = {}) {
    const shown = decoded(data);
    const crane = shown.cranes.at(-1);
    this.present(crane, run);
    return { ...shown, crane, rigid: null };
  }

  /** Shows a crane; the view stays where it is unless the crane is another one, or grew. */
  present(crane, run = false) {
    const before = this.viewer && { name: this.crane.name, size: this.viewer.extent.size };
    this.player.play(false);
    this.player.duration = run ? crane.run.t.at(-1) : WAVES;
    this.player.t = 0;
    this.crane = crane;
    try {
      if (this.viewer) this.viewer.load({ crane, rigid: null });
      else if (!this.flat) this.viewer = new Viewer(document.querySelector("#view canvas"), { crane, rigid: null }, this.player);
    } catch (error) {
      this.flat = true;
      const words = `3-D is not available in this browser (${error.message}). Everything else is here.`;
      for (const one of document.querySelectorAll("#view .overlay, #tools")) one.toggleAttribute("hidden", true);
      document.querySelector("#view canvas").replaceWith(element("p", { textContent: words, className: "sorry" }));
    }
    const grown = before && Math.abs(Math.log(before.size / this.viewer.extent.size)) > GROWN;
    if (before && (before.name !== crane.name || grown)) this.viewer.look("corner");
    this.player.seek(0);
    this.legend();
    this.axes();
  }

  /** The world's axes as they are seen, in the colours of `crane explain`, and the size of the ground's squares. */
  axes() {
    const { viewer } = this;
    if (!viewer) return;
    document.querySelector("#square").textContent = `squares of ${measured(viewer.square, "m")}`;
    const svg = document.querySelector("#axes");
    if (viewer.drawn) return;
    const made = (name, attributes, words = "") => {
      const one = document.createElementNS(svg.namespaceURI, name);
      for (const [key, value] of Object.entries(attributes)) one.setAttribute(key, value);
      one.textContent = words;
      return one;
    };
    const axes = AXES.map(([name, colour, ...along]) => ({ along, line: made("line", { x1: 0, y1: 0, stroke: colour }), label: made("text", { fill: colour }, name) }));
    svg.replaceChildren(...axes.flatMap(({ line, label }) => [line, label]));
    viewer.drawn = () => {
      for (const { along, line, label } of axes) {
        const { x, y } = viewer.camera.up.clone().set(...along).transformDirection(viewer.camera.matrixWorldInverse);
        const place = (far) => [(far * x).toFixed(1), (-far * y).toFixed(1)];
        const [[x2, y2], [lx, ly]] = [place(18), place(25)];
        line.setAttribute("x2", x2);
        line.setAttribute("y2", y2);
        label.setAttribute("x", lx);
        label.setAttribute("y", ly);
      }
    };
  }

  /** What the lengths and the colours of the arrows mean. */
  legend() {
    const legend = document.querySelector("#legend");
    const feet = this.crane.scene.supports.length > 0;
    legend.hidden = !feet || !this.viewer;
    if (!feet || !this.viewer) return;
    const { unit, factor } = scaled("N", [this.viewer.greatest]);
    legend.querySelector("i").style.background = gradient;
    legend.querySelector("b").textContent = measured(this.viewer.greatest * factor, unit);
  }

  /** Shows a mode, or the crane as it is. */
  vibrate(mode) {
    this.viewer?.vibrate(mode);
    this.player.play(Boolean(mode));
    if (!mode) this.player.seek(0);
  }

  /** The crane begins to follow its levers, or ends. */
  drive(on) {
    if (this.viewer) this.viewer.driven = on;
  }

  /** Takes over a row of results and margins about tipping lines, of a crane that is shown at rest; `took`: the time that computing them took, s. */
  follow(row, margins, took) {
    this.viewer?.wait(took);
    this.crane.run.list.forEach(({ values }, column) => {
      if (column < row.length) values[0] = row[column];
    });
    const { lines } = this.viewer ?? { lines: [] };
    if (lines.length === margins.length) lines.forEach((line, index) => (line.values[0] = margins[index].margin ?? -Infinity));
    this.viewer?.show();
    this.viewer?.follow();
  }

  theme() {
    this.viewer?.theme();
  }
}
