// A run: computed in the engine, shown with all plots, played in 3-D.
import { place } from "../../src/data.js";
import { save, table } from "../../src/download.js";
import { follow, panels } from "../../src/panels.js";
import { results } from "../../src/tables.js";
import { tiles } from "../../src/tiles.js";
import { typed } from "./engine.js";

/** Longest run of a page, s of computing. */
const PATIENCE = 600;

const $ = (selector) => document.querySelector(selector);

/** Whether an element is on the screen. */
function seen(one) {
  const { top, bottom } = one.getBoundingClientRect();
  return bottom > 0 && top < innerHeight;
}

export class Run {
  /** `ask(request, seconds)` asks the engine, `end()` ends what it computes, `given()` is what the sliders say, `note(words)` is the line under the crane. */
  constructor(host, stage, { ask, end, given, note }) {
    Object.assign(this, { host, stage, ask, given, note, plots: [], along: [], data: null });
    this.results = host.querySelector(".results");
    $("#start").addEventListener("click", () => this.start());
    $("#cancel").addEventListener("click", () => end("ended"));
    const { player } = stage;
    $("#play").addEventListener("click", () => player.play(!player.playing));
    $("#time").addEventListener("input", ({ target }) => player.seek(Number(target.value)));
    $("#speed").addEventListener("change", ({ target }) => (player.speed = Number(target.value)));
    player.changed = () => {
      $("#play").textContent = player.playing ? "❚❚" : "▶";
      $("#play").setAttribute("aria-label", player.playing ? "Pause" : "Play");
    };
    player.follow((t) => this.follow(t));
    host.closest("#panel").addEventListener("scroll", () => this.marks(), { passive: true });
  }

  open(crane) {
    const { textContent: words } = $("#run_state");
    $("#duration").value = crane.duration;
    this.clear();
    if (words.startsWith("ended")) $("#run_state").textContent = words;
  }

  clear() {
    for (const plot of this.plots) plot.plot.destroy();
    Object.assign(this, { plots: [], along: [], data: null });
    this.results.replaceChildren();
    $("#playing").hidden = true;
    $("#run_state").textContent = "";
  }

  async start() {
    this.clear();
    $("#start").disabled = true;
    $("#cancel").hidden = false;
    $("#run_state").textContent = "computing …";
    try {
      const duration = await typed(this.ask, $("#duration").value, { name: "the duration", unit: "s" });
      const { parameters } = this.given();
      const data = await this.ask({ ask: "run", parameters, duration }, PATIENCE);
      this.show(data);
      $("#run_state").textContent = `${duration} s in ${(data.took / 1000).toFixed(2)} s`;
    } catch ({ message }) {
      $("#run_state").textContent = message;
    } finally {
      $("#start").disabled = false;
      $("#cancel").hidden = true;
    }
  }

  show(answer) {
    const { stage } = this;
    this.data = answer;
    this.shown = stage.show(answer, { run: true });
    this.says();
    this.results.replaceChildren($("#results_of_a_run").content.cloneNode(true));
    tiles(this.shown, this.results.querySelector("#verdict"), this.results.querySelector("#tiles"));
    results(this.shown.tables, this.results.querySelector("#tables .tables"));
    Object.assign(this, panels(this.shown, stage.player, this.results));
    for (const section of this.results.querySelectorAll("section:has(> .panels:empty)")) section.remove();
    const { name, run } = this.shown.crane;
    this.results.querySelector("#all").addEventListener("click", () => save(`${name}.csv`, table(run.list), "text/csv"));
    $("#playing").hidden = false;
    $("#time").max = stage.player.duration;
    stage.player.play(!matchMedia("(prefers-reduced-motion: reduce)").matches);
  }

  /** Shows the last run again, after something else was shown. */
  again() {
    if (!this.data) return;
    if (this.stage.crane !== this.shown.crane) this.stage.present(this.shown.crane, true);
    this.says();
  }

  says() {
    this.note(`The run of the spec, ${this.stage.player.duration.toFixed(2)} s`);
  }

  follow(t) {
    if (!this.data || this.stage.crane !== this.shown?.crane) return;
    $("#time").value = t;
    $("#clock").textContent = `${t.toFixed(2)} s`;
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.marks();
    });
  }

  /** Brings the plots on the screen to the present time. */
  marks() {
    if (!this.data) return;
    const { t } = this.stage.player;
    const here = place(this.shown.crane.run.t, t);
    for (const plot of this.plots) if (seen(plot.frame)) plot.now(t, here);
    follow(this.along.filter(({ plot }) => seen(plot.frame)), here);
  }
}
