// A crane in three dimensions: the shapes that the program has made of it, which move with their bodies, beams that bend, and cylinders, springs and ropes
// between the places that they hold.
import { BoxGeometry, BufferAttribute, BufferGeometry, CapsuleGeometry, CylinderGeometry, Group, Matrix4, Mesh, MeshStandardMaterial, SphereGeometry, Vector3 } from "three";
import { BeamGeometry } from "./beam.js";
import { Cylinder, stretch } from "./cylinders.js";
import { unpacked } from "./data.js";
import { Kinematics, matrix } from "./kinematics.js";

const [X, Y] = [new Vector3(1, 0, 0), new Vector3(0, 1, 0)];
/** Colours of what is marked, and of a figure behind another one. */
const [MARKED, GHOST] = [0xcc3f8f, 0xd55e00];
/** Room around the crane, relative to its size. */
const MARGIN = 0.03;

/** The solids that keep their form, from the sides of the boxes around them; round ones along z. */
const SOLIDS = {
  box: ([x, y, z]) => new BoxGeometry(x, y, z),
  cylinder: ([x, , z]) => new CylinderGeometry(x / 2, x / 2, z, 28).rotateX(Math.PI / 2),
  capsule: ([x, , z]) => (z > x ? new CapsuleGeometry(x / 2, z - x, 8, 16).rotateX(Math.PI / 2) : new SphereGeometry(x / 2, 20, 12)),
};

/** Flat triangles between corners. */
function surface(corners, triangles) {
  const [places, indices] = [unpacked(corners), unpacked(triangles)];
  const position = new Float32Array(3 * indices.length);
  indices.forEach((corner, at) => position.set(places.subarray(3 * corner, 3 * corner + 3), 3 * at));
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(position, 3));
  geometry.setIndex(Array.from(indices.keys()));
  geometry.computeVertexNormals();
  return geometry;
}

export class Figure {
  /** `ghost`: one pale colour, to be shown behind another figure. */
  constructor(crane, { ghost = false } = {}) {
    this.crane = crane;
    this.ghost = ghost;
    this.kinematics = new Kinematics(crane);
    this.group = new Group();
    this.materials = new Map();
    this.parts = [];
    /** The colours of the legs. */
    this.legs = crane.scene.supports.map(() => new MeshStandardMaterial({ color: crane.scene.paints.slide, roughness: 0.5 }));
    /** The meshes of the part that is marked. */
    this.marked = new Set();
    this.build();
  }

  material(paint) {
    const key = this.ghost ? GHOST : paint;
    if (!this.materials.has(key)) {
      const paint = new MeshStandardMaterial({ color: key, roughness: 0.62, metalness: 0.15 });
      if (this.ghost) Object.assign(paint, { transparent: true, opacity: 0.3, depthWrite: false, polygonOffset: true, polygonOffsetFactor: 4, polygonOffsetUnits: 40 });
      this.materials.set(key, paint);
    }
    return this.materials.get(key);
  }

  mesh(geometry, paint, part = null) {
    const mesh = new Mesh(geometry, this.material(this.crane.scene.paints[paint]));
    mesh.castShadow = mesh.receiveShadow = !this.ghost;
    mesh.userData.part = part;
    this.group.add(mesh);
    return mesh;
  }

