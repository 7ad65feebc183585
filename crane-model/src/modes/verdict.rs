//! Whether a motion grows: one rule for linear models, servos and control loops.

use nalgebra::Complex;

/// Growth of a disturbance, 1/s, up to which it counts as none: it is rounding, or takes longer than any manoeuvre.
pub const GROWTH: f64 = 1e-4;

/// Whether a motion with this eigenvalue, 1/s, grows.
pub fn grows(eigenvalue: Complex<f64>) -> bool {
    eigenvalue.re > GROWTH
}

/// Damping ratio `ζ = −Re λ/|λ|`: 1 for a motion that returns without oscillating, negative for one that grows; 0 for λ = 0.
pub fn damping_ratio(eigenvalue: Complex<f64>) -> f64 {
    let size = eigenvalue.norm();
    if size > 0.0 { -eigenvalue.re / size } else { 0.0 }
}
