// A crane in three dimensions, drawn from its chain: links from frame to frame, with a thickness estimated from
// their mass, flexible links bent, with the outline of their section if the spec gives one, pins at revolute joints, legs at the supports,
// hydraulic cylinders, pads between the beams of telescopes, and springs and ropes between their points.
import { BoxGeometry, CapsuleGeometry, CylinderGeometry, Group, Matrix4, Mesh, MeshStandardMaterial, Quaternion, SphereGeometry, TorusGeometry, Vector3 } from "three";
import { BeamGeometry, sizeAt } from "./beam.js";
import { Cylinder, stretch } from "./cylinders.js";
import { Kinematics, links, matrix } from "./kinematics.js";

/** Mass per volume within the outline of a link, kg/m³: about a third of steel's. */
const FILLING = 2400;
/** Minimum and maximum thickness of a link, relative to the crane's size. */
const THICKNESS = [0.012, 0.06];
/** A length below this fraction of the crane's size counts as zero. */
const NOTHING = 1e-3;

/** Radius of a spring and of a rope as drawn, and size of a hook, relative to the crane's size. */
const RADIUS = { spring: 0.004, rope: 0.0015, hook: 0.008, sheave: 0.006 };
const [X, Y] = [new Vector3(1, 0, 0), new Vector3(0, 1, 0)];
/** Feet less far below the base's frame than this fraction of the crane's size are on its level. */
const LEVEL = 0.02;
/** Largest height of the frame of a truck above its feet if its spec does not tell, relative to the crane's size. */
const HEIGHT = 0.09;
/** Largest thickness of a leg, relative to the crane's size. */
const LEG = 0.014;

/** The corners of a box with sides of length 1. */
const CORNERS = [0, 1, 2, 3, 4, 5, 6, 7].map((index) => [1, 2, 4].map((bit) => (index & bit ? 0.5 : -0.5)));

/** Room around the axes of the links, relative to the crane's size. */
const MARGIN = 0.03;

export const COLOURS = {
  base: 0x4a5560, link: 0xe2a32b, flexible: 0x1f7fc0, stage: 0x5aa9dd, slide: 0xb9c2cb, load: 0xa5784f, pin: 0x2b3138, passive: 0x8d979f,
  barrel: 0x59636e, rod: 0xdfe4e8, linkage: 0xc98a1c, rope: 0x2b3138, pad: 0xf2f2ee, ghost: 0xd55e00, marked: 0xcc3f8f,
};

export class Figure {
  /** `ghost`: one pale colour, to be shown behind another figure. */
  constructor(crane, size, { ghost = false } = {}) {
    this.crane = crane;
    this.size = size;
    this.ghost = ghost;
    this.kinematics = new Kinematics(crane);
    this.group = new Group();
    this.parts = [];
    this.beams = [];
    this.legs = [];
    /** Heights and widths of the beams as drawn, m, by name. */
    this.sizes = new Map();
    /** How many beams are around each one. */
    this.depths = new Map();
    this.materials = new Map();
    /** What a crane without feet stands on, if it does. */
    this.plate = null;
    /** The meshes of the part that is marked. */
    this.marked = new Set();
    this.kinematics.pose(this.kinematics.reference);
    this.build();
  }

  material(colour) {
    const key = this.ghost ? COLOURS.ghost : colour;
    if (!this.materials.has(key)) {
      const paint = new MeshStandardMaterial({ color: key, roughness: 0.62, metalness: 0.15 });
      if (this.ghost) Object.assign(paint, { transparent: true, opacity: 0.3, depthWrite: false, polygonOffset: true, polygonOffsetFactor: 4, polygonOffsetUnits: 40 });
      this.materials.set(key, paint);
    }
    return this.materials.get(key);
  }

  mesh(geometry, colour) {
    const mesh = new Mesh(geometry, this.material(colour));
    mesh.castShadow = !this.ghost;
    mesh.receiveShadow = !this.ghost;
    this.group.add(mesh);
    return mesh;
  }

