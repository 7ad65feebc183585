// Modes about the pose at rest: a list to choose from.
import { readable, significant, spoken } from "../../src/data.js";
import { element } from "../../src/element.js";

export class Modes {
  /** `choose(mode)` shows a mode, `swell(factor)` its amplitude. */
  constructor(host, { choose, swell }) {
    this.list = host.querySelector(".list");
    this.note = host.querySelector("#modes_note");
    this.choose = choose;
    const amplitude = host.querySelector("input");
    amplitude.addEventListener("input", () => swell(10 ** Number(amplitude.value)));
    this.amplitude = amplitude.closest("label");
  }

  /** Until modes are known. */
  wait(stable) {
    this.list.classList.add("old");
    if (!stable) this.fail("There are no modes: the crane does not rest in a stable pose.");
    else this.note.textContent = "computing …";
  }

  /** Says why there are none. */
  fail(words) {
    this.show([]);
    this.note.textContent = words;
  }

  show(modes) {
    this.modes = modes;
    this.list.classList.remove("old");
    const any = modes.length > 0;
    this.amplitude.hidden = !any;
    this.note.textContent = any ? "Small vibrations about the pose at rest, not to scale and slowed down." : "Nothing can vibrate.";
    const row = ({ frequency, damping, moves }, index) => {
      const choice = element("input", { type: "radio", name: "mode", value: index });
      choice.addEventListener("change", () => this.choose(this.modes[index]));
      const cells = [`${index + 1}`, frequency === null ? "unstable" : `${readable(frequency)} Hz`, significant(damping, 2), moves.slice(0, 3).map(spoken).join(", ")];
      return element("label", { className: "mode" }, choice, ...cells.map((textContent) => element("span", { textContent })));
    };
    const head = element("div", { className: "mode head" }, ...["", "mode", "frequency", "damping ratio", "moves most"].map((textContent) => element("span", { textContent })));
    this.list.replaceChildren(...(any ? [head, ...modes.map(row)] : []));
  }

  /** The mode that is chosen, if any. */
  get chosen() {
    const choice = this.list.querySelector("input:checked");
    return choice ? this.modes[Number(choice.value)] : null;
  }
}
