// The parts of the crane: chosen in the picture or from a list, marked, and found in the spec.
import { at, known, measured, place, spoken, always } from "../../src/data.js";
import { element } from "../../src/element.js";

/** Farthest that a pointer moves in a click, CSS pixels: what moves it farther turns the view. */
const STILL = 5;

export class Parts {
  /** `find(part)` returns where a part is in the spec, or `null`; `go(place)` goes there. */
  constructor(host, canvas, stage, { find, go }) {
    Object.assign(this, { host, stage, find, go, part: null });
    this.list = host.querySelector("select");
    this.words = host.querySelector("output");
    this.link = host.querySelector("button");
    this.list.addEventListener("change", () => this.choose(this.list.value));
    this.link.addEventListener("click", () => go(find(this.part)));
    let begin = null;
    canvas.addEventListener("pointerdown", ({ isPrimary, button, clientX, clientY }) => (begin = isPrimary && button === 0 ? [clientX, clientY] : null));
    canvas.addEventListener("pointerup", ({ clientX, clientY }) => {
      if (!begin || Math.hypot(clientX - begin[0], clientY - begin[1]) > STILL) return;
      this.choose(key(stage.viewer?.pick(clientX, clientY)));
    });
  }

  /** The parts of the crane that is shown. */
  open({ scene }) {
    const links = [...new Set(scene.bodies.map(({ link }) => link))].map((name) => ({ kind: "links", name }));
    this.all = [...links, ...scene.cylinders.map(({ name }) => ({ kind: "cylinders", name }))];
    const group = (label, kind) => {
      const own = this.all.filter((part) => part.kind === kind);
      return own.length ? [element("optgroup", { label }, ...own.map((part) => new Option(spoken(part.name), key(part))))] : [];
    };
    const before = key(this.part);
    this.list.replaceChildren(new Option("Parts …", ""), ...group("Links", "links"), ...group("Cylinders", "cylinders"));
    this.choose(before);
  }

  /** Marks a part, by its key; none for any other text. */
  choose(chosen) {
    this.part = this.all?.find((part) => key(part) === chosen) ?? null;
    this.list.value = key(this.part);
    this.stage.viewer?.mark(this.part);
    this.follow();
  }

  /** What is known of the part now. */
  follow() {
    const { part, stage: { crane, player } } = this;
    this.words.textContent = part ? facts(crane, part, player.t).join(" · ") : "";
    this.words.hidden = !part;
    this.link.hidden = !part || this.find(part) === null;
  }
}

/** A part as a text. */
const key = (part) => (part ? `${part.kind} ${part.name}` : "");

/** The mass of a link and the positions of its joint, or length and force of a cylinder, at a time. */
function facts({ scene, coordinates, run }, { kind, name }, t) {
  const now = place(run.t, t);
  const value = (name, label) => {
    const column = run.column(name);
    const number = column && at(column.values, now);
    if (!known(number)) return [];
    const { unit, factor } = always(column.unit);
    return [`${label} ${measured(number * factor, unit)}`];
  };
  if (kind === "cylinders") return ["length", "force"].flatMap((what) => value(`${name}_${what}`, what));
  const bodies = scene.bodies.filter(({ link }) => link === name);
  const mass = bodies.reduce((sum, one) => sum + one.mass, 0);
  const moved = coordinates.slice(...bodies[0].moved_by).filter(({ role }) => ["driven", "passive"].includes(role));
  return [measured(mass, "kg"), ...moved.flatMap((one) => value(one.name, spoken(one.name)))];
}
