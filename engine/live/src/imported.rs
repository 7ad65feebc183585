//! What the spec of an imported robot computes, against the robot's file link by link.

use std::fmt;

use crane_codegen::SourceFile;
use crane_codegen::exchange::{Imported, Reference, ReferenceDynamics};
use crane_model::dyn_crane::Functions;

use crate::LiveCrane;

/// A difference that is more than the rounding of numbers that were written as text, relative to the terms that are added up.
const TOLERANCE: f64 = 1e-9;
/// Poses that are compared.
const POSES: usize = 3;

/// A number of a spec that is not that of the robot's file.
#[derive(Clone, Debug, PartialEq)]
pub struct Deviation {
    /// The number, in words.
    pub what: String,
    /// By the spec.
    pub by_spec: f64,
    /// By the robot's file.
    pub by_file: f64,
}

impl fmt::Display for Deviation {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{} is {:.6e} by the spec and {:.6e} by the robot's file", self.what, self.by_spec, self.by_file)
    }
}

/// Compares the spec of a robot with its file: [`compare_with_file`], unless inertias were repaired. A spec with mistakes in the robot's own numbers
/// passes: they are told, and corrected, there.
///
/// # Errors
/// As of [`compare_with_file`].
pub fn check_import(imported: &Imported) -> Result<(), Deviation> {
    let Some(reference) = &imported.reference else { return Ok(()) };
    let crane = LiveCrane::from_spec(&SourceFile::new("robot.yaml", imported.spec.as_str()));
    crane.map_or(Ok(()), |crane| compare_with_file(&crane, reference))
}

/// Compares A, e and, where springs and dampers are all that acts, f of an imported crane with the robot's file, in three poses in motion.
///
/// # Errors
/// The first number that differs by more than 1e-9 of the terms whose sum it is.
pub fn compare_with_file(crane: &LiveCrane, reference: &Reference) -> Result<(), Deviation> {
    let n = crane.size();
    let names = &reference.coordinates;
    let mut mass_matrix = vec![0.0; n * n];
    let [mut bias, mut forces] = [vec![0.0; n], vec![0.0; n]];
    for pose in 0..POSES {
        // Numbers without a pattern.
        let number = |place: usize| 2.0 * (12.9898 * (place + 1) as f64 + 78.233 * (pose + 1) as f64).sin();
        let (q, v): (Vec<f64>, Vec<f64>) = (0..n).map(|j| (number(j), number(n + j))).unzip();
        crane.mass_matrix(&q, &mut mass_matrix);
        crane.bias(&q, &v, &mut bias);
        crane.forces(0.0, &q, &v, &mut forces);
        let ReferenceDynamics { mass_matrix: by_file, bias: bias_by_file, forces: forces_by_file } =
            reference.dynamics(&q, &v);
        let diagonal = |i: usize| by_file[i * (n + 1)].max(0.0);
        let largest = (0..n).map(diagonal).fold(0.0, f64::max);
        let compare = |what: &dyn Fn() -> String, by_spec: f64, by_file: f64, size: f64| {
            // Rounding of the largest numbers reaches the smallest.
            let allowed = TOLERANCE * size + 1e3 * f64::EPSILON * largest;
            if (by_spec - by_file).abs() <= allowed {
                Ok(())
            } else {
                Err(Deviation { what: what(), by_spec, by_file })
            }
        };
        for (i, j) in (0..n).flat_map(|i| (0..=i).map(move |j| (i, j))) {
            let what = || format!("the mass matrix of `{}` and `{}`", names[i], names[j]);
            compare(&what, mass_matrix[i * n + j], by_file[i * n + j], (diagonal(i) * diagonal(j)).sqrt())?;
        }
        for (i, [by_file, size]) in bias_by_file.into_iter().enumerate() {
            compare(&|| format!("the bias of `{}`", names[i]), bias[i], by_file, size)?;
        }
        for (i, [by_file, size]) in forces_by_file.into_iter().enumerate().filter(|_| reference.forces_are_complete) {
            compare(&|| format!("the force of springs and dampers of `{}`", names[i]), forces[i], by_file, size)?;
        }
    }
    Ok(())
}
