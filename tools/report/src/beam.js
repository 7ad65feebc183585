// A beam along a curve, boxed or round: a flexible link as bent as its elements are.
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

/** Geometry of a beam over elements of these lengths. */
export class BeamGeometry extends BufferGeometry {
  constructor(lengths, height, width, round = false) {
    super();
    this.lengths = lengths;
    this.half = [height / 2, width / 2];
    this.faces = round ? ROUND : BOX;
    const vertices = 2 * this.faces.length;
    const rings = 2 * STATIONS * lengths.length + 1;
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
    const total = this.lengths.reduce((sum, length) => sum + length, 0);
    const rings = colours.count / vertices;
    for (let ring = 0; ring < rings; ring += 1) {
      const [r, g, b] = colour((total * ring) / (rings - 1));
      for (let vertex = 0; vertex < vertices; vertex += 1) colours.setXYZ(ring * vertices + vertex, r, g, b);
    }
    colours.needsUpdate = true;
  }

  /** Follows the frames of the elements: x along the element, y the height, z the width. */
  follow(frames) {
    const position = this.attributes.position;
    const normal = this.attributes.normal;
    let vertex = 0;
    const ring = (p, y, z) => {
      for (const { normal: [ny, nz], corners } of this.faces) {
        for (const [cy, cz] of corners) {
          const [h, w] = [cy * this.half[0], cz * this.half[1]];
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
