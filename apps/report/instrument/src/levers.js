// Levers of a crane: moved by pointer, keys or a gamepad; each springs back to its middle when it is let go.
import { DEGREES, spoken } from "../../src/data.js";
import { element } from "../../src/element.js";

/** Keys of each lever by their places on the keyboard: one direction and the other. */
const KEYS = ["QA", "WS", "ED", "RF", "TG", "YH", "UJ", "IK", "OL"];
/** Deflection of a gamepad's stick below which it counts as released. */
const DEAD = 0.12;
/** Room of the knob beside the middle of the end of its track. */
const ROOM = "1rem";
/** Steps of a stick from its middle to its end: every step changes the motion of a drive. */
const FINE = 16;

export class Levers {
  constructor(host) {
    this.host = host;
    this.pressed = new Set();
    this.rows = [];
    addEventListener("keydown", (event) => this.key(event, true));
    addEventListener("keyup", (event) => this.key(event, false));
    addEventListener("blur", () => this.release());
  }

  /** One lever for each drive. */
  open(drives) {
    this.rows = drives.map(({ name, unit, lever, full }, index) => {
      const keys = KEYS[index] ?? "";
      const speed = unit === "rad" ? `${Math.round(full * DEGREES)} °/s` : `${full} m/s`;
      const says = lever === "valve" ? "valve" : speed;
      const knob = element("i", {});
      const track = element("div", { className: "track", tabIndex: 0 }, knob);
      track.setAttribute("role", "slider");
      track.setAttribute("aria-label", `${spoken(name)}, ${lever === "valve" ? "opening of the valve" : `speed, at most ${speed}`}`);
      for (const [key, value] of [["valuemin", -100], ["valuemax", 100], ["valuenow", 0]]) track.setAttribute(`aria-${key}`, value);
      const row = { knob, track, pointer: 0, arrows: 0, value: 0, keys };
      const move = (event) => {
        const { left, width } = track.getBoundingClientRect();
        row.pointer = Math.max(-1, Math.min(1, ((event.clientX - left) / width) * 2 - 1));
      };
      track.addEventListener("pointerdown", (event) => {
        track.setPointerCapture(event.pointerId);
        move(event);
      });
      track.addEventListener("pointermove", (event) => track.hasPointerCapture(event.pointerId) && move(event));
      for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) track.addEventListener(end, () => (row.pointer = 0));
      track.addEventListener("keydown", ({ key }) => (row.arrows = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[key] ?? row.arrows));
      for (const end of ["keyup", "blur"]) track.addEventListener(end, () => (row.arrows = 0));
      const hints = keys && [element("kbd", { textContent: keys[1] }), element("kbd", { textContent: keys[0] })];
      row.dom = element("div", { className: "lever" }, element("span", {}, spoken(name), " ", element("small", { className: "soft", textContent: says })), ...(hints ? [hints[0]] : [element("span")]), track, ...(hints ? [hints[1]] : []));
      return row;
    });
    this.host.replaceChildren(...this.rows.map(({ dom }) => dom), element("p", { className: "soft", textContent: "Hold a key, drag a lever, or use a gamepad: sticks first, then the buttons at its shoulders." }));
  }

  /** Takes a key unless something is being written. */
  key(event, down) {
    const { code, target } = event;
    if (!code.startsWith("Key") || event.ctrlKey || event.metaKey || event.altKey) return;
    if (down && (target.closest?.("input, select, textarea, [contenteditable], #editor"))) return;
    if (down) this.pressed.add(code.slice(3));
    else this.pressed.delete(code.slice(3));
  }

  release() {
    this.pressed.clear();
    for (const row of this.rows) Object.assign(row, { pointer: 0, arrows: 0 });
  }

  /** Positions of all levers now, −1 to 1. */
  read() {
    const pad = [...(navigator.getGamepads?.() ?? [])].find(Boolean);
    const stick = (axis) => {
      const value = pad?.axes[axis] ?? 0;
      return Math.abs(value) < DEAD ? 0 : Math.round(value * FINE) / FINE;
    };
    const button = (index) => pad?.buttons[index]?.value ?? 0;
    // Up is positive, and a stick's axis points down.
    const sticks = [stick(0), -stick(1), -stick(3), stick(2), button(5) - button(4), button(7) - button(6)];
    const towards = (key) => Number(this.pressed.has(key));
    return this.rows.map((row, index) => {
      const keys = row.keys ? towards(row.keys[0]) - towards(row.keys[1]) : 0;
      const value = Math.max(-1, Math.min(1, row.pointer || row.arrows || keys || sticks[index] || 0));
      if (value !== row.value) {
        row.value = value;
        row.knob.style.left = `calc(50% + ${value} * (50% - ${ROOM}))`;
        row.track.setAttribute("aria-valuenow", Math.round(100 * value));
      }
      return value;
    });
  }
}
