//! Flow through the edges of a valve.

use crate::ValveInfo;

/// Pressure difference below which the flow through an edge is laminar, Pa.
const LAMINAR: f64 = 1e5;

/// Pressure below the tank's at which a suction valve passes the nominal flow, Pa.
pub(super) const SUCTION: f64 = 1e5;

/// A number and its derivative.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct WithSlope {
    pub value: f64,
    pub slope: f64,
}

/// `r(Δ) = Δ/(Δ² + ε²)^¼`: the square root of a pressure difference, with its sign, and laminar in the middle. √Pa.
pub(super) fn root(difference: f64) -> WithSlope {
    let (square, epsilon) = (difference * difference, LAMINAR * LAMINAR);
    let sum = square + epsilon;
    let fourth = sum.sqrt().sqrt();
    WithSlope { value: difference / fourth, slope: (0.5 * square + epsilon) / (sum * fourth) }
}

/// As [`root`], behind a check valve: nothing flows backwards.
fn checked(difference: f64) -> WithSlope {
    if difference > 0.0 { root(difference) } else { WithSlope::default() }
}

/// Flows into the two sides of a cylinder, m³/s, and their derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Flows {
    /// Into the side of the piston, and of the rod.
    pub into: [f64; 2],
    /// Their derivatives with respect to the pressure on the same side, the pump's pressure, and the spool position.
    pub by_own: [f64; 2],
    pub by_pump: [f64; 2],
    pub by_spool: [f64; 2],
}

/// Flows at pressures on the sides of piston and rod, of the pump and of the tank, Pa, with the spool at u from −1 to 1: u > 0 connects
/// the piston's side to the pump and the rod's to the tank, u < 0 the other way round.
pub(super) fn flows(valve: &ValveInfo, u: f64, sides: [f64; 2], pump: f64, tank: f64) -> Flows {
    // Exactly the nominal flow at the nominal pressure drop.
    let gain = valve.flow / root(valve.pressure_drop).value;
    let way = (u.abs() - valve.overlap) / (1.0 - valve.overlap);
    if way <= 0.0 {
        return Flows::default();
    }
    let by_spool = gain * u.signum() / (1.0 - valve.overlap);
    let open = gain * way;
    let mut flows = Flows::default();
    let (fed, drained) = if u > 0.0 { (0, 1) } else { (1, 0) };
    let inflow = checked(pump - sides[fed]);
    flows.into[fed] = open * inflow.value;
    flows.by_own[fed] = -open * inflow.slope;
    flows.by_pump[fed] = open * inflow.slope;
    flows.by_spool[fed] = by_spool * inflow.value;
    let outflow = root(sides[drained] - tank);
    flows.into[drained] = -open * outflow.value;
    flows.by_own[drained] = -open * outflow.slope;
    flows.by_spool[drained] = -by_spool * outflow.value;
    flows
}

/// The steepest slope of the flow into a side, m³/(s Pa): its suction valve open, and nearly equal pressures on both sides of an edge of
/// the open valve.
pub(crate) fn steepest_flow(valve: &ValveInfo) -> f64 {
    valve.flow * (1.0 / SUCTION + root(0.0).slope / root(valve.pressure_drop).value)
}