  /** A mesh that moves with a body. */
  part(body, mesh, local) {
    mesh.matrixAutoUpdate = false;
    mesh.userData.part = { kind: "links", name: this.kinematics.bodies[body].link };
    this.parts.push({ body, mesh, local });
  }

  /** A box from `a` to `b` in a body's frame. */
  box(body, a, b, thickness, colour) {
    if (this.ghost && colour === COLOURS.base) return;
    const way = b.clone().sub(a);
    const length = way.length();
    if (length < NOTHING * this.size) return;
    const turn = new Quaternion().setFromUnitVectors(new Vector3(1, 0, 0), way.divideScalar(length));
    const local = new Matrix4().compose(a.clone().add(b).divideScalar(2), turn, new Vector3(1, 1, 1));
    this.part(body, this.mesh(new BoxGeometry(length, thickness, thickness), colour), local);
  }

  /** The same for what the spec does not tell: nothing of a body that has forms of its own. */
  guess(body, a, b, thickness, colour) {
    if (!this.kinematics.bodies[body].formed) this.box(body, a, b, thickness, colour);
  }

  thickness(mass, length) {
    const [least, most] = THICKNESS.map((part) => part * this.size);
    const side = mass > 0 && length > 0 ? Math.sqrt(mass / (FILLING * length)) : this.usual ?? least;
    return Math.min(Math.max(side, least), most);
  }

  build() {
    const { bodies, frames } = this.kinematics;
    this.chassis = this.chassisOf();
    for (const link of links(this.kinematics)) this.beam(link);
    bodies.forEach(({ parent, link }, next) => {
      const carrier = bodies[parent];
      if (!carrier || carrier.rope || carrier.link === link && carrier.flexible) return;
      if (carrier.flexible) this.inner(parent, next, frames);
      else this.link(parent, next, frames);
    });
    this.pads();
    this.ropes();
    this.pins();
    this.hinges();
    bodies.forEach((_, p) => this.kinematics.carriedBy(p).length || this.end(p));
    this.bars();
    this.forms();
    this.stand();
    this.connect();
    const paint = { barrel: COLOURS.barrel, rod: COLOURS.rod, linkage: COLOURS.linkage, pin: COLOURS.pin };
    this.cylinders = this.crane.scene.cylinders.map((data) => new Cylinder(data, this.size, (geometry, colour) => {
      const mesh = this.mesh(geometry, colour);
      mesh.userData.part = { kind: "cylinders", name: data.name };
      return mesh;
    }, paint));
  }

  /** The links of ropes and chains, thin and straight. */
  ropes() {
    const radius = RADIUS.rope * this.size;
    this.kinematics.bodies.forEach(({ rope, length }, p) => {
      if (!rope) return;
      const local = new Matrix4().makeRotationZ(-Math.PI / 2).setPosition(length / 2, 0, 0);
      this.part(p, this.mesh(new CylinderGeometry(radius, radius, length, 12), COLOURS.rope), local);
    });
  }

