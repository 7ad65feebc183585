// Hydraulic cylinders between their pins, with rocker and link: the geometry of `codegen/src/mechanics/cylinders.rs`.
import { BoxGeometry, CylinderGeometry, Vector3 } from "three";

/** Pins of a cylinder in a pose, in the world: foot, end of the rod, head, and the rocker's pivot if there is one. */
export function pins({ foot, head, linkage, axis }, frames) {
  const place = ({ body, at }) => new Vector3(...at).applyMatrix4(frames[body]);
  const [from, to] = [place(foot), place(head)];
  const normal = axis && new Vector3(...axis.along).transformDirection(frames[axis.body]);
  if (!linkage) return { foot: from, rod: to, head: to, pivot: null, normal };
  const pivot = place(linkage.pivot);
  const across = to.clone().sub(pivot);
  const distance = across.length();
  const along = (distance ** 2 + linkage.rocker ** 2 - linkage.link ** 2) / (2 * distance);
  // Exaggerated deformations may pull rocker and link apart.
  const height = Math.sqrt(Math.max(linkage.rocker ** 2 - along ** 2, 0)) * (linkage.left ? 1 : -1);
  const aside = new Vector3().crossVectors(normal, across).normalize();
  const rod = pivot.clone().addScaledVector(across, along / distance).addScaledVector(aside, height);
  return { foot: from, rod, head: to, pivot, normal };
}

/** The meshes of a cylinder, which follow its pins. */
export class Cylinder {
  /** `mesh(geometry, paint)` makes a mesh. */
  constructor(data, mesh) {
    const { barrel, long, rod, bar: [wide, thin], pin: [radius, length] } = data.sizes;
    Object.assign(this, { data, long, length });
    const round = (radius) => new CylinderGeometry(radius, radius, 1, 20);
    const bar = () => mesh(new BoxGeometry(wide, 1, thin), "linkage");
    this.barrel = mesh(round(barrel), "barrel");
    this.rod = mesh(round(rod), "rod");
    this.bars = data.linkage ? [bar(), bar()] : [];
    const count = data.linkage ? 4 : 2;
    this.pins = data.axis ? Array.from({ length: count }, () => mesh(round(radius), "pin")) : [];
  }

  follow(frames) {
    const { foot, rod, head, pivot, normal } = pins(this.data, frames);
    const way = rod.clone().sub(foot).normalize();
    stretch(this.rod, foot, rod);
    stretch(this.barrel, foot, foot.clone().addScaledVector(way, this.long));
    const [rocker, link] = this.bars;
    if (rocker) {
      stretch(rocker, pivot, rod);
      stretch(link, rod, head);
    }
    const places = pivot ? [foot, rod, pivot, head] : [foot, rod];
    this.pins.forEach((mesh, index) => {
      const half = normal.clone().multiplyScalar(this.length / 2);
      stretch(mesh, places[index].clone().sub(half), places[index].clone().add(half));
    });
  }
}

/** Places a mesh of length 1 along y between two points. */
export function stretch(mesh, from, to) {
  const way = to.clone().sub(from);
  mesh.position.addVectors(from, to).divideScalar(2);
  mesh.scale.set(1, Math.max(way.length(), 1e-9), 1);
  mesh.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), way.normalize());
}
