// A beam along a curve, with a box or a round outline: a flexible link, bent like its elements.
import { BufferAttribute, BufferGeometry, Vector3 } from "three";

/** Stations of the drawn curve in each half of an element. */
const STATIONS = 4;
/** Faces of a box by direction of its normal, (y, z), with the two corners of each. */
const BOX = [
  { normal: [1, 0], corners: [[1, -1], [1, 1]] },
  { normal: [0, 1], corners: [[1, 1], [-1, 1]] },
  { normal: [-1, 0], corners: [[-1, 1], [-1, -1]] },
  { normal: [0, -1], corners: [[-1, -1], [1, -1]] },
];
/** Faces of a round outline, likewise. */
const ROUND = Array.from({ length: 24 }, (_, face) => {
  const towards = (turn) => [Math.cos((turn * Math.PI) / 12), Math.sin((turn * Math.PI) / 12)];
  return { normal: towards(face), corners: [towards(face - 0.5), towards(face + 0.5)] };
});

/** Height and width at a position, from `[x, height, width]` along the beam: linear in between; at a step, those that begin there. */
export function sizeAt(along, x) {
  const next = along.findIndex(([place]) => place > x);
  if (next < 1) return along.at(next).slice(1);
  const [a, b] = [along[next - 1], along[next]];
  const share = (x - a[0]) / (b[0] - a[0]);
  return [1, 2].map((side) => a[side] + share * (b[side] - a[side]));
}

/** Positions of the rings along a beam, m: evenly from middle to middle of the elements, and to both ends. */
function places(lengths) {
  const total = lengths.reduce((sum, length) => sum + length, 0);
  let end = 0;
  const middles = lengths.map((length) => (end += length) - length / 2);
  const evenly = (a, b, count) => Array.from({ length: count }, (_, s) => a + ((b - a) * s) / count);
  const between = middles.slice(1).flatMap((middle, k) => evenly(middles[k], middle, 2 * STATIONS));
  return [...evenly(0, middles[0], STATIONS), ...between, ...evenly(middles.at(-1), total, STATIONS), total];
}

/** Geometry of a beam over elements of these lengths, with its height and width along it. */
export class BeamGeometry extends BufferGeometry {
  constructor(lengths, along, round = false) {
    super();
    this.lengths = lengths;
    this.along = along;
    this.faces = round ? ROUND : BOX;
    this.places = places(lengths);
    const vertices = 2 * this.faces.length;
    const rings = this.places.length;
    this.setAttribute("position", new BufferAttribute(new Float32Array(rings * 3 * vertices), 3));
    this.setAttribute("normal", new BufferAttribute(new Float32Array(rings * 3 * vertices), 3));
    const index = [];
    for (let ring = 0; ring + 1 < rings; ring += 1) {
      for (let face = 0; face < this.faces.length; face += 1) {
        const a = ring * vertices + face * 2;
        const b = a + vertices;
        index.push(a, a + 1, b, a + 1, b + 1, b);
      }
    }
    this.setIndex(index);
  }

  /** Colours it along its length: `colour(x)` as `[r, g, b]` from 0 to 1. */
  paint(colour) {
    const vertices = 2 * this.faces.length;
    if (!this.attributes.color) this.setAttribute("color", new BufferAttribute(new Float32Array(this.attributes.position.count * 3), 3));
    const colours = this.attributes.color;
    for (const [ring, x] of this.places.entries()) {
      const [r, g, b] = colour(x);
      for (let vertex = 0; vertex < vertices; vertex += 1) colours.setXYZ(ring * vertices + vertex, r, g, b);
    }
    colours.needsUpdate = true;
  }

  /** Follows the frames of the elements: x along the element, y the height, z the width. */
  follow(frames) {
    const position = this.attributes.position;
    const normal = this.attributes.normal;
    let vertex = 0;
    let rings = 0;
    const ring = (p, y, z) => {
      const [height, width] = sizeAt(this.along, this.places[rings]);
      rings += 1;
      for (const { normal: [ny, nz], corners } of this.faces) {
        for (const [cy, cz] of corners) {
          const [h, w] = [(cy * height) / 2, (cz * width) / 2];
          position.setXYZ(vertex, p.x + y.x * h + z.x * w, p.y + y.y * h + z.y * w, p.z + y.z * h + z.z * w);
          normal.setXYZ(vertex, y.x * ny + z.x * nz, y.y * ny + z.y * nz, y.z * ny + z.z * nz);
          vertex += 1;
        }
      }
    };
    const middles = frames.map((frame, k) => {
      const x = new Vector3();
      const y = new Vector3();
      const z = new Vector3();
      frame.extractBasis(x, y, z);
      return { p: new Vector3(this.lengths[k] / 2, 0, 0).applyMatrix4(frame), x, y, z };
    });
    const first = middles[0];
    const last = middles.at(-1);
    // Straight to the middle of the first element, Hermite's curve from middle to middle, straight to the tip.
    for (let s = 0; s < STATIONS; s += 1) {
      const back = (this.lengths[0] / 2) * (1 - s / STATIONS);
      ring(first.p.clone().addScaledVector(first.x, -back), first.y, first.z);
    }
    for (let k = 0; k + 1 < middles.length; k += 1) {
      const [a, b] = [middles[k], middles[k + 1]];
      const span = (this.lengths[k] + this.lengths[k + 1]) / 2;
      for (let s = 0; s < 2 * STATIONS; s += 1) {
        const u = s / (2 * STATIONS);
        const p = a.p.clone().multiplyScalar((1 + 2 * u) * (1 - u) ** 2).addScaledVector(b.p, u * u * (3 - 2 * u));
        p.addScaledVector(a.x, span * u * (1 - u) ** 2).addScaledVector(b.x, span * u * u * (u - 1));
        ring(p, a.y.clone().lerp(b.y, u).normalize(), a.z.clone().lerp(b.z, u).normalize());
      }
    }
    for (let s = 0; s <= STATIONS; s += 1) {
      const on = (this.lengths.at(-1) / 2) * (s / STATIONS);
      ring(last.p.clone().addScaledVector(last.x, on), last.y, last.z);
    }
    position.needsUpdate = true;
    normal.needsUpdate = true;
    this.computeBoundingSphere();
  }
}
