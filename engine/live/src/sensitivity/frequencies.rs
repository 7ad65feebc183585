//! Undamped frequencies: with the shape x, `xᵀ A x = 1`, on motions that leave loops closed, and `(K + Σ λ ∂²φ/∂q² − ω² A) x + Jᵀ μ = 0`,
//!
//! ```text
//! dω² = d[xᵀ (K − ω² A) x + Σ λ_i xᵀ ∂²φ_i/∂q² x] + 2 μᵀ dJ x,     x and ω² fixed
//! ```
//!
//! along (dp, dq, dλ). Where several frequencies coincide, their changes are the eigenvalues of this form on the space of their shapes.

use std::f64::consts::TAU;

use crane_codegen::program::FunctionId;
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::modes::{Mode, undamped};
use crane_model::nalgebra::{DMatrix, SymmetricEigen};
use crane_model::{CylinderInfo, Text};

use super::outputs::{efforts, named};
use super::rest::{Rest, constants};
use super::source::Source;
use super::{Group, Output, Valued};
use crate::dual::{DIRECTIONS, Dual8};
use crate::machine::Number;

/// Frequencies coincide if their squares differ by less than this fraction of them, or of the largest one: a few times its rounding.
const SAME: f64 = 1e-6;
const SPLIT: f64 = 1e-15;
/// Part of the largest square that rounding leaves in the form of any.
const ROUNDING: f64 = 1e-13;
/// Step of the central difference of what cylinders contribute, m or rad, as for the modes themselves: a relative error of 1e-8.
const DIFFERENCE: f64 = 1e-4;
/// Largest relative difference of ω² from that of its form: rounding of the modes leaves 1e-8.
const CHECKED: f64 = 1e-5;

/// Modes at rest.
pub(super) struct Frequencies<'a> {
    rest: &'a Rest,
    /// Shapes, squares of circular frequencies, what loops transmit in them, and the coordinates that vibrate.
    modes: Vec<Vibration>,
    /// How many of them are asked for; more are needed where one of these coincides with the next.
    asked: usize,
    /// First and end of modes that coincide.
    clusters: Vec<[usize; 2]>,
}

struct Vibration {
    shape: Vec<f64>,
    omega_squared: f64,
    multipliers: Vec<f64>,
    place: String,
}

impl<'a> Frequencies<'a> {
    /// The lowest ones at the pose at rest; `None` if there are no modes.
    pub fn new(source: &mut Source<'_>, rest: &'a Rest, count: usize, notes: &mut Vec<String>) -> Option<Self> {
        let crane: &dyn DynCrane = source.crane;
        let found = undamped(&crane.small_motions_at(&rest.q)).ok()?;
        let greatest = found.iter().fold(0.0, |size: f64, mode| size.max(mode.omega_squared));
        let coincide = |a: &Mode, b: &Mode| {
            (b.omega_squared - a.omega_squared).abs() <= SAME * b.omega_squared.abs() + SPLIT * greatest
        };
        let asked = count.min(found.len());
        let mut clusters: Vec<[usize; 2]> = Vec::new();
        for index in 0..found.len() {
            match clusters.last_mut() {
                Some([_, end]) if *end == index && coincide(&found[index - 1], &found[index]) => *end += 1,
                _ if index >= asked => break,
                _ => clusters.push([index, index + 1]),
            }
        }
        let end = clusters.last().map_or(0, |[_, end]| *end);
        let names: Vec<Text> = crane.description().coordinates.iter().map(|info| info.name.clone()).collect();
        let place = |mode: &Mode| mode.dominating.iter().map(|i| names[*i].as_str()).collect::<Vec<_>>().join(", ");
        let modes = found[..end].iter().map(|mode| {
            let shape: Vec<f64> = mode.shape.iter().copied().collect();
            let multipliers = of_loops(source, rest, &shape, mode.omega_squared);
            Vibration { place: place(mode), omega_squared: mode.omega_squared, shape, multipliers }
        });
        let frequencies = Self { modes: modes.collect(), rest, asked, clusters };
        for &[first, end] in frequencies.clusters.iter().filter(|[first, end]| end - first > 1) {
            let [lowest, highest] = [first, end - 1].map(|index| frequencies.modes[index].omega_squared);
            let does = if highest - lowest <= SAME * (end - first) as f64 * highest.abs() {
                "coincide"
            } else {
                "differ by less than rounding leaves beside the stiffest spring, and are taken to coincide"
            };
            notes.push(format!(
                "frequencies {} to {end} {does}: their derivatives are those of the branches into which they part, in order",
                first + 1
            ));
        }
        if !frequencies.is_consistent(source, greatest) {
            notes.push("frequencies are left out: their form is not that of the modes".to_owned());
            return None;
        }
        Some(frequencies)
    }

    /// Whether the form at rest gives ω²; `greatest`: that of all modes.
    fn is_consistent(&self, source: &mut Source<'_>, greatest: f64) -> bool {
        let (q, multipliers) = (constants(&self.rest.q), constants(&self.rest.multipliers));
        let linear = Linear::new(source, self.rest, &q, &multipliers);
        self.modes.iter().all(|mode| {
            let form = linear.form(source, &mode.shape, mode.omega_squared).value();
            form.abs() <= CHECKED * mode.omega_squared + ROUNDING * greatest
        })
    }

