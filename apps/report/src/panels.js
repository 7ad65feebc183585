// Which plots there are, and what they show.
import { Matrix4, Vector3 } from "three";
import { range, scaled, spoken } from "./data.js";
import { Kinematics } from "./kinematics.js";
import { Plot } from "./plot.js";
import { carried, envelope, margins, ordered, used } from "./strength.js";

/** A point hardly moves along an axis if it does so by less than this fraction of its travel along z. */
const HARDLY = 0.01;
/** Shorter travel counts as none, m. */
const STILL = 1e-6;
/** What twists and bends: about x, y and z of the section. */
const MOMENTS = [
  { id: "_phi", title: "Torsion moment" },
  { id: "_theta", title: "Bending moment about y" },
  { id: "_psi", title: "Bending moment about z" },
];

/** All plots of the page, or of a part of it with the same sections. */
export function panels(data, player, root = document) {
  const { crane, rigid } = data;
  const plots = [];
  const time = { label: "t", unit: "s", values: crane.run.t };
  const add = (section, options) => {
    const host = root.querySelector(`#${section} .panels`);
    const plot = new Plot(host, { prefix: crane.name, player, x: time, ...options });
    plots.push(plot);
    return plot;
  };
  /** Curves over time in one unit, shown in kN, kJ or mm where that reads better. */
  const overTime = (section, id, title, label, unit, curves, height) => {
    const all = curves.flatMap(({ values }) => range(values));
    const { unit: shown, factor } = scaled(unit, all);
    return add(section, { id, title, y: { label, unit: shown, factor }, curves, height });
  };
  /** The same column of the flexible and of the rigid crane. */
  const both = (name) => [crane, rigid].filter((one) => one?.run.column(name)).map((one, index) => ({
    label: rigid ? one.label : spoken(name), values: one.run.column(name).values, dashed: index === 1, colour: index,
  }));

  path(add, crane, rigid);
  deflection(overTime, crane, rigid);
  for (const j of crane.drives) {
    const { name, force_unit: unit } = crane.coordinates[j];
    const effort = unit === "N" ? "force" : "torque";
    overTime("drives", `drive_${name}`, `${spoken(name)}: ${effort} of the drive`, effort, unit, both(`${name}_drive_${effort}`));
  }
  joints(overTime, crane);
  hydraulics(overTime, crane);
  for (const axis of ["z", "x", "y"]) {
    const curves = crane.scene.supports.map(({ name }, colour) => ({
      label: name, colour, values: crane.run.column(`${name}_reaction_${axis}`).values, dashed: colour >= 4,
    }));
    if (curves.length) overTime("supports", `reaction_${axis}`, `Support reactions along ${axis}`, `F${axis}`, "N", curves, axis === "z" ? 300 : 230);
  }
  const gaps = ofKind(crane, "gap");
  if (gaps.length) overTime("supports", "gaps", "Feet above the ground", "gap", "m", gaps);
  const along = moments(add, overTime, crane);
  along.push(...strength(add, overTime, crane));
  stability(overTime, crane);
  energy(overTime, crane, both);
  explorer(root.querySelector("#explorer"), { add, crane, rigid, plots });
  return { plots, along };
}

/** Curves of all columns that show one kind of quantity, in a unit if one is given. */
function ofKind(crane, kind, unit) {
  const found = crane.run.list.filter((column) => column.kind === kind && (!unit || column.unit === unit));
  return found.map(({ part, values }, colour) => ({ label: spoken(part), colour, values, dashed: colour >= 4 }));
}

/** Friction and stops of joints. */
function joints(overTime, crane) {
  for (const [what, title] of [["friction", "Friction of the joints"], ["stop", "End stops"]]) {
    for (const [effort, unit] of [["torque", "N m"], ["force", "N"]]) {
      const curves = ofKind(crane, `${what}_effort`, unit);
      if (curves.length) overTime("drives", `${what}_${effort}`, title, effort, unit, curves);
    }
  }
}

