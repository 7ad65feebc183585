//! Oil: stiff and soft, tiny volumes, valves shut, wide open and slow, pumps far too weak, loads far too heavy.

use std::f64::consts::PI;

use super::{
    GRAVITY,
    case::{Case, expect},
    spec::Spec,
    subject::{Subject, balanced, cautions, imbalance, timing},
};
use crane_model::{dynamics::Method, runs::Recorded};

const GROUP: &str = "oil";
/// Cylinder: diameters of piston and rod, length at coordinate 0, retracted length, stroke, m.
const BORE: f64 = 0.08;
const ROD: f64 = 0.045;
const LENGTH: f64 = 1.1;
const RETRACTED: f64 = 0.8;
const STROKE: f64 = 0.6;
/// Pressures of tank, relief valves and pump, Pa.
const TANK: f64 = 3e5;
const LARGEST: f64 = 2.5e7;
const PUMP: f64 = 2e7;
const METHODS: [Method; 2] = [Method::Bdf, Method::Rosenbrock];

pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for method in METHODS {
        for bulk_modulus in [1e8, 1e10, 1e12] {
            cases.push(shut(
                Lift { bulk_modulus, ..Lift::default() },
                &format!("oil of {bulk_modulus:e} Pa, {method}"),
                method,
            ));
        }
        for hoses in [1e-5, 1e-7] {
            cases.push(shut(
                Lift { hoses, ..Lift::default() },
                &format!("{hoses:e} m³ in each hose, {method}"),
                method,
            ));
        }
        for share in [1.2, 10.0] {
            cases.push(too_heavy(share, method));
        }
        for max_flow in [1e-6, 1e-9] {
            cases.push(too_weak(
                Lift { max_flow, ..Lift::default() },
                &format!("pump of {max_flow:e} m³/s, {method}"),
                method,
            ));
        }
        cases.push(too_weak(Lift { pump: 1e6, ..Lift::default() }, &format!("pump of 1e6 Pa, {method}"), method));
        for lag in [1e-6, 1e-4, 1.0] {
            cases.push(lifted(
                Lift { lag, ..Lift::default() },
                &format!("spool that lags by {lag:e} s, {method}"),
                method,
            ));
        }
        cases.push(at_the_end(method));
        cases.push(sucked(method));
    }
    cases
}

/// A mass on a vertical cylinder.
#[derive(Clone, Copy)]
struct Lift {
    mass: f64,
    bulk_modulus: f64,
    hoses: f64,
    lag: f64,
    pump: f64,
    max_flow: f64,
    gravity: f64,
    opening: &'static str,
}

impl Default for Lift {
    fn default() -> Self {
        Self {
            mass: 2000.0,
            bulk_modulus: 1.3e9,
            hoses: 5e-4,
            lag: 0.03,
            pump: PUMP,
            max_flow: 1e-3,
            gravity: -GRAVITY,
            opening: "{hold: 0}",
        }
    }
}

impl Lift {
    fn spec(&self) -> Spec {
        let Self { mass, bulk_modulus, hoses, lag, pump, max_flow, gravity, opening } = self;
        Spec::new(format!(
            "format: 1
name: lift
gravity: [0, 0, {gravity}]
links:
  - {{name: post, joint: {{prismatic: {{axis: x}}}}, mass: 50, com: [0, 0, 0]}}
  - {{name: slide, joint: {{prismatic: {{axis: z}}}}, mass: {mass}, com: [0, 0, 0]}}
drives:
  - {{coordinate: post_x, rigid: true, motion: {{hold: 0}}}}
  - {{coordinate: slide_z, stiffness: 1e9, motion: {{hold: 0}}}}
cylinders:
  - name: ram
    coordinate: slide_z
    foot: {{link: post, at: [0, 0, -{LENGTH}]}}
    head: {{link: slide, at: [0, 0, 0]}}
    bore: {BORE}
    rod: {ROD}
    retracted: {RETRACTED}
    stroke: {STROKE}
    back_pressure: {TANK}
    max_pressure: {LARGEST}
    bulk_modulus: {bulk_modulus:e}
    hose_volumes: [{hoses:e}, {hoses:e}]
    valve: {{flow: 6e-4, pressure_drop: 1e6, lag: {lag:e}, opening: {opening}}}
pump: {{max_flow: {max_flow:e}, pressure: {pump:e}}}
"
        ))
    }

    /// A run, the slide's positions at its start and end, and its speed at the end.
    fn run(&self, method: Method, duration: f64) -> Result<(Recorded, [f64; 2], f64), String> {
        let recorded = Subject::new(&self.spec())?.run(&timing(method, 1e-6, duration))?;
        let places: Vec<f64> = column(&recorded, "slide_z");
        let rate = column(&recorded, "slide_z_rate").last().copied().unwrap_or(f64::NAN);
        let ends = [places.first(), places.last()].map(|position| position.copied().unwrap_or(f64::NAN));
        Ok((recorded, ends, rate))
    }
}

