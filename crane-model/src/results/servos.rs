//! Cautions about servos whose loops with the crane are unstable.

use super::Table;
use crate::{
    ConnectorInfo, Description,
    dyn_crane::DynCrane,
    dynamics::Phases,
    modes::{UnstableServo, unstable_servos},
    statics::Problem,
};

/// Servos that are unstable about a pose at rest, with the drives as at time `t`, s.
pub(super) fn of_pose(crane: &dyn DynCrane, t: f64, q: &[f64]) -> Vec<String> {
    sentences(crane.description(), &unstable_at(crane, t, q))
}

/// Servos that are unstable where a run starts, or where it ends if it stopped there.
pub(super) fn of_run(crane: &dyn DynCrane, table: &Table) -> Vec<String> {
    let description = crane.description();
    let (Some(first), Some(last), true) = (table.rows.first(), table.rows.last(), description.has_valves()) else {
        return Vec::new();
    };
    let n = crane.size();
    let mut found: Vec<UnstableServo> = Vec::new();
    let mut phases = Phases::new(crane);
    for row in [first, last] {
        let crane = phases.at_row(row);
        let equilibrium = Problem::new(crane).at_time(row[0]).from(&row[1..=n]).solve();
        if !equilibrium.is_stable() {
            continue;
        }
        for servo in unstable_at(crane, row[0], &equilibrium.q) {
            match found.iter_mut().find(|known| known.cylinder == servo.cylinder) {
                Some(known) if servo.gain < known.gain => *known = servo,
                Some(_) => {}
                None => found.push(servo),
            }
        }
    }
    sentences(description, &found)
}

fn unstable_at(crane: &dyn DynCrane, t: f64, q: &[f64]) -> Vec<UnstableServo> {
    unstable_servos(crane, t, q).unwrap_or_default()
}

fn sentences(description: &Description, servos: &[UnstableServo]) -> Vec<String> {
    servos.iter().map(|servo| sentence(description, servo)).collect()
}

fn sentence(description: &Description, UnstableServo { cylinder, mode, gain }: &UnstableServo) -> String {
    /// Links that are named.
    const NAMED: usize = 2;
    let info = &description.cylinders[*cylinder];
    let mut links: Vec<&str> = Vec::new();
    for &coordinate in &mode.dominating {
        let moved = description.first_moved(coordinate);
        links.extend(moved.map(|body| body.link.as_str()));
    }
    let mut seen = Vec::new();
    links.retain(|link| {
        !seen.contains(link) && {
            seen.push(link);
            seen.len() <= NAMED
        }
    });
    let (set_gain, overlap) = info.valve.map_or((0.0, 0.0), |valve| (valve.gain, valve.overlap));
    let pins = description.connectors.iter().any(ConnectorInfo::is_pin);
    let rubs = pins || !description.frictions.is_empty() || !description.bristles.is_empty();
    let without = if rubs { "; this is without the friction of joints, which may hold it" } else { "" };
    let beyond = if overlap > 0.0 { " once its spool leaves the overlap" } else { "" };
    format!(
        "servo of {} is unstable{beyond} with {} at {:.3} Hz: a disturbance grows by a factor e every {:.2} s; use a `gain` below {} \
         instead of {set_gain} 1/m{without}",
        info.name,
        links.join(" and "),
        mode.frequency(),
        mode.eigenvalue.re.recip(),
        rounded_down(*gain)
    )
}

/// A positive number rounded down to two digits.
fn rounded_down(number: f64) -> f64 {
    let digit = 10f64.powf(number.log10().floor() - 1.0);
    // Text gives the nearest decimal number.
    format!("{:.2e}", (number / digit).floor() * digit).parse().unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gains_are_rounded_down() {
        assert_eq!([7.389, 0.0996, 12.34, 3.0].map(rounded_down), [7.3, 0.099, 12.0, 3.0]);
    }
}