/** Pressures, forces, flows and valves of the cylinders, and what the pump delivers. */
function hydraulics(overTime, crane) {
  const [pistons, rods] = ["piston_pressure", "rod_pressure"].map((kind) => ofKind(crane, kind));
  const [pump] = ofKind(crane, "pump_pressure");
  pistons.forEach(({ label, values }, index) => {
    const curves = [{ label: "at the piston", values }, { label: "at the rod", values: rods[index].values }];
    if (pump) curves.push({ label: "of the pump", values: pump.values, dashed: true });
    const coloured = curves.map((curve, colour) => ({ ...curve, colour }));
    overTime("hydraulics", `pressures_${index}`, `${label}: pressures`, "pressure", "Pa", coloured);
  });
  if (!pistons.length) return;
  const forces = ofKind(crane, "cylinder_force");
  if (forces.length) overTime("hydraulics", "cylinder_forces", "Forces of the cylinders, positive where they push", "force", "N", forces);
  const valves = ofKind(crane, "valve");
  if (valves.length) overTime("hydraulics", "valves", "Openings of the valves: 1 extends, −1 retracts", "opening", "1", valves);
  const flows = ofKind(crane, "flow").map((curve) => ({ ...curve, dashed: curve.label === "pump" }));
  overTime("hydraulics", "flows", "Flows of oil", "flow", "m³/s", flows);
  overTime("hydraulics", "pump_power", "Power of the pump", "power", "W", ofKind(crane, "power"));
}

/** Paths of the points of interest, in the plane in which they move most. */
function path(add, crane, rigid) {
  const way = (axis) => Math.max(0, ...crane.scene.points.map(({ name }) => {
    const [low, high] = range(crane.run.column(`${name}_${axis}`).values);
    return high - low;
  }));
  const hardly = HARDLY * way("z");
  const [x, y] = way("y") < hardly ? ["x", "z"] : way("x") < hardly ? ["y", "z"] : ["x", "y"];
  const curves = crane.scene.points.flatMap(({ name }, colour) =>
    [crane, rigid].filter(Boolean).map((one, index) => ({
      label: rigid ? `${spoken(name)}, ${one.label}` : spoken(name), colour, dashed: index === 1, t: one.run.t,
      x: one.run.column(`${name}_${x}`).values, values: one.run.column(`${name}_${y}`).values,
    })),
  );
  // A crane at rest has no path.
  if (Math.max(way("x"), way("y"), way("z")) < STILL) return;
  const view = y === "y" ? "seen from above" : "seen from the side";
  add("motion", { id: "path", kind: "path", title: `Load path, ${view}`, height: 545, curves, x: { label: x, unit: "m" }, y: { label: y, unit: "m" } });
}

/** How far flexibility moves the points, and how far flexible links are bent. */
function deflection(overTime, crane, rigid) {
  if (rigid) {
    for (const axis of ["z", "x", "y"]) {
      const curves = crane.scene.points.map(({ name }, colour) => {
        const [own, other] = [crane, rigid].map((one) => one.run.column(`${name}_${axis}`).values);
        return { label: spoken(name), colour, values: own.map((value, i) => value - other[i]) };
      });
      if (curves.length) overTime("motion", `deflection_${axis}`, `Deflection along ${axis}: flexible − rigid`, `Δ${axis}`, "m", curves);
    }
  }
  const kinematics = new Kinematics(crane);
  const found = crane.scene.beams;
  if (!found.length) return;
  const q = crane.coordinates.map(({ name }) => crane.run.column(name).values);
  const tips = found.map(() => ["y", "z"].map(() => new Float32Array(crane.run.rows)));
  for (let row = 0; row < crane.run.rows; row += 1) {
    const frames = kinematics.pose(q.map((values) => values[row]));
    found.forEach(({ bodies }, index) => {
      const [root, end] = [bodies[0], bodies.at(-1)];
      const tip = new Vector3(kinematics.bodies[end].length, 0, 0).applyMatrix4(frames[end]);
      tip.applyMatrix4(new Matrix4().copy(frames[root]).invert());
      tips[index][0][row] = tip.y;
      tips[index][1][row] = tip.z;
    });
  }
  found.forEach(({ name }, index) => {
    const curves = tips[index].map((values, colour) => ({ label: `along its ${"yz"[colour]}`, colour, values }));
    overTime("boom", `bent_${name}`, `${spoken(name)}: deflection of the tip from the straight line`, "deflection", "m", curves);
  });
}

/** Moments along beams now, with maximum and minimum of the run, at all their places; and over time at the beginning. */
function moments(add, overTime, crane) {
  const along = [];
  for (const { name, sections } of carried(crane)) {
    MOMENTS.forEach(({ id, title }, axis) => {
      const ranges = sections.map((section) => section.ranges[axis]);
      // What is 0 everywhere, as in a planar crane, has no curve.
      if (sections.length < 2 || ranges.every(([low, high]) => low === 0 && high === 0)) return;
      const { unit, factor } = scaled("N m", ranges.flat());
      const joints = sections.map((section) => ({ ...section, values: section.moments[axis], range: ranges[sections.indexOf(section)] }));
      const curves = [
        { label: "now", of: ({ values }) => values[0] }, { label: "maximum", of: ({ range: r }) => r[1] },
        { label: "minimum", of: ({ range: r }) => r[0] },
      ];
      along.push(alongBeam(add, "boom", joints, {
        id: `moment_${name}${id}`, title: `${spoken(name)}: ${title.toLowerCase()}`, y: { label: "moment", unit, factor },
      }, curves));
    });
    const root = MOMENTS.map(({ title }, axis) => ({ label: title.toLowerCase(), colour: axis, values: sections[0].moments[axis] }));
    const moving = root.filter(({ values }) => values.some((value) => value !== 0));
    if (moving.length) overTime("boom", `root_${name}`, `${spoken(name)}: moments at its beginning`, "moment", "N m", moving);
  }
  return along;
}

