// Poses of a crane from its coordinates, by the product of exponentials (see `tools/page/src/scene.rs`).
import { Matrix4, Vector3 } from "three";

/** exp(ξ̂ q) of a screw `[ω, v]` whose ω is a unit vector or zero. */
function exponential([wx, wy, wz, vx, vy, vz], q, out) {
  if (wx === 0 && wy === 0 && wz === 0) return out.makeTranslation(vx * q, vy * q, vz * q);
  const size = Math.hypot(wx, wy, wz);
  const w = new Vector3(wx, wy, wz).divideScalar(size);
  const v = new Vector3(vx, vy, vz).divideScalar(size);
  const angle = q * size;
  // p = (1 − cos)(w × v) + sin v + (angle − sin) w (w · v), Rodrigues' formula for the rotation.
  const p = new Vector3().crossVectors(w, v).multiplyScalar(1 - Math.cos(angle));
  p.addScaledVector(v, Math.sin(angle)).addScaledVector(w, (angle - Math.sin(angle)) * w.dot(v));
  return out.makeRotationAxis(w, angle).setPosition(p);
}

/** Sum of the screws of a rotation vector by its components: three coordinates from `first` on. */
const combined = (screws, q, first, factor) =>
  screws[first].map((_, k) => factor * [0, 1, 2].reduce((sum, i) => sum + q[first + i] * screws[first + i][k], 0));

/** Matrix of the upper three rows. */
const matrix = (rows) => new Matrix4().set(...rows, 0, 0, 0, 1);

/** A crane that can take any pose. */
export class Kinematics {
  constructor(crane) {
    const { scene, coordinates } = crane;
    this.coordinates = coordinates;
    this.bodies = scene.bodies.map((body) => ({ ...body, reference: matrix(body.frame), flexible: body.length > 0 }));
    this.screws = scene.screws;
    this.reference = scene.reference;
    this.vectors = scene.vectors;
    this.points = scene.points.map((point) => ({ ...point, at: new Vector3(...point.at) }));
    this.frames = this.bodies.map(() => new Matrix4());
  }

  /**
   * Frames of all bodies at pose `q`, with the deformation of elements drawn `factor` times as large. What follows a
   * flexible link moves along with its drawn tip but keeps its true direction: a hanging load still hangs.
   */
  pose(q, factor = 1) {
    const step = new Matrix4();
    const truth = new Matrix4();
    const drawn = new Matrix4();
    const offset = new Vector3();
    let done = 0;
    this.bodies.forEach((body, p) => {
      const before = this.bodies[p - 1];
      if (before && before.link !== body.link) {
        if (before.flexible) offset.add(tip(before, drawn)).sub(tip(before, truth));
        drawn.copy(truth);
      }
      for (; done < body.moved_by; done += 1) {
        if (this.vectors[done]) {
          truth.multiply(exponential(combined(this.screws, q, done, 1), 1, step));
          drawn.multiply(exponential(combined(this.screws, q, done, factor), 1, step));
          done += 2;
          continue;
        }
        const way = q[done] - this.reference[done];
        truth.multiply(exponential(this.screws[done], way, step));
        const larger = this.coordinates[done].role === "element" ? factor * q[done] - this.reference[done] : way;
        drawn.multiply(exponential(this.screws[done], larger, step));
      }
      const frame = this.frames[p].multiplyMatrices(drawn, body.reference);
      frame.elements[12] += offset.x;
      frame.elements[13] += offset.y;
      frame.elements[14] += offset.z;
    });
    return this.frames;
  }

  /** Position of a point of interest at the latest pose. */
  point(index, out = new Vector3()) {
    const { body, at } = this.points[index];
    return out.copy(at).applyMatrix4(this.frames[body]);
  }
}

/** End of a rigid element. */
const tip = (body, motion) => new Vector3(body.length, 0, 0).applyMatrix4(body.reference).applyMatrix4(motion);

/** Flexible links, each with the indices of its bodies. */
export function links(kinematics) {
  const found = [];
  kinematics.bodies.forEach((body, p) => {
    if (!body.flexible || body.rope) return;
    const last = found.at(-1);
    if (last && last.name === body.link) last.bodies.push(p);
    else found.push({ name: body.link, bodies: [p] });
  });
  return found;
}