  beam({ name, bodies: elements }) {
    const { bodies } = this.kinematics;
    const lengths = elements.map((p) => bodies[p].length);
    const total = lengths.reduce((sum, length) => sum + length, 0);
    const mass = elements.reduce((sum, p) => sum + bodies[p].mass, 0);
    const outline = this.crane.outlines[name];
    // A stage without a shape is narrower than the beam in which it slides.
    const outer = this.crane.scene.pads.find(({ beams: [, inner] }) => inner === name)?.beams[0];
    const likely = Math.min(this.thickness(mass, total), 0.8 * (this.sizes.get(outer)?.[0] ?? Infinity));
    const along = outline?.along ?? [[0, likely, 0.8 * likely]];
    const [height, width] = outline?.size ?? along[0].slice(1);
    const side = Math.max(height, width);
    const geometry = new BeamGeometry(lengths, along, outline?.round);
    // Every other stage of a telescope is lighter, so that it can be told from the one around it.
    const depth = outer ? (this.depths.get(outer) ?? 0) + 1 : 0;
    this.depths.set(name, depth);
    const mesh = this.mesh(geometry, depth % 2 ? COLOURS.stage : COLOURS.flexible);
    mesh.frustumCulled = false;
    mesh.userData.part = { kind: "links", name };
    this.beams.push({ name, geometry, elements, mesh, plain: mesh.material });
    // Rings between the elements show where it bends.
    let begin = 0;
    elements.slice(1).forEach((p, k) => {
      begin += lengths[k];
      const [h, w] = sizeAt(along, begin);
      const s = Math.max(h, w);
      const ring = this.mesh(outline?.round ? new CylinderGeometry(0.56 * s, 0.56 * s, 0.12 * s, 32) : new BoxGeometry(0.12 * s, h + 0.12 * s, w + 0.12 * s), COLOURS.pin);
      // The cylinder's axis is y.
      this.part(p, ring, outline?.round ? new Matrix4().makeRotationZ(Math.PI / 2) : new Matrix4());
    });
    this.sizes.set(name, [height, width]);
    this.usual ??= side;
  }

  /**
   * The pads of telescopes: blocks on the four sides of the inner beam that fill the gap to the outer one. They come a little out of the faces of the outer beam, so
   * that the rear ones show where they are within it.
   */
  pads() {
    for (const { body, x, beams } of this.crane.scene.pads) {
      const [outer, inner] = beams.map((name) => this.sizes.get(name));
      const long = 0.6 * inner[0];
      for (const [side, across] of [[0, 1], [1, 0]]) {
        const thick = Math.max(0.54 * outer[side] - 0.5 * inner[side], 0.04 * inner[side]);
        const size = side === 0 ? [long, thick, 0.6 * inner[across]] : [long, 0.6 * inner[across], thick];
        for (const sign of [-1, 1]) {
          const shift = sign * 0.5 * (inner[side] + thick);
          const local = new Matrix4().setPosition(x, side === 0 ? shift : 0, side === 0 ? 0 : shift);
          this.part(body, this.mesh(new BoxGeometry(...size), COLOURS.pad), local);
        }
      }
    }
  }

  /** From a body's origin to where another one begins that it carries; a sliding one comes out of it. */
  link(p, next, frames) {
    const { bodies, coordinates, reference, screws } = this.kinematics;
    const body = bodies[p];
    const inverse = frames[p].clone().invert();
    const origin = new Vector3();
    const far = new Vector3().setFromMatrixPosition(frames[next]).applyMatrix4(inverse);
    const slides = this.kinematics.slides(next);
    const outline = this.thickness(body.mass, far.length());
    if (body.mass > 0 && far.length() > NOTHING * this.size && coordinates[body.moved_by[1] - 1]?.role !== "base") this.usual ??= outline;
    if (slides.length !== 1) {
      const isBase = p === 0 && coordinates[0]?.role === "base";
      // On a truck, from its frame up.
      const from = isBase && this.chassis ? far.clone().setZ(Math.min(this.chassis.level, far.z)) : origin;
      this.guess(p, from, far, outline, isBase ? COLOURS.base : COLOURS.link);
      return;
    }
    const [j] = slides;
    const axis = new Vector3(...screws[j].slice(3)).transformDirection(inverse);
    const travel = this.travel(j);
    const home = far.clone().addScaledVector(axis, -reference[j]);
    const sleeve = home.length() > NOTHING * this.size ? home : home.addScaledVector(axis, travel[0]);
    const side = this.thickness(body.mass, Math.max(sleeve.length(), far.length() / 2));
    this.guess(p, origin, sleeve, side, COLOURS.link);
    // A beam shows itself.
    if (bodies[next].flexible) return;
    // Long enough to stay in its sleeve at the far end of its travel.
    const inside = new Vector3().setFromMatrixPosition(frames[p]).applyMatrix4(frames[next].clone().invert());
    const back = axis.transformDirection(frames[p]).transformDirection(frames[next].clone().invert()).negate();
    const reach = Math.min(Math.abs(travel[1]) + 0.5 * side, inside.length() + Math.abs(travel[1] - reference[j]));
    this.guess(next, origin.clone(), back.multiplyScalar(reach), 0.78 * side, COLOURS.slide);
  }

