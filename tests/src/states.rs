//! Random states with fixed seeds.

use crane_codegen::chain::{Chain, CoordinateId, CoordinateKind};
use fastrand::Rng;

use crate::quantities::State;

/// States far from any pose: rotations over the full circle, deformations up to half a radian.
#[must_use]
pub fn far(chain: &Chain, count: usize, seed: u64) -> Vec<State> {
    let mut rng = Rng::with_seed(seed);
    (0..count)
        .map(|_| {
            let mut symmetric = |scale: f64| scale * (2.0 * rng.f64() - 1.0);
            let q = chain
                .coordinates
                .iter()
                .enumerate()
                .map(|(i, coordinate)| {
                    let soft = chain.is_of_element(CoordinateId(i)) || chain.base.iter().flatten().any(|b| b.0 == i);
                    match coordinate.kind {
                        CoordinateKind::Rotation if soft => symmetric(0.5),
                        CoordinateKind::Rotation => symmetric(std::f64::consts::PI),
                        CoordinateKind::Translation => symmetric(1.0),
                    }
                })
                .collect();
            let v = chain.coordinates.iter().map(|_| symmetric(1.5)).collect();
            State { t: symmetric(1.5) + 1.5, q, v }
        })
        .collect()
}
