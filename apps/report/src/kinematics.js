// Poses of a crane from its coordinates, by the product of exponentials (see `apps/page/src/scene.rs`).
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
export const matrix = (rows) => new Matrix4().set(...rows, 0, 0, 0, 1);

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
    this.motions = this.bodies.map(() => ({ truth: new Matrix4(), drawn: new Matrix4(), offset: new Vector3() }));
  }

  /**
   * Frames of all bodies at pose `q`, with the deformation of elements drawn `factor` times as large. What follows a
   * flexible link moves along with the drawn place that carries it but keeps its true direction: a hanging load still hangs.
   */
  pose(q, factor = 1) {
    const step = new Matrix4();
    this.bodies.forEach((body, p) => {
      const { truth, drawn, offset } = this.motions[p];
      const carrier = this.bodies[body.parent];
      if (carrier) {
        const before = this.motions[body.parent];
        const isInside = carrier.link === body.link;
        truth.copy(before.truth);
        drawn.copy(isInside ? before.drawn : before.truth);
        offset.copy(before.offset);
        if (carrier.flexible && !isInside) {
          const place = (motion) => new Vector3(body.along, 0, 0).applyMatrix4(carrier.reference).applyMatrix4(motion);
          offset.add(place(before.drawn)).sub(place(before.truth));
        }
      } else {
        for (const motion of [truth, drawn]) motion.identity();
        offset.set(0, 0, 0);
      }
      for (let j = body.moved_by[0]; j < body.moved_by[1]; j += 1) {
        if (this.vectors[j]) {
          truth.multiply(exponential(combined(this.screws, q, j, 1), 1, step));
          drawn.multiply(exponential(combined(this.screws, q, j, factor), 1, step));
          j += 2;
          continue;
        }
        const way = q[j] - this.reference[j];
        truth.multiply(exponential(this.screws[j], way, step));
        const larger = this.coordinates[j].role === "element" ? factor * q[j] - this.reference[j] : way;
        drawn.multiply(exponential(this.screws[j], larger, step));
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