  build() {
    const { parts, beams, connectors, cylinders } = this.crane.scene;
    const { bodies } = this.kinematics;
    // A ghost differs only above its base.
    const shown = parts.filter(({ body, paint, leg }) => !this.ghost || (body !== null && paint !== "base" && leg === null));
    for (const { body, paint, leg, kind, frame, sides, corners, triangles } of shown) {
      const geometry = kind === "surface" ? surface(corners, triangles) : SOLIDS[kind](sides);
      if (frame) geometry.applyMatrix4(matrix(frame));
      geometry.computeBoundingSphere();
      const mesh = this.mesh(geometry, paint, body === null ? null : { kind: "links", name: bodies[body].link });
      if (leg !== null) mesh.material = this.legs[leg];
      mesh.matrixAutoUpdate = false;
      this.parts.push({ body, mesh });
    }
    this.beams = beams.map(({ name, bodies: elements, along, round, paint }) => {
      const geometry = new BeamGeometry(elements.map((body) => bodies[body].length), along, round);
      const mesh = this.mesh(geometry, paint, { kind: "links", name });
      mesh.frustumCulled = false;
      return { name, geometry, elements, mesh, plain: mesh.material };
    });
    // Of length 1 until a pose stretches them; one for each fall of a rope, and a sheave at each point between.
    this.connectors = connectors.map(({ points, falls, paint, radius, apart, sheave }) => {
      const bar = () => this.mesh(new CylinderGeometry(radius, radius, 1, 16), paint);
      const bars = points.slice(1).map((_, index) => Array.from({ length: index + 2 === points.length ? falls : 1 }, bar));
      const sheaves = points.slice(1, -1).map(() => this.mesh(new SphereGeometry(sheave, 20, 12), "pin"));
      return { bars, sheaves, apart, points: points.map(({ body, at }) => ({ body, at: new Vector3(...at) })) };
    });
    this.cylinders = cylinders.map((data) => new Cylinder(data, (geometry, paint) => this.mesh(geometry, paint, { kind: "cylinders", name: data.name })));
  }

  /** Moves the figure to a pose. */
  pose(q, factor) {
    const frames = this.kinematics.pose(q, factor);
    for (const { body, mesh } of this.parts) {
      if (body !== null) mesh.matrix.copy(frames[body]);
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
      mesh.material = this.material(MARKED);
    }
  }

  /** Colours the legs: `colours`, one per support. */
  paint(colours) {
    this.legs.forEach((paint, index) => paint.color.set(colours[index]));
  }

  /** Places of the crane in a pose: origins of bodies, points of interest, and the middles of its parts. */
  outline() {
    const { frames, points } = this.kinematics;
    const origins = frames.map((frame) => new Vector3().setFromMatrixPosition(frame));
    const middles = this.parts.filter(({ body }) => body !== null).map(({ body, mesh }) => mesh.geometry.boundingSphere.center.clone().applyMatrix4(frames[body]));
    return origins.concat(points.map((_, index) => this.kinematics.point(index)), middles);
  }
}

/** What a crane occupies over its run: the corners of its parts, ends of its beams, and places in the world that it holds. */
export function extent(figure) {
  const { crane: { coordinates, run, scene }, kinematics } = figure;
  const names = coordinates.map((coordinate) => run.column(coordinate.name).values);
  const low = new Vector3(Infinity, Infinity, Infinity);
  const high = low.clone().negate();
  const places = [];
  const include = (place) => {
    places.push(place);
    low.min(place);
    high.max(place);
  };
  const boxes = figure.parts.map(({ body, mesh: { geometry } }) => {
    geometry.computeBoundingBox();
    const { min, max } = geometry.boundingBox;
    return { body, corners: [min.x, max.x].flatMap((x) => [min.y, max.y].flatMap((y) => [min.z, max.z].map((z) => new Vector3(x, y, z)))) };
  });
  for (const { corners } of boxes.filter(({ body }) => body === null)) corners.forEach(include);
  const anchors = scene.connectors.flatMap(({ points }) => points.filter(({ body }) => body === null));
  anchors.forEach(({ at }) => include(new Vector3(...at)));
  const step = Math.max(1, Math.floor(run.rows / 60));
  for (let row = 0; row < run.rows; row += step) {
    const frames = kinematics.pose(names.map((values) => values[row]));
    frames.forEach((frame, p) => [0, kinematics.bodies[p].length].forEach((x) => include(new Vector3(x, 0, 0).applyMatrix4(frame))));
    kinematics.points.forEach((_, index) => include(kinematics.point(index)));
    for (const { body, corners } of boxes) if (body !== null) corners.forEach((corner) => include(corner.clone().applyMatrix4(frames[body])));
    scene.supports.forEach(({ at }) => include(new Vector3(...at).applyMatrix4(frames[0])));
  }
  // Beams are thicker than their axes.
  const margin = MARGIN * low.distanceTo(high);
  low.addScalar(-margin);
  high.addScalar(margin);
  return { low, high, places, size: Math.max(low.distanceTo(high), 1e-3), centre: low.clone().add(high).divideScalar(2) };
}
