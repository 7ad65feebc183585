// The view in three dimensions: cranes, ground, traces, forces, camera.
import {
  ACESFilmicToneMapping, ArrowHelper, Color, DirectionalLight, Fog, GridHelper, Group, HemisphereLight, Mesh, MeshBasicMaterial,
  MeshLambertMaterial, PCFShadowMap, PerspectiveCamera, Raycaster, RingGeometry, Scene, SphereGeometry, Vector2, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { Line2 } from "three/examples/jsm/lines/Line2.js";
import { LineGeometry } from "three/examples/jsm/lines/LineGeometry.js";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { BEYOND, curve, isDark, scale, smooth, style } from "./colours.js";
import { at, place, range, readable } from "./data.js";
import { Figure, extent } from "./figure.js";
import { Plain } from "./plain.js";
import { margins, ordered, used } from "./strength.js";

/** Largest motion of a mode as drawn, relative to the crane's size. */
const SWING = 0.012;
/** Approximate oscillations per second of a mode as drawn. */
const WAVES = 0.5;
/** Room around the crane, relative to what it occupies, and for the thickness of its links, relative to its size. */
const ROOM = 1.04;
const MARGIN = 0.05;
/** Where the picture ends for a crane that moves, from −1 to 1. */
const EDGE = 0.97;
/** Most picture elements per point of the screen. */
const FINEST = 2;
/**
 * Levels of detail, from the best, for a graphics card and for a processor that draws: picture elements, of those that the screen has, and those across the
 * map of shadows; whether materials are plain; and the time between pictures of a motion beyond which the level is left, s. At rest it is the best; a motion
 * begins at `first` at the earliest.
 */
const DETAIL = {
  card: {
    first: 0,
    levels: [
      { ratio: 1, shadows: 2048, slow: 1 / 50 }, { ratio: 1, shadows: 512, slow: 1 / 50 }, { ratio: 1, shadows: 0, slow: 1 / 50 },
      { ratio: 0.7, shadows: 0, slow: 1 / 20 }, { ratio: 0.5, shadows: 0, slow: Infinity },
    ],
  },
  processor: {
    first: 1,
    levels: [
      { ratio: 1, shadows: 2048, slow: 0 }, { ratio: 1, shadows: 0, plain: true, slow: 1 / 50 }, { ratio: 0.7, shadows: 0, plain: true, slow: 1 / 30 },
      { ratio: 0.5, shadows: 0, plain: true, slow: Infinity },
    ],
  },
};
/** Pictures of a motion after which its detail is reconsidered; where they are very slow, so many. */
const PICTURES = { usual: 15, least: 5 };
/** Longer times between two pictures say nothing about drawing: the page was hidden. s */
const ABSENT = 3;
/** WebGL's name for the room of shaders for numbers. */
const VECTORS = 0x8dfb;
/** Rings of the ground, where haze is computed at their corners. */
const HAZE = 6;
/** Time without a change after which a picture is one of the crane at rest, ms. */
const QUIET = 400;
/** Length of the largest reaction as drawn, relative to the crane's size. */
const ARROW = 0.22;
/** Fraction of the largest reaction below which a pull is rounding. */
const ROUNDING = 1e-9;

export const VIEWS = {
  corner: [-1, -1.25, 0.62],
  x: [-1, 0, 0.06],
  y: [0, -1, 0.06],
  top: [0, -0.02, 1],
};

/** The factor of deformations at a place of its slider, from 0 to 2: 1, 2, 5, 10 … evenly along it; and in words. */
export function exaggeration(slider) {
  const value = 10 ** Number(slider);
  const factor = value < 10 ? Math.round(value * 10) / 10 : Math.round(value);
  return { factor, words: `× ${factor}` };
}

/** Whether 3-D is drawn by the processor. */
function inSoftware() {
  const gl = document.createElement("canvas").getContext("webgl2");
  const name = gl?.getParameter(gl.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER);
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  return /swiftshader|llvmpipe|software|basic render/i.test(name);
}

export class Viewer {
  /** Where the processor draws, edges are smoothed by more picture elements, and only at rest; motions are drawn plainly. */
  constructor(canvas, data, player) {
    this.soft = inSoftware();
    Object.assign(this, DETAIL[this.soft ? "processor" : "card"]);
    this.canvas = canvas;
    this.player = player;
    this.factor = 1;
    /** Level of detail of motions, as far as it is known. */
    this.detail = this.first;
    /** What is drawn now is a motion. */
    this.moves = false;
    /** The crane follows the levers; somebody turns the view. */
    this.driven = this.held = false;
    this.seen = true;
    /** Called after every picture. */
    this.drawn = null;
    /** Pictures since the detail was considered, the time that they took, when the last was drawn, and how long it waited for numbers, s. */
    this.pace = { pictures: 0, spent: 0, last: null, waited: 0 };
    this.renderer = new WebGLRenderer({ canvas, antialias: !this.soft });
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.renderer.toneMapping = ACESFilmicToneMapping;
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(34, 1);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.maxPolarAngle = 0.56 * Math.PI;
    this.controls.listenToKeyEvents(canvas);
    this.controls.addEventListener("change", () => this.draw());
    this.controls.addEventListener("start", () => {
      this.held = true;
      this.view = null;
    });
    this.controls.addEventListener("end", () => (this.held = false));
    this.load(data);
    new ResizeObserver(() => this.resize()).observe(canvas);
    new IntersectionObserver((entries) => this.sight(entries.at(-1).isIntersecting)).observe(canvas);
    this.resize();
    this.look("corner");
    player.follow(() => this.show());
  }

  /** Shows these cranes, in place of others, seen from where the camera is. */
  load({ crane, rigid }) {
    this.crane = crane;
    this.rigid = rigid;
    this.mode = null;
    this.player.loops = false;
    this.figure = new Figure(crane);
    this.extent = extent(this.figure);
    const { size } = this.extent;
    Object.assign(this.camera, { near: 0.01 * size, far: 60 * size }).updateProjectionMatrix();
    // What is shown no longer keeps its programs on the graphics card until those of the new cranes are there.
    if (this.content) this.stale = this.content;
    this.scene.remove(this.content);
    this.content = new Group();
    this.scene.add(this.content);
    this.content.add(this.figure.group);
    this.figure.mark(this.marked ?? null);
    this.ghost = rigid ? new Figure(rigid, { ghost: true }) : null;
    if (this.ghost) this.content.add(this.ghost.group);
    this.used = used(crane);
    /** Value at the end of the colour scale. */
    this.full = this.used.unit === "1" ? 1 : Math.max(...this.used.beams.flatMap(({ sections }) => sections.map(({ most }) => most)), 1e-9);
    this.runs = new Map([crane, rigid].filter(Boolean).map((one) => [one, one.coordinates.map((c) => one.run.column(c.name).values)]));
    this.lights();
    this.ground();
    this.traces();
    this.forces();
    this.tippingLines();
    if (this.soft) {
      const { figure, ghost, floor, grid, renderer } = this;
      this.plain = new Plain({ figure, ghost, floor, grid, size, vectors: renderer.getContext().getParameter(VECTORS) });
      this.content.add(this.plain.group);
    }
    this.theme();
  }

  lights() {
    const { size, centre } = this.extent;
    this.sky = new HemisphereLight(0xffffff, 0x8a8f96, 1.5);
    const sun = new DirectionalLight(0xffffff, 2.6);
    sun.position.copy(centre).add(new Vector3(-0.9, -0.7, 1.6).multiplyScalar(size));
    sun.target.position.copy(centre);
    this.sun = sun;
    this.shade();
    sun.shadow.bias = -0.0004;
    sun.shadow.normalBias = 0.002 * size;
    Object.assign(sun.shadow.camera, { left: -size, right: size, top: size, bottom: -size, near: 0.1 * size, far: 4 * size });
    this.content.add(this.sky, sun, sun.target);
  }

  /** Level ground under the lowest foot, with a grid whose squares are a round number of metres. */
  ground() {
    const { low, size, centre } = this.extent;
    const { supports } = this.crane.scene;
    const level = supports.length ? Math.min(...supports.map(({ at: [, , z] }) => z)) - 0.008 * size : Math.min(low.z, 0);
    this.floor = new Mesh(new RingGeometry(0, 6 * size, 48, this.soft ? HAZE : 1), new MeshLambertMaterial());
    this.floor.position.set(centre.x, centre.y, level);
    this.floor.receiveShadow = true;
    const square = 10 ** Math.round(Math.log10(size / 12));
    const count = 2 * Math.ceil((1.6 * size) / square);
    this.grid = new GridHelper(count * square, count);
    this.grid.rotation.x = Math.PI / 2;
    this.grid.position.set(Math.round(centre.x), Math.round(centre.y), level + 0.0015 * size);
    this.grid.material.transparent = true;
    this.grid.material.opacity = 0.35;
    this.content.add(this.floor, this.grid);
    this.square = square;
  }

  /** The path of each point of interest: in full, and up to the present time. */
  traces() {
    const { crane } = this;
    // A crane at rest has none.
    const points = crane.run.rows > 1 ? crane.scene.points : [];
    this.paths = points.map(({ name }, index) => {
      const [x, y, z] = ["x", "y", "z"].map((axis) => crane.run.column(`${name}_${axis}`).values);
      const places = [];
      for (let row = 0; row < crane.run.rows; row += 1) places.push(x[row], y[row], z[row]);
      const line = (width, opacity) => {
        const material = new LineMaterial({ linewidth: width, transparent: true, opacity, worldUnits: false });
        const path = new Line2(new LineGeometry().setPositions(places), material);
        path.frustumCulled = false;
        this.content.add(path);
        return path;
      };
      const dot = new Mesh(new SphereGeometry(0.008 * this.extent.size, 20, 12), new MeshBasicMaterial());
      this.content.add(dot);
      return { index, whole: line(1.2, 0.3), come: line(3, 1), dot };
    });
  }

  /** An arrow for the force of each support. */
  forces() {
    const { crane, extent: { size } } = this;
    const column = (name, axis) => crane.run.column(`${name}_reaction_${axis}`);
    this.reactions = crane.scene.supports.map(({ name, at: local }) => {
      const values = ["x", "y", "z"].map((axis) => column(name, axis).values);
      const arrow = new ArrowHelper(new Vector3(0, 0, 1), new Vector3(), 1, 0xffffff);
      this.content.add(arrow);
      return { values, local: new Vector3(...local), arrow };
    });
    const upwards = crane.scene.supports.map(({ name }) => column(name, "z"));
    this.greatest = Math.max(...upwards.flatMap(({ least, most }) => [Math.abs(least), Math.abs(most)]), 1e-9);
    this.arrow = (ARROW * size) / this.greatest;
    this.pulls = upwards.some(({ least }) => least < -ROUNDING * this.greatest);
  }

  /** The lines between feet about which the crane could tip over, and one line to draw the governing one. */
  tippingLines() {
    const foot = (name) => this.reactions[this.crane.scene.supports.findIndex((support) => support.name === name)];
    const known = margins(this.crane).map(({ name, values }) => ({ values, feet: name.split(" – ").map(foot) }));
    this.lines = known.filter(({ feet }) => feet.length === 2 && feet.every(Boolean));
    // Visible through the truck.
    const material = new LineMaterial({ linewidth: 4, worldUnits: false, depthTest: false, transparent: true });
    this.tipping = new Line2(new LineGeometry().setPositions([0, 0, 0, 1, 0, 0]), material);
    this.tipping.frustumCulled = false;
    this.tipping.visible = false;
    this.content.add(this.tipping);
  }

  /** Draws the line with the least margin now. */
  tip(here) {
    this.tipping.visible = this.lines.length > 0 && this.tippingShown !== false && !this.mode;
    if (!this.tipping.visible) return;
    const now = this.lines.map(({ values }) => at(values, here));
    const margin = Math.min(...now);
    const base = this.figure.kinematics.frames[0];
    const places = this.lines[now.indexOf(margin)].feet.map(({ local }) => local.clone().applyMatrix4(base));
    this.tipping.geometry.setPositions(places.flatMap((place) => place.toArray()));
    this.tipping.material.color.set(margin <= 0 ? BEYOND : style("--strong"));
  }

  look(view) {
    this.view = view;
    this.fit(new Vector3(...VIEWS[view]).normalize());
  }

  /** Where the crane is seen from: the name of a view, or place and target of the camera, m, and the ratio of the picture's sides. */
  get seenFrom() {
    if (this.view) return this.view;
    return [...this.camera.position, ...this.controls.target, this.camera.aspect].map((number) => Number(number.toPrecision(5)));
  }

  /** Looks from there again; from farther away in a narrower picture. Anything else changes nothing. */
  set seenFrom(from) {
    if (typeof from === "string" && Object.hasOwn(VIEWS, from)) this.look(from);
    if (!Array.isArray(from) || from.length !== 7 || !from.every(Number.isFinite)) return;
    const [place, target] = [new Vector3(...from.slice(0, 3)), new Vector3(...from.slice(3, 6))];
    const { size } = this.extent;
    const way = place.sub(target);
    if (way.length() < 0.01 * size || way.length() > 50 * size || target.distanceTo(this.extent.centre) > 50 * size) return;
    this.view = null;
    this.camera.position.copy(target).addScaledVector(way, Math.max(from[6] / this.camera.aspect, 1));
    this.controls.target.copy(target);
    this.controls.update();
    this.draw();
  }

  /** The part of the crane at a place of the window, `{kind, name}`; `null`: none. */
  pick(x, y) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const ray = new Raycaster();
    ray.setFromCamera(new Vector2((2 * (x - left)) / width - 1, 1 - (2 * (y - top)) / height), this.camera);
    // What is drawn plainly is drawn by other meshes.
    this.figure.group.updateMatrixWorld();
    return ray.intersectObject(this.figure.group).find(({ object }) => object.userData.part)?.object.userData.part ?? null;
  }

  /** Marks a part of this crane and of those that are shown later; `null`: none. */
  mark(part) {
    this.marked = part;
    this.figure.mark(part);
    this.show();
  }

  /** Looks from a direction, from as near as shows all places of the crane. */
  fit(from) {
    const { centre, size } = this.extent;
    this.camera.position.copy(centre).addScaledVector(from, size);
    this.camera.lookAt(centre);
    this.camera.updateMatrixWorld();
    // Aims at the middle of what is visible, from as near as keeps every point within the angle of view.
    const seen = this.extent.places.map((place) => place.clone().applyMatrix4(this.camera.matrixWorldInverse));
    const [across, up] = ["x", "y"].map((axis) => {
      const [least, most] = range(seen.map((place) => place[axis]));
      return (least + most) / 2;
    });
    const target = centre.clone();
    target.addScaledVector(new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0), across);
    target.addScaledVector(new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 1), up);
    const slope = Math.tan(((this.camera.fov / 2) * Math.PI) / 180);
    const distance = Math.max(...seen.map(({ x, y, z }) => {
      const off = Math.max(Math.abs(y - up), Math.abs(x - across) / this.camera.aspect);
      return size + z + (ROOM * off + MARGIN * size) / slope;
    }));
    this.camera.position.copy(target).addScaledVector(from, distance);
    this.controls.target.copy(target);
    this.controls.update();
    this.draw();
  }

  /** Steps back, if the crane as it is posed now leaves the picture: seen from where it was. */
  follow() {
    const { frames, points } = this.figure.kinematics;
    const now = [...frames.map((frame) => new Vector3().setFromMatrixPosition(frame)), ...points.map((_, index) => this.figure.kinematics.point(index))];
    const left = now.filter((place) => {
      const { x, y } = place.clone().project(this.camera);
      return Math.max(Math.abs(x), Math.abs(y)) > EDGE;
    });
    if (!left.length) return;
    this.extent.places.push(...left.map((place) => place.clone()));
    this.fit(this.camera.position.clone().sub(this.controls.target).normalize());
  }

  /** The level of detail now. */
  get level() {
    return this.moves ? this.detail : 0;
  }

  /** Whether pictures follow each other by themselves. */
  get plays() {
    return this.player.playing || this.driven;
  }

  /** The crane, or what it is seen from, begins to move or came to rest. */
  move(moves) {
    if (moves === this.moves) return;
    const before = this.level;
    this.moves = moves;
    this.pace = { pictures: 0, spent: 0, last: null, waited: 0 };
    // Another motion may be drawn faster.
    if (!moves) this.detail = Math.max(this.detail - 1, this.first);
    if (this.level !== before) this.change();
  }

  /** Takes another level of detail. */
  change() {
    this.shade();
    this.resize(false);
  }

  /** Nothing has changed for a while: the crane rests, unless it is only that its pictures take long. */
  settle() {
    if (this.plays || this.held) this.quiet = setTimeout(() => this.settle(), QUIET);
    else this.move(false);
  }

  /** Less detail where pictures of a motion follow each other slowly. */
  measure() {
    const now = performance.now() / 1000;
    const { pace } = this;
    const took = pace.last === null ? ABSENT : now - pace.last - pace.waited;
    Object.assign(pace, { last: now, waited: 0 });
    if (!this.moves || !this.plays || took >= ABSENT) return;
    pace.pictures += 1;
    pace.spent += took;
    const { slow } = this.levels[this.level];
    const { usual, least } = PICTURES;
    if (pace.pictures < usual && !(pace.pictures >= least && pace.spent > usual * slow)) return;
    const isSlow = pace.spent > pace.pictures * slow;
    Object.assign(pace, { pictures: 0, spent: 0 });
    if (!isSlow || !this.levels[this.level + 1]) return;
    this.detail = this.level + 1;
    this.change();
  }

  /** Time that the next picture waited for numbers, s: this is not drawing. */
  wait(took) {
    this.pace.waited += took;
  }

  /** Out of sight nothing is drawn, and a mode, which has no end, pauses. */
  sight(seen) {
    this.seen = seen;
    const { player } = this;
    if (!seen && this.mode && player.playing) {
      player.play(false);
      this.paused = true;
    } else if (seen) {
      if (this.paused && this.mode) player.play(true);
      this.paused = false;
      if (this.due) this.draw(false);
    }
  }

  shade() {
    const { shadows } = this.levels[this.level];
    const { sun } = this;
    sun.castShadow = shadows > 0;
    sun.shadow.mapSize.setScalar(Math.max(shadows, 1));
    sun.shadow.map?.dispose();
    sun.shadow.map = null;
  }

  resize(changed = true) {
    const { clientWidth, clientHeight } = this.canvas;
    if (!clientWidth || !clientHeight) return;
    const smoothed = this.level === 0 && this.soft ? FINEST : Math.min(window.devicePixelRatio, FINEST);
    this.renderer.setPixelRatio(this.levels[this.level].ratio * smoothed);
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.draw(changed);
  }

  theme() {
    const sky = new Color(style("--sky"));
    this.scene.background = sky;
    this.scene.fog = new Fog(sky, 2.2 * this.extent.size, 6 * this.extent.size);
    this.floor.material.color.set(style("--floor"));
    this.grid.material.color.set(style("--grid"));
    this.grid.material.vertexColors = false;
    this.grid.material.needsUpdate = true;
    this.sky.intensity = isDark() ? 1.1 : 1.7;
    this.plain?.lit(this.sun, this.sky, this.scene.fog);
    this.paths.forEach(({ index, whole, come, dot }) => {
      for (const { material } of [whole, come, dot]) material.color.set(curve(index));
    });
    this.draw();
  }

  /** Shows a mode instead of the motion; `null`: the motion again. */
  vibrate(mode) {
    this.mode = null;
    if (mode) {
      const { figure, crane } = this;
      const rest = crane.scene.pose;
      figure.pose(rest, 1);
      const places = figure.outline();
      // Displacement per unit of the shape, from a nearby pose: near enough for linear motion.
      const small = 1e-4 / Math.max(...mode.shape.map(Math.abs));
      figure.pose(rest.map((q, i) => q + small * mode.shape[i]), 1);
      const ways = figure.outline().map((place, i) => place.distanceTo(places[i]));
      const amplitude = (small * SWING * this.extent.size) / Math.max(...ways, 1e-12);
      this.mode = { ...mode, amplitude };
    }
    this.player.loops = Boolean(mode);
    for (const { whole, come } of this.paths) whole.visible = come.visible = !mode && this.traced !== false;
    this.show();
  }

  set({ ghost, trace, arrows, tipping, factor, use }) {
    if (ghost !== undefined) this.ghostly = ghost;
    if (trace !== undefined) this.traced = trace;
    if (arrows !== undefined) this.arrows = arrows;
    if (tipping !== undefined) this.tippingShown = tipping;
    if (factor !== undefined) this.factor = factor;
    if (use !== undefined) this.use = use;
    for (const { whole, come } of this.paths) whole.visible = come.visible = this.traced !== false && !this.mode;
    this.show();
  }

  /** Takes the pose of the present time. */
  show() {
    const { t } = this.player;
    const here = place(this.crane.run.t, t);
    const motion = (crane) => this.runs.get(crane).map((values) => at(values, here));
    if (this.mode) {
      const { shape, amplitude } = this.mode;
      const waves = Math.max(1, Math.round(WAVES * this.player.duration)) / this.player.duration;
      const sway = amplitude * this.factor * Math.sin(2 * Math.PI * waves * t);
      this.figure.pose(this.crane.scene.pose.map((q, i) => q + sway * shape[i]), 1);
      this.ghost?.pose(this.rigid.scene.pose, 1);
    } else {
      this.figure.pose(motion(this.crane), this.factor);
      this.ghost?.pose(motion(this.rigid), 1);
    }
    for (const { index, come, dot } of this.paths) {
      this.figure.kinematics.point(index, dot.position);
      come.geometry.instanceCount = Math.max(1, here.low);
    }
    this.react(here);
    this.tip(here);
    this.figure.colour(this.use && !this.mode ? (name) => this.useAlong(name, here) : null);
    this.draw();
  }

  /** What the colours of beams mean, and what the end of their scale is. */
  get useInWords() {
    return this.used.unit === "1" ? ["utilisation", "1, beyond red"] : ["equivalent stress", `${readable(this.full)} MPa`];
  }

  /** Colour of a beam at a distance from its beginning, by its utilisation now; nothing at its tip is used. */
  useAlong(name, here) {
    const sections = this.used.beams.find((beam) => beam.name === name)?.sections;
    if (!sections) return null;
    const { order, x: places } = ordered(sections, here);
    const shares = order.map((index) => at(sections[index].values, here) / this.full);
    return (x) => {
      const next = places.findIndex((place) => place > x);
      if (next < 1) return smooth(shares.at(next === 0 ? 0 : -1));
      const [from, to] = [places[next - 1], places[next]];
      return smooth(shares[next - 1] + ((x - from) / (to - from)) * (shares[next] - shares[next - 1]));
    };
  }

  react(here) {
    const base = this.figure.kinematics.frames[0];
    const colours = this.reactions.map(({ values, local, arrow }) => {
      const force = new Vector3(...values.map((axis) => at(axis, here)));
      const colour = scale(force.z / this.greatest);
      const length = force.length() * this.arrow;
      arrow.visible = !this.mode && this.arrows !== false && length > 0;
      arrow.position.copy(local).applyMatrix4(base);
      arrow.setDirection(force.normalize());
      arrow.setLength(length, Math.min(0.25 * length, 0.03 * this.extent.size), 0.014 * this.extent.size);
      arrow.setColor(colour);
      return colour;
    });
    if (colours.length) this.figure.paint(colours);
  }

  /** Draws once, however often it is called before the next frame, as soon as it is in sight; `changed`: more than the level of detail has. */
  draw(changed = true) {
    if (changed) {
      clearTimeout(this.quiet);
      this.quiet = setTimeout(() => this.settle(), QUIET);
      this.move(true);
    }
    // A film needs every picture.
    this.due = !this.seen && !this.player.done;
    if (this.asked || this.due || !this.renderer) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.measure();
      this.paint();
    });
  }

  /** Draws at once, with all detail: for paper, and for a picture. */
  finish() {
    this.move(false);
    this.paint();
  }

  /** The view as it is now, a PNG image. */
  picture() {
    // The drawing is discarded once the browser has shown it.
    this.finish();
    return new Promise((done) => this.canvas.toBlob(done, "image/png"));
  }

  /** Draws at once. */
  paint() {
    const { plain } = this.levels[this.level];
    for (const one of [this.figure.group, this.floor, this.grid]) one.visible = !plain;
    const ghostly = this.ghostly !== false;
    if (this.ghost) this.ghost.group.visible = !plain && ghostly;
    if (this.plain) this.plain.show(Boolean(plain), ghostly);
    this.renderer.render(this.scene, this.camera);
    this.drawn?.();
    this.stale?.traverse((one) => {
      one.geometry?.dispose();
      one.material?.dispose();
      one.shadow?.dispose();
    });
    this.stale = null;
  }
}
