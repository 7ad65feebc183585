//! Derivatives of the laws compared with finite differences.

use nalgebra::Vector3;

use super::cylinder::{Command, Pump, ValveCylinder};
use super::valve;
use crate::{CylinderInfo, PumpInfo, ValveInfo};

fn cylinder() -> ValveCylinder {
    let valve = ValveInfo {
        flow: 1e-3,
        pressure_drop: 1e6,
        overlap: 0.05,
        lag: 0.02,
        commanded: false,
        gain: 8.0,
        feed_forward: 0.9,
        leakage: 1e-12,
    };
    let info = CylinderInfo {
        name: "lift".into(),
        drive: 0,
        spanned: [0, 1],
        areas: [5e-3, 3e-3],
        retracted: 0.6,
        stroke: 0.4,
        max_pressure: Some(2.8e7),
        back_pressure: 3e5,
        bulk_modulus: Some(1.2e9),
        hose_volumes: [5e-4, 4e-4],
        valve: Some(valve),
    };
    ValveCylinder { index: 0, coordinate: 0, valve, bulk_modulus: 1.2e9, max_pressure: 2.8e7, info }
}

/// Relative difference between a derivative and the central difference of its function.
fn off(of: impl Fn(f64) -> f64, at: f64, h: f64, derivative: f64) -> f64 {
    let difference = (of(at + h) - of(at - h)) / (2.0 * h);
    (difference - derivative).abs() / difference.abs().max(derivative.abs()).max(f64::MIN_POSITIVE)
}

/// Central differences of the square root with steps of 1e-3 of its argument have a relative error of about 1e-6.
const CLOSE: f64 = 1e-5;

#[test]
fn flows_have_their_derivatives() {
    let ValveCylinder { valve, .. } = cylinder();
    for u in [0.4, -0.7] {
        let sides = [9e6, 4e6];
        let (pump, tank) = (2e7, 3e5);
        let at = valve::flows(&valve, u, sides, pump, tank);
        for side in 0..2 {
            let into = |u: f64, sides: [f64; 2], pump: f64| valve::flows(&valve, u, sides, pump, tank).into[side];
            let own = |p: f64| {
                let mut sides = sides;
                sides[side] = p;
                into(u, sides, pump)
            };
            assert!(off(own, sides[side], 1e3, at.by_own[side]) < CLOSE);
            assert!(off(|u| into(u, sides, pump), u, 1e-6, at.by_spool[side]) < CLOSE);
            let by_pump = off(|pump| into(u, sides, pump), pump, 1e3, at.by_pump[side]);
            assert!(by_pump < CLOSE, "{by_pump}");
        }
        // Inflow comes from the pump, outflow goes to the tank.
        let [fed, drained] = if u > 0.0 { [0, 1] } else { [1, 0] };
        assert!(at.into[fed] > 0.0 && at.into[drained] < 0.0);
    }
    // Fully open at the nominal pressure drop: the nominal flow, to rounding.
    let nominal = valve::flows(&valve, 1.0, [1e7, 4e6], 1.1e7, 3e5).into[0];
    assert!((nominal / valve.flow - 1.0).abs() < 1e-15);
    // Nothing flows back to the pump, and nothing flows through a covered edge.
    assert_eq!(valve::flows(&valve, 1.0, [2.5e7, 4e6], 2e7, 3e5).into[0], 0.0);
    assert_eq!(valve::flows(&valve, 0.04, [9e6, 4e6], 2e7, 3e5), valve::Flows::default());
}

#[test]
fn servo_and_stop_have_their_derivatives() {
    let cylinder = cylinder();
    let (here, wanted, sides, pump) = (Vector3::new(0.8, 0.02, 0.3), Vector3::new(0.81, 0.05, 0.3), [9e6, 4e6], 2e7);
    for wanted in [wanted, Vector3::new(0.79, -0.05, 0.3)] {
        let Command { by_length, by_wanted, by_sides, by_pump, .. } = cylinder.command(here, wanted, sides, pump);
        let opening = |l: f64, sides, pump| cylinder.command(Vector3::new(l, 0.02, 0.3), wanted, sides, pump).opening;
        assert!(off(|l| opening(l, sides, pump), 0.8, 1e-6, by_length) < CLOSE);
        assert!(off(|pump| opening(0.8, sides, pump), pump, 1e3, by_pump) < CLOSE);
        let of_wanted = |l: f64, v: f64| cylinder.command(here, Vector3::new(l, v, 0.3), sides, pump).opening;
        assert!(off(|l| of_wanted(l, wanted.y), wanted.x, 1e-6, by_wanted[0]) < CLOSE);
        assert!(off(|v| of_wanted(wanted.x, v), wanted.y, 1e-6, by_wanted[1]) < CLOSE);
        let fed = usize::from(wanted.y <= 0.0);
        let own = |p: f64| {
            let mut sides = sides;
            sides[fed] = p;
            opening(0.8, sides, pump)
        };
        assert!(off(own, sides[fed], 1e3, by_sides[fed]) < CLOSE);
    }
    for (length, speed) in [(1.0004, 0.1), (0.5996, -0.1), (1.0004, -0.1)] {
        let force = |l: f64, v: f64| cylinder.force(Vector3::new(l, v, 0.3), sides);
        let at = force(length, speed);
        assert!(off(|l| force(l, speed).force, length, 1e-7, at.by_length) < CLOSE);
        assert!(off(|v| force(length, v).force, speed, 1e-4, at.by_speed) < CLOSE);
    }
}

#[test]
fn relief_and_suction_open_at_their_pressures() {
    let cylinder = cylinder();
    assert_eq!(cylinder.relief_and_suction(1e7), (0.0, 0.0));
    // The nominal flow of the valve, 5 % above the maximum pressure and 1 bar below the tank's.
    let (out, _) = cylinder.relief_and_suction(1.05 * 2.8e7);
    let (into, _) = cylinder.relief_and_suction(2e5);
    assert!((out + 1e-3).abs() < 1e-12 && (into - 1e-3).abs() < 1e-12);
    let pump = Pump {
        info: PumpInfo { max_flow: 2e-3, pressure: Some(2e7), volume: 5e-3 },
        pressure: 2e7,
        bulk_modulus: 1.2e9,
    };
    assert_eq!(pump.flow(2e7).0, 0.0);
    assert_eq!(pump.flow(1.8e7), (2e-3, 0.0));
    let (_, slope) = pump.flow(1.95e7);
    assert!(off(|p| pump.flow(p).0, 1.95e7, 1e3, slope) < CLOSE);
}