  /** What slides out of a flexible beam: the beam is its sleeve. */
  inner(p, next, frames) {
    const { bodies, screws, reference } = this.kinematics;
    // A beam shows itself.
    if (bodies[next].flexible) return;
    const slides = this.kinematics.slides(next);
    if (slides.length !== 1) return;
    const [j] = slides;
    const back = new Vector3(...screws[j].slice(3)).transformDirection(frames[next].clone().invert()).negate();
    const [least, most] = this.travel(j);
    const side = 0.7 * (this.usual ?? this.thickness(bodies[next].mass, 1));
    // From its frame back into the beam, far enough to stay in it at the far end of its travel; its part outside is drawn as a link.
    const reach = Math.max(Math.abs(most), Math.abs(least), Math.abs(reference[j])) + 0.5 * side;
    this.guess(next, new Vector3(), back.multiplyScalar(reach), side, COLOURS.slide);
  }

  /** Minimum and maximum of a coordinate over the run. */
  travel(j) {
    const values = this.crane.run.column(this.crane.coordinates[j].name).values;
    return [Math.min(...values), Math.max(...values)];
  }

  /** A pin where a joint turns, on its axis; dark where a drive turns it. */
  pins() {
    const { bodies, coordinates, screws, frames } = this.kinematics;
    coordinates.forEach(({ role, unit }, j) => {
      if (unit !== "rad" || !["driven", "passive"].includes(role)) return;
      const p = bodies.findIndex((body) => body.moved_by[1] > j);
      if (bodies[p].rope || bodies[bodies[p].parent]?.rope) return;
      // Pads hold a stage, no pins.
      if (this.crane.scene.pads.some((pad) => pad.body === p && pad.x === 0)) return;
      const axis = new Vector3(...screws[j].slice(0, 3)).transformDirection(frames[p].clone().invert());
      const upright = Math.abs(screws[j][2]) > 0.9;
      const side = this.thickness(bodies[p].mass, 0);
      const radius = (upright && p <= 1 ? 1.1 : 0.5) * side;
      const turn = new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), axis.normalize());
      const local = new Matrix4().compose(new Vector3(), turn, new Vector3(1, 1, 1));
      const height = (upright && p <= 1 ? 0.5 : 1.35) * side;
      const geometry = new CylinderGeometry(radius, radius, height, 28);
      this.part(p, this.mesh(geometry, role === "driven" ? COLOURS.pin : COLOURS.passive), local);
    });
  }

  /** Pins and balls that close loops. */
  hinges() {
    for (const { body, at, axis } of this.crane.scene.hinges) {
      const side = this.thickness(this.kinematics.bodies[body].mass, 0);
      const turn = new Quaternion().setFromUnitVectors(Y, axis ? new Vector3(...axis) : Y);
      const geometry = axis ? new CylinderGeometry(0.5 * side, 0.5 * side, 1.35 * side, 28) : new SphereGeometry(0.6 * side, 20, 12);
      this.part(body, this.mesh(geometry, COLOURS.passive), new Matrix4().compose(new Vector3(...at), turn, new Vector3(1, 1, 1)));
    }
  }

  /** What the last body of a branch carries: a stem to its points, a rod through them, or a block of its mass. */
  end(p) {
    const { bodies, points } = this.kinematics;
    if (bodies[p].flexible || bodies[p].formed) return;
    const places = points.filter((point) => point.body === p).map((point) => point.at);
    const bars = this.crane.scene.bars.filter(({ body }) => body === p);
    // Where its mass is known to be elsewhere, a bar leads there.
    if (!places.length && bars.length) return;
    const mass = bars.some(({ block }) => block > 0) ? 0 : bodies[p].mass;
    const middle = places.reduce((sum, place) => sum.add(place), new Vector3()).divideScalar(Math.max(places.length, 1));
    let [from, to] = [middle, middle];
    for (const a of places) for (const b of places) if (a.distanceTo(b) > from.distanceTo(to)) [from, to] = [a, b];
    const hangs = bodies[bodies[p].parent]?.rope;
    const stem = hangs ? 2 * RADIUS.rope * this.size : this.thickness(0, 0) * 0.5;
    this.box(p, new Vector3(), middle, stem, hangs ? COLOURS.rope : COLOURS.link);
    if (hangs) this.hook(p, middle);
    if (from.distanceTo(to) > NOTHING * this.size) {
      const rod = this.thickness(mass, from.distanceTo(to)) / 2;
      const turn = new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), to.clone().sub(from).normalize());
      const local = new Matrix4().compose(from.clone().add(to).divideScalar(2), turn, new Vector3(1, 1, 1));
      this.part(p, this.mesh(new CylinderGeometry(rod, rod, from.distanceTo(to), 32), COLOURS.load), local);
    } else if (mass > 0) {
      const side = Math.min(Math.cbrt(mass / FILLING), 0.15 * this.size);
      // Below what it hangs from.
      const height = hangs ? Math.min(side, Math.max(1.4 * middle.length(), 0.3 * side)) : side;
      const width = Math.sqrt(side ** 3 / height);
      const turn = new Quaternion();
      if (middle.length() > NOTHING * this.size) turn.setFromUnitVectors(new Vector3(1, 0, 0), middle.clone().normalize());
      const local = new Matrix4().compose(middle, turn, new Vector3(1, 1, 1));
      this.part(p, this.mesh(new BoxGeometry(height, width, width), COLOURS.load), local);
    }
  }

  /** A hook at the end of a rope, open towards what hangs from it. */
  hook(p, middle) {
    const size = RADIUS.hook * this.size;
    const down = middle.length() > NOTHING * this.size ? middle.clone().normalize() : new Vector3(1, 0, 0);
    const turn = new Quaternion().setFromUnitVectors(new Vector3(0, -1, 0), down);
    const local = new Matrix4().compose(new Vector3(), turn, new Vector3(1, 1, 1));
    this.part(p, this.mesh(new TorusGeometry(size, 0.3 * size, 10, 28, 1.6 * Math.PI), COLOURS.rope), local);
  }

  /** Bars to points, pins and masses that links and beams do not reach; a block for a mass at its end. */
  bars() {
    for (const { body, from, to, block, main } of this.crane.scene.bars) {
      const { mass, flexible } = this.kinematics.bodies[body];
      const [begin, end] = [new Vector3(...from), new Vector3(...to)];
      const side = main ? this.thickness(mass, begin.distanceTo(end)) : 0.7 * this.thickness(0, 0);
      this.box(body, begin, end, side, flexible ? COLOURS.flexible : COLOURS.link);
      if (block > 0) this.block(body, block, end, end.clone().sub(begin));
    }
  }

  /** A block of a mass at a place of a body, along a direction. */
  block(body, mass, at, along) {
    const side = Math.min(Math.cbrt(mass / FILLING), 0.15 * this.size);
    const turn = new Quaternion();
    if (along.length() > NOTHING * this.size) turn.setFromUnitVectors(new Vector3(1, 0, 0), along.clone().normalize());
    this.part(body, this.mesh(new BoxGeometry(side, side, side), COLOURS.load), new Matrix4().compose(at, turn, new Vector3(1, 1, 1)));
  }

  /** What the spec says that links look like. */
  forms() {
    for (const { body, frame, kind, sides: [x, y, z] } of this.crane.scene.forms) {
      const radius = x / 2;
      const geometries = { box: () => new BoxGeometry(x, y, z), cylinder: () => new CylinderGeometry(radius, radius, z, 28), capsule: () => new CapsuleGeometry(radius, z - x, 8, 16) };
      const local = matrix(frame);
      // The axis of round ones is y.
      if (kind !== "box") local.multiply(new Matrix4().makeRotationX(Math.PI / 2));
      const isBase = body === 0 && this.crane.coordinates[0]?.role === "base";
      if (this.ghost && isBase) continue;
      this.part(body, this.mesh(geometries[kind](), isBase ? COLOURS.base : COLOURS.link), local);
    }
  }

  stand() {
    // A ghost differs only above its base.
    if (this.ghost) return;
    const supports = this.crane.scene.supports.map(({ at }) => new Vector3(...at));
    if (supports.length) this.feet(supports);
    else if (this.crane.coordinates[0]?.role !== "base") this.pedestal();
  }

  /** The base of a fixed crane: a plate at the world's origin, and a pillar to where its first body begins. */
  pedestal() {
    const { bodies, frames } = this.kinematics;
    if (!bodies.length) return;
    const side = this.thickness(bodies[0].mass, 0);
    const first = new Vector3().setFromMatrixPosition(frames[0]);
    const slides = this.crane.coordinates.slice(...bodies[0].moved_by).some(({ unit }) => unit === "m");
    const plate = this.plate = this.mesh(new CylinderGeometry(2 * side, 2 * side, 0.5 * side, 40), COLOURS.base);
    // A beam that begins at the origin is clamped to a wall.
    const normal = bodies[0].flexible && first.length() < NOTHING * this.size ? new Vector3().setFromMatrixColumn(frames[0], 0) : new Vector3(0, 0, 1);
    plate.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), normal);
    plate.position.addScaledVector(normal, -0.25 * side);
    if (slides || first.length() < NOTHING * this.size) return;
    const pillar = this.mesh(new BoxGeometry(first.length(), 1.1 * side, 1.1 * side), COLOURS.base);
    pillar.quaternion.setFromUnitVectors(new Vector3(1, 0, 0), first.clone().normalize());
    pillar.position.copy(first).divideScalar(2);
  }

  /**
   * The frame of a truck above its feet: its level, its depth down to them, its own height, and where the crane begins. A spec whose frame is on the ground does not tell how
   * high it is: it is drawn where the crane begins.
   */
  chassisOf() {
    const feet = this.crane.scene.supports.map(({ at }) => at[2]);
    if (!feet.length) return null;
    const least = LEVEL * this.size;
    const [low, high] = [Math.min(...feet), Math.max(...feet, 0)];
    const { frames } = this.kinematics;
    const begin = new Vector3();
    if (frames.length > 1) begin.setFromMatrixPosition(frames[1]).applyMatrix4(frames[0].clone().invert());
    const top = high - low < least ? low + Math.min(Math.max(begin.z, least), HEIGHT * this.size) : high;
    const depth = Math.max(top - low, least);
    const height = Math.min(0.55 * depth, 2 * LEG * this.size);
    return { level: top - 0.35 * depth, depth, height, begin };
  }

  /** A frame over the supports with a leg to each. */
  feet(supports) {
    const spread = (axis) => Math.max(...supports.map((s) => s[axis])) - Math.min(...supports.map((s) => s[axis]));
    const middle = (axis) => (Math.max(...supports.map((s) => s[axis])) + Math.min(...supports.map((s) => s[axis]))) / 2;
    const { level, depth, height, begin } = this.chassis;
    // As long as the feet are apart, or wide, so that the crane stands on it.
    const stands = (axis) => Math.abs(begin[axis] - middle(axis)) <= 0.19 * spread(axis);
    const across = spread("x") > spread("y") ? "y" : "x";
    const wide = stands(across) ? across : ["x", "y"].find(stands) ?? across;
    const long = wide === "x" ? "y" : "x";
    const beam = new Vector3();
    beam[long] = spread(long) + 0.6 * Math.min(depth, 2 * height);
    beam[wide] = 0.38 * spread(wide);
    beam.z = height;
    const centre = new Vector3(0, 0, level);
    centre[long] = middle(long);
    centre[wide] = middle(wide);
    if (!this.kinematics.bodies[0].formed) this.part(0, this.mesh(new BoxGeometry(beam.x, beam.y, beam.z), COLOURS.base), new Matrix4().setPosition(centre));
    const side = Math.min(0.3 * depth, LEG * this.size);
    this.legs = supports.map((support) => {
      const root = centre.clone();
      root[long] = support[long];
      const knee = support.clone().setZ(level);
      this.box(0, root, knee, 1.2 * side, COLOURS.base);
      const paint = new MeshStandardMaterial({ color: COLOURS.slide, roughness: 0.5 });
      const leg = new Mesh(new CylinderGeometry(0.55 * side, 0.55 * side, level - support.z, 20), paint);
      const foot = new Mesh(new CylinderGeometry(1.3 * side, 1.6 * side, 0.35 * side, 28), paint);
      for (const mesh of [leg, foot]) {
        mesh.castShadow = true;
        this.group.add(mesh);
      }
      const upright = new Matrix4().makeRotationX(Math.PI / 2);
      this.part(0, leg, upright.clone().setPosition(support.x, support.y, (support.z + level) / 2));
      this.part(0, foot, upright.clone().setPosition(support.x, support.y, support.z));
      return paint;
    });
  }

  /** A bar for each part of a connector, of length 1 until a pose stretches it; one for each fall of a rope, and a sheave at each point between. */
  connect() {
    this.connectors = this.crane.scene.connectors.map(({ rope, points, falls }) => {
      const radius = (rope ? RADIUS.rope : RADIUS.spring) * this.size;
      const bar = () => this.mesh(new CylinderGeometry(radius, radius, 1, 16), rope ? COLOURS.pin : COLOURS.slide);
      const counts = points.slice(1).map((_, index) => (index + 2 === points.length ? falls : 1));
      const bars = counts.map((count) => Array.from({ length: count }, bar));
      const sheave = () => this.mesh(new SphereGeometry(RADIUS.sheave * this.size, 20, 12), COLOURS.pin);
      const sheaves = points.slice(1, -1).map(sheave);
      return { bars, sheaves, apart: 4 * radius, points: points.map(({ body, at }) => ({ body, at: new Vector3(...at) })) };
    });
  }

  /** Moves the figure to a pose. */
  pose(q, factor) {
    const frames = this.kinematics.pose(q, factor);
    for (const { body, mesh, local } of this.parts) {
      mesh.matrix.multiplyMatrices(frames[body], local);
      mesh.matrixWorldNeedsUpdate = true;
    }
    for (const { geometry, elements } of this.beams) geometry.follow(elements.map((p) => frames[p]));
    for (const { bars, sheaves, apart, points } of this.connectors) {
      const places = points.map(({ body, at }) => (body === null ? at.clone() : at.clone().applyMatrix4(frames[body])));
      sheaves.forEach((mesh, index) => mesh.position.copy(places[index + 1]));
      bars.forEach((falls, part) => {
        const [from, to] = [places[part], places[part + 1]];
        // Falls hang side by side.
        const way = to.clone().sub(from);
        const side = new Vector3().crossVectors(way, Math.abs(way.y) > 0.9 * way.length() ? X : Y).normalize();
        falls.forEach((mesh, index) => {
          const shift = side.clone().multiplyScalar(apart * (index - (falls.length - 1) / 2));
          stretch(mesh, from.clone().add(shift), to.clone().add(shift));
        });
      });
    }
    for (const cylinder of this.cylinders) cylinder.follow(frames);
  }

  /** Colours the beams along their lengths: `colours(name)` is a function of the position, m, or nothing; `null`: plain. */
  colour(colours) {
    for (const { name, geometry, mesh, plain } of this.beams) {
      const colour = colours?.(name);
      if (this.marked.has(mesh)) continue;
      if (!colour) {
        mesh.material = plain;
        continue;
      }
      geometry.paint(colour);
      this.painted ??= new MeshStandardMaterial({ vertexColors: true, roughness: 0.62, metalness: 0.15 });
      mesh.material = this.painted;
    }
  }

  /** Shows one part in another colour; `null`: none. */
  mark(part) {
    for (const mesh of this.marked) mesh.material = mesh.userData.paint;
    const own = ({ userData: { part: one } }) => part && one?.kind === part.kind && one.name === part.name;
    this.marked = new Set(this.group.children.filter(own));
    for (const mesh of this.marked) {
      mesh.userData.paint = mesh.material;
      mesh.material = this.material(COLOURS.marked);
    }
  }

  /** Colours the legs: `colours`, one per support. */
  paint(colours) {
    this.legs.forEach((paint, index) => paint.color.set(colours[index]));
  }

  /** Points that the crane reaches in a pose. */
  outline() {
    const { frames, points } = this.kinematics;
    const origins = frames.map((frame) => new Vector3().setFromMatrixPosition(frame));
    const ends = this.crane.scene.bars.map(({ body, to }) => new Vector3(...to).applyMatrix4(frames[body]));
    return origins.concat(points.map((_, index) => this.kinematics.point(index)), ends);
  }
}

