//! Times at which functions of time are not smooth: how the derivatives jump if these times depend on the directions.

use super::{Around, Numbers, rates::Rates};
use crate::{dyn_crane::DynCrane, dynamics::NotFinite};

/// How the derivatives jump at a time at which functions of time are not smooth, at a motion `[q, v, x]`: if a motion of a drive changes later in
/// the crane beside, its rates are those before for longer. `stops`: such times with their derivatives.
///
/// ```text
/// s⁺ − s⁻ = ∫ (F(t, y, p + δp) − F(t, y, p)) dt/δp,      over the times at which they change one after the other
/// ```
pub(super) fn of_functions_of_time(
    crane: &dyn DynCrane,
    numbers: &dyn Numbers,
    stops: &[&[f64]],
    (t, motion): (f64, &[f64]),
) -> Result<Vec<Vec<f64>>, NotFinite> {
    let mut own = Rates::new(crane, 0);
    let mut all = vec![vec![0.0; motion.len()]; numbers.count()];
    for (direction, jump) in all.iter_mut().enumerate() {
        let Some(Around { cranes, steps }) = numbers.around(direction) else { continue };
        let (beside, step) = if steps[1] > 0.0 { (cranes[1], steps[1]) } else { (cranes[0], -steps[0]) };
        let mut times: Vec<f64> = stops.iter().map(|slopes| step * slopes[direction]).collect();
        if times.iter().all(|time| *time == 0.0) {
            continue;
        }
        times.push(0.0);
        times.sort_by(f64::total_cmp);
        let mut other = Rates::new(beside, 0);
        for pair in times.windows(2).filter(|pair| pair[1] > pair[0]) {
            let middle = t + 0.5 * (pair[0] + pair[1]);
            let (here, there) = (own.at(middle, motion)?, other.at(middle, motion)?);
            for ((jump, here), there) in jump.iter_mut().zip(here).zip(there) {
                *jump += (there - here) * (pair[1] - pair[0]) / step;
            }
        }
    }
    Ok(all)
}