    /// The frequencies that are asked for, Hz.
    pub fn outputs(&self, source: &mut Source<'_>, q: &[Dual8], multipliers: &[Dual8]) -> Vec<Valued> {
        let linear = Linear::new(source, self.rest, q, multipliers);
        let mut all = Vec::new();
        for &[first, end] in &self.clusters {
            let changes = changes(source, &linear, &self.modes[first..end]);
            for (index, slopes) in (first..end).zip(changes).filter(|(index, _)| *index < self.asked) {
                let mode = &self.modes[index];
                let omega = mode.omega_squared.max(0.0).sqrt();
                let frequency = Dual8::new(omega / TAU, slopes.map(|slope| slope / (2.0 * omega * TAU)));
                let output = named(format!("frequency_{}", index + 1), "Hz", Group::Frequencies);
                all.push((Output { place: mode.place.clone(), ..output }, frequency));
            }
        }
        all
    }
}

/// Slopes of ω² of modes that coincide, mode by mode.
fn changes(source: &mut Source<'_>, linear: &Linear, modes: &[Vibration]) -> Vec<[f64; DIRECTIONS]> {
    let omega_squared = modes.iter().map(|mode| mode.omega_squared).sum::<f64>() / modes.len() as f64;
    let own: Vec<Dual8> = modes.iter().map(|mode| linear.change(source, mode, omega_squared)).collect();
    if let [only] = own.as_slice() {
        return vec![std::array::from_fn(|direction| only.slope(direction))];
    }
    let size = modes.len();
    let mut forms = vec![DMatrix::<f64>::zeros(size, size); DIRECTIONS];
    for i in 0..size {
        for j in 0..=i {
            let entry = if i == j {
                own[i]
            } else {
                let both = modes[i].with(&modes[j], omega_squared);
                (linear.change(source, &both, omega_squared) - own[i] - own[j]) * 0.5
            };
            for (direction, form) in forms.iter_mut().enumerate() {
                (form[(i, j)], form[(j, i)]) = (entry.slope(direction), entry.slope(direction));
            }
        }
    }
    let mut slopes = vec![[0.0; DIRECTIONS]; size];
    for (direction, form) in forms.into_iter().enumerate() {
        let mut values: Vec<f64> = SymmetricEigen::new(form).eigenvalues.iter().copied().collect();
        values.sort_by(f64::total_cmp);
        slopes.iter_mut().zip(values).for_each(|(slopes, value)| slopes[direction] = value);
    }
    slopes
}

impl Vibration {
    /// The sum of two shapes, for a bilinear form from a quadratic one.
    fn with(&self, other: &Self, omega_squared: f64) -> Self {
        let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + b).collect();
        Self {
            shape: sum(&self.shape, &other.shape),
            multipliers: sum(&self.multipliers, &other.multipliers),
            omega_squared,
            place: String::new(),
        }
    }
}

/// The coefficients of small motions along a change of parameters, pose and forces of loops.
struct Linear {
    q: Vec<Dual8>,
    multipliers: Vec<Dual8>,
    /// A and K, column by column.
    mass: Vec<Dual8>,
    stiffness: Vec<Dual8>,
    /// Stiffness of bristles, by coordinate.
    bristles: Vec<(usize, f64)>,
    cylinders: Vec<Trapped>,
}

/// The oil that a shut valve traps in a cylinder: its index, its stiffness along the cylinder, N/m, and its force, N.
struct Trapped {
    index: usize,
    stiffness: Dual8,
    force: Dual8,
}

impl Linear {
    fn new(source: &mut Source<'_>, rest: &Rest, q: &[Dual8], multipliers: &[Dual8]) -> Self {
        let n = q.len();
        let matrices = source.at(FunctionId::Linearise, q);
        let description = source.crane.description();
        let bristles = description.bristles.iter().map(|joint| (joint.coordinate, joint.stiffness)).collect();
        Self {
            mass: matrices[..n * n].to_vec(),
            stiffness: matrices[n * n..2 * n * n].to_vec(),
            bristles,
            cylinders: trapped(source, rest, q, multipliers),
            q: q.to_vec(),
            multipliers: multipliers.to_vec(),
        }
    }

    /// `xᵀ (K − ω² A) x + Σ λ_i xᵀ ∂²φ_i/∂q² x`, with trapped oil and bristles.
    fn form(&self, source: &mut Source<'_>, shape: &[f64], omega_squared: f64) -> Dual8 {
        self.with_loops(source, shape, omega_squared, &[])
    }

    /// The change of ω².
    fn change(&self, source: &mut Source<'_>, mode: &Vibration, omega_squared: f64) -> Dual8 {
        self.with_loops(source, &mode.shape, omega_squared, &mode.multipliers)
    }