/** Size of a crane over its run: the diagonal of the box that its frames and points stay in. */
export function extent(crane) {
  const kinematics = new Kinematics(crane);
  const names = crane.coordinates.map((coordinate) => crane.run.column(coordinate.name).values);
  const low = new Vector3(Infinity, Infinity, Infinity);
  const high = low.clone().negate();
  const places = [];
  const include = (place) => {
    places.push(place.clone());
    low.min(place);
    high.max(place);
  };
  const step = Math.max(1, Math.floor(crane.run.rows / 60));
  for (let row = 0; row < crane.run.rows; row += step) {
    const frames = kinematics.pose(names.map((values) => values[row]));
    for (const frame of frames) include(new Vector3().setFromMatrixPosition(frame));
    kinematics.points.forEach((_, index) => include(kinematics.point(index)));
    crane.scene.bars.forEach(({ body, to }) => include(new Vector3(...to).applyMatrix4(frames[body])));
    for (const { body, frame, sides } of crane.scene.forms) {
      const pose = frames[body].clone().multiply(matrix(frame));
      for (const signs of CORNERS) include(new Vector3(...signs).multiply(new Vector3(...sides)).applyMatrix4(pose));
    }
    crane.scene.supports.forEach(({ at }) => include(new Vector3(...at).applyMatrix4(frames[0])));
    const anchors = crane.scene.connectors.flatMap(({ points }) => points.filter(({ body }) => body === null));
    anchors.forEach(({ at }) => include(new Vector3(...at)));
  }
  if (crane.coordinates[0]?.role !== "base") include(new Vector3());
  kinematics.bodies.forEach(({ flexible, length }, p) => {
    if (flexible) include(new Vector3(length, 0, 0).applyMatrix4(kinematics.frames[p]));
  });
  // Links are thicker than their axes.
  const margin = MARGIN * low.distanceTo(high);
  low.addScalar(-margin);
  high.addScalar(margin);
  return { low, high, places, size: Math.max(low.distanceTo(high), 1e-3), centre: low.clone().add(high).divideScalar(2) };
}