/** A plot of curves along a beam, through its places in their order now. */
function alongBeam(add, host, joints, options, curves) {
  const start = ordered(joints, { low: 0, high: 0, part: 0 });
  const plot = add(host, {
    kind: "along", x: { label: "along the beam", unit: "m", values: start.x }, ...options,
    curves: curves.map(({ label, of }, colour) => ({ label, colour, dashed: colour > 0, values: start.order.map((index) => of(joints[index])) })),
  });
  return { plot, joints, curves };
}

/** Utilisation of the sections of beams: along each beam, now and maximum, and over time. */
function strength(add, overTime, crane) {
  const { beams, unit } = used(crane);
  const label = unit === "1" ? "utilisation" : "equivalent stress";
  const along = beams.map(({ name, sections }) => alongBeam(add, "strength", sections, {
    id: `use_${name}`, title: `${spoken(name)}: ${label} along the beam`, y: { label, unit },
  }, [{ label: "now", of: ({ values }) => values[0] }, { label: "maximum of the run", of: ({ most }) => most }]));
  const curves = beams.map(({ name, sections }, colour) => ({
    label: spoken(name), colour, values: envelope(sections.map(({ values }) => values)),
  }));
  if (curves.length) overTime("strength", "use", `Maximum ${label} of each beam`, label, unit, curves);
  return along;
}

/** Margins against tipping over. */
function stability(overTime, crane) {
  const curves = margins(crane).map(({ name, values }, colour) => ({ label: name, colour, values, dashed: colour >= 4 }));
  if (curves.length) overTime("stability", "margins", "Tipping margin about each line: 1 − overturning / stabilising moment", "margin", "1", curves, 300);
}

function energy(overTime, crane, both) {
  const change = (values) => values.map((value) => value - values[0]);
  const curves = crane.run.list.filter(({ kind }) => ["energy", "work", "dissipated"].includes(kind))
    .map(({ name, values }, colour) => ({ label: spoken(name), colour, values: change(values) }))
    .filter(({ values }) => values.some((value) => value !== 0));
  overTime("energy", "energies", "Energies, change since the start", "energy", "J", curves, 300);
  overTime("energy", "balance", "Error of the energy balance", "E − E₀ − W + D", "J", both("energy_balance"), 300);
}

/** Any column of the run. */
function explorer(host, { add, crane, rigid, plots }) {
  const choice = host.querySelector("select");
  for (const { name, unit } of crane.run.list.slice(1)) choice.append(new Option(`${spoken(name)} [${unit}]`, name));
  const passive = crane.coordinates.find(({ role }) => role === "passive") ?? crane.coordinates[0];
  choice.value = passive?.name ?? crane.run.list[1].name;
  let plot = null;
  const show = () => {
    if (plot) {
      plots.splice(plots.indexOf(plot), 1);
      plot.frame.remove();
    }
    const { name, unit } = crane.run.column(choice.value);
    const curves = [crane, rigid].filter((one) => one?.run.column(name)).map((one, index) => ({
      label: rigid ? one.label : spoken(name), colour: index, dashed: index === 1, values: one.run.column(name).values,
    }));
    const { unit: shown, factor } = scaled(unit, curves.flatMap(({ values }) => range(values)));
    plot = add("explorer", { id: "column", title: spoken(name), y: { label: spoken(name), unit: shown || "1", factor }, curves, height: 280 });
  };
  choice.addEventListener("change", show);
  show();
}

/** Shows what acts along beams at a time of the run. */
export function follow(along, time) {
  const { low, high, part } = time;
  for (const { plot, joints, curves } of along) {
    const { order, x } = ordered(joints, time);
    plot.x.values = x;
    plot.update(curves.map(({ of }, index) => order.map((place) => {
      const { values } = joints[place];
      return index === 0 ? values[low] + (values[high] - values[low]) * part : of(joints[place]);
    })));
  }
}