    /// The form, and `2 μᵀ J x`.
    fn with_loops(&self, source: &mut Source<'_>, shape: &[f64], omega_squared: f64, transmitted: &[f64]) -> Dual8 {
        let n = shape.len();
        let matrices = self.stiffness.chunks_exact(n.max(1)).zip(self.mass.chunks_exact(n.max(1)));
        let columns = matrices.zip(shape).map(|((stiffness, mass), x)| {
            let entries = stiffness.iter().zip(mass).zip(shape);
            entries.map(|((stiffness, mass), y)| (*stiffness - *mass * omega_squared) * *y).sum::<Dual8>() * *x
        });
        let mut form: Dual8 = columns.sum();
        for (coordinate, stiffness) in &self.bristles {
            form = form + Dual8::splat(stiffness * shape[*coordinate].powi(2));
        }
        let v = constants(shape);
        if !self.multipliers.is_empty() {
            let states = source.with_rates(FunctionId::LoopStates, &self.q, &v);
            for (equation, state) in states.chunks_exact(3).enumerate() {
                form = form + self.multipliers[equation] * state[2];
                form = form + state[1] * (2.0 * transmitted.get(equation).copied().unwrap_or(0.0));
            }
        }
        if self.cylinders.is_empty() {
            return form;
        }
        let here = source.with_rates(FunctionId::CylinderStates, &self.q, &v);
        let step = DIFFERENCE / shape.iter().fold(f64::MIN_POSITIVE, |size: f64, x| size.max(x.abs()));
        let [before, after] = [-step, step].map(|step| {
            let moved: Vec<Dual8> = self.q.iter().zip(shape).map(|(q, x)| *q + Dual8::splat(step * x)).collect();
            source.with_rates(FunctionId::CylinderStates, &moved, &v)
        });
        for Trapped { index, stiffness, force } in &self.cylinders {
            let rate = 3 * index + 1;
            let curvature = (after[rate] - before[rate]) * (0.5 / step);
            form = form + *stiffness * here[rate] * here[rate] - *force * curvature;
        }
        form
    }
}

/// The oil of all cylinders with a valve: `β (A²/V + A′²/V′)`, and the force that holds the pose.
fn trapped(source: &mut Source<'_>, rest: &Rest, q: &[Dual8], multipliers: &[Dual8]) -> Vec<Trapped> {
    let description = source.crane.description();
    if !description.has_valves() {
        return Vec::new();
    }
    let states = source.at(FunctionId::CylinderStates, q);
    let efforts = efforts(source, rest, q, multipliers);
    let with_valve = description.cylinders.iter().enumerate().filter(|(_, info)| info.valve.is_some());
    let of = |(index, info): (usize, &CylinderInfo)| {
        let ([piston, ring], [of_piston, of_rod]) = (info.areas, info.hose_volumes);
        let constant = Dual8::splat;
        let extension = states[3 * index] - constant(info.retracted);
        let sides = [
            constant(piston * piston) / (constant(of_piston) + extension * piston),
            constant(ring * ring) / (constant(of_rod) + (constant(info.stroke) - extension) * ring),
        ];
        let stiffness = (sides[0] + sides[1]) * info.bulk_modulus.unwrap_or(f64::NAN);
        Trapped { index, stiffness, force: efforts[info.drive] / states[3 * index + 2] }
    };
    with_valve.map(of).collect()
}

/// μ of a mode: `Jᵀ μ = −(K + Σ λ_i ∂²φ_i/∂q² − ω² A) x` in the free coordinates.
fn of_loops(source: &mut Source<'_>, rest: &Rest, shape: &[f64], omega_squared: f64) -> Vec<f64> {
    if rest.multipliers.is_empty() {
        return Vec::new();
    }
    let n = shape.len();
    let (q, multipliers) = (constants(&rest.q), constants(&rest.multipliers));
    let linear = Linear::new(source, rest, &q, &multipliers);
    // Along x: ∂J/∂q x.
    let along: Vec<Dual8> = rest.q.iter().zip(shape).map(|(q, x)| Dual8::new(*q, [*x; DIRECTIONS])).collect();
    let geometric = source.generalized(&along, &multipliers);
    let mut left: Vec<f64> = geometric.iter().map(|number| number.slope(0)).collect();
    for (column, x) in shape.iter().enumerate() {
        for (row, left) in left.iter_mut().enumerate() {
            let place = column * n + row;
            *left += (linear.stiffness[place].value() - omega_squared * linear.mass[place].value()) * x;
        }
    }
    for (coordinate, stiffness) in &linear.bristles {
        left[*coordinate] += stiffness * shape[*coordinate];
    }
    let rows = source.at(FunctionId::CylinderJacobians, &along);
    for Trapped { index, stiffness, force } in &linear.cylinders {
        let row = &rows[index * n..][..n];
        let rate: f64 = row.iter().zip(shape).map(|(entry, x)| entry.value() * x).sum();
        for (left, entry) in left.iter_mut().zip(row) {
            *left += stiffness.value() * rate * entry.value() - force.value() * entry.slope(0);
        }
    }
    let right: Vec<f64> = left.iter().map(|entry| -entry).collect();
    rest.balanced(source, &right)
}