fn column(recorded: &Recorded, name: &str) -> Vec<f64> {
    recorded.table.values(name).map(Iterator::collect).unwrap_or_default()
}

fn piston() -> f64 {
    PI / 4.0 * BORE * BORE
}

/// The valve stays shut, so no oil flows.
fn shut(lift: Lift, name: &str, method: Method) -> Case {
    Case::new(GROUP, format!("shut valve, {name}"), "holds to 1e-6 m for 2 s", move || {
        let (_, [begin, end], _) = lift.run(method, 2.0)?;
        expect((end - begin).abs() < 1e-6, format!("moves by {:.1e} m", (end - begin).abs()))
    })
}

/// The weight opens the relief valve, and the cylinder sinks onto its end.
fn too_heavy(share: f64, method: Method) -> Case {
    let mass = share * LARGEST * piston() / GRAVITY;
    let name = format!("{share} times the load of the relief valve, {method}");
    Case::new(GROUP, name, "sinks onto its end, rests at most 11 mm beyond", move || {
        let (recorded, [_, end], rate) = Lift { mass, ..Lift::default() }.run(method, 5.0)?;
        let lowest = RETRACTED - LENGTH;
        let sits = end < lowest && end > lowest - 0.011 && rate.abs() < 1e-3;
        expect(sits, format!("z = {end:.5} m, {rate:.1e} m/s, energy off by {:.1e}", imbalance(&recorded)))
    })
}

/// The valve opens, and only the expansion of the oil between pump and valve moves the load; check valves hold it.
fn too_weak(lift: Lift, name: &str, method: Method) -> Case {
    let lift = Lift { opening: "{table: {times: [0.1, 0.2], values: [0, 1]}}", ..lift };
    // 5 l, unless the spec says otherwise.
    let most = 5e-3 * lift.pump / lift.bulk_modulus / piston();
    Case::new(
        GROUP,
        format!("open valve, {name}"),
        format!("moves by less than {:.1} mm, energy balanced to 0.1 %", 1e3 * most),
        move || {
            let (recorded, [begin, end], _) = lift.run(method, 2.0)?;
            let (moved, off) = (end - begin, imbalance(&recorded));
            let findings = format!("moves by {moved:.1e} m, energy off by {off:.1e}{}", cautions(&recorded));
            expect((-1e-6..most).contains(&moved) && off < 1e-3, findings)
        },
    )
}

/// The valve opens and shuts again.
fn lifted(lift: Lift, name: &str, method: Method) -> Case {
    let lift =
        Lift { opening: "{table: {times: [0.1, 0.2, 0.6, 0.7], values: [0, 0.3, 0.3, 0], shape: spline}}", ..lift };
    Case::new(GROUP, name, "lifts by 10 to 200 mm, energy balanced to 0.1 %", move || {
        let (recorded, [begin, end], _) = lift.run(method, 2.0)?;
        let found = balanced(&recorded, 1e-3)?;
        expect((0.01..0.2).contains(&(end - begin)), format!("lifts by {:.4} m; {found}", end - begin))
    })
}

/// The piston reaches the end of its stroke with the valve wide open.
fn at_the_end(method: Method) -> Case {
    let name = format!("open valve against the end of the stroke, {method}");
    Case::new(GROUP, name, "stays within 3 mm of its end, pressure of the pump", move || {
        let lift = Lift { opening: "{table: {times: [0.1, 0.2], values: [0, 1]}}", ..Lift::default() };
        let (recorded, [_, end], rate) = lift.run(method, 4.0)?;
        let pressure = column(&recorded, "ram_piston_pressure").last().copied().unwrap_or(f64::NAN);
        let beyond = end - (RETRACTED + STROKE - LENGTH);
        let sits = (0.0..3e-3).contains(&beyond) && rate.abs() < 1e-3 && (pressure / PUMP - 1.0).abs() < 1e-3;
        expect(sits, format!("{beyond:.5} m beyond its end, {pressure:.3e} Pa"))
    })
}

/// The load pulls the piston out faster than the pump feeds it: suction valves let oil in from the tank.
fn sucked(method: Method) -> Case {
    let name = format!("a load that pulls and no oil behind it, {method}");
    Case::new(GROUP, name, "no pressure below a vacuum, -1e5 Pa", move || {
        let opening = "{table: {times: [0.1, 0.2], values: [0, 1]}}";
        let lift = Lift { gravity: GRAVITY, max_flow: 1e-9, opening, ..Lift::default() };
        let (recorded, [begin, end], _) = lift.run(method, 1.0)?;
        let least = column(&recorded, "ram_piston_pressure").into_iter().fold(f64::INFINITY, f64::min);
        let holds = least > -1e5 && end - begin > 0.01;
        expect(holds, format!("minimum {least:.3e} Pa, pulled out by {:.4} m", end - begin))
    })
}
