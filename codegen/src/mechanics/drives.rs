//! Drives: a spring and a damper between a coordinate and its prescribed motion, and an effort besides; or that motion itself. A joint that
//! oil moves has none of these: in motion, the force of its cylinder follows from pressures, which are states of the run; at rest it is that
//! of a spring along the cylinder.

use super::acts::{Acts, Rest, add};
use super::cylinders;
use super::model::Model;
use super::power_limits::delivered;
use super::profile;
use super::saturation::Saturation;
use super::tangent::Tangent;
use super::vector::SymmetricMatrix;
use crate::chain::{Drive, Value};
use crate::symbolic::Expr;

/// The drives of a chain, without rigid ones.
pub struct Drives<'a, 'g> {
    pub model: &'a Model<'g>,
}

impl<'g> Acts<'g> for Drives<'_, 'g> {
    fn in_motion(&self) -> Vec<Expr<'g>> {
        forces(self.model, self.model.t, &self.model.v)
    }

    /// Those of flexible drives and of cylinders with a valve.
    fn at_rest(&self, rest: &Rest<'g>) -> Vec<Expr<'g>> {
        let springs = forces_at_rest(self.model, rest);
        if !self.model.chain.has_valves() {
            return springs;
        }
        add(&springs, &cylinders::holding_forces(self.model, &rest.positions))
    }

    /// `E_dr = ½ Σ s (q_dr − q)²` [Urbaś 2016, Eq. (19)]; for a drive with a limit `∫ sat(s e) de`.
    fn energy(&self) -> Option<Expr<'g>> {
        let model = self.model;
        flexible(model).next()?;
        let positions = positions(model, model.t);
        let twice = linear(model).fold(model.zero(), |sum, (drive, stiffness, _)| {
            sum + model.number(stiffness) * stretch(model, drive, &positions).squared()
        });
        let springs = saturations(model, &positions, None).filter(|((_, s, _), _)| !s.is_zero());
        let limited = springs.map(|((_, s, _), spring)| spring.integral() / model.number(s));
        Some(limited.fold(0.5 * twice, |sum, energy| sum + energy))
    }

    /// `Σ d (q̇_dr − q̇)²` (2R of [Urbaś 2016, Eq. (19)]); for a drive with a limit `(sat(s e + d ė) − sat(s e)) ė ≥ 0`.
    fn dissipation(&self) -> Option<Expr<'g>> {
        let model = self.model;
        let rate = |drive: &Drive| profile::rate(model, &drive.profile, model.t) - model.v[drive.coordinate.0];
        let linear = linear(model)
            .fold(model.zero(), |sum, (drive, _, damping)| sum + model.number(damping) * rate(drive).squared());
        Some(saturations(model, &positions(model, model.t), None).fold(linear, |sum, (drive, spring)| {
            let damper = limited(model, drive.0, spring_and_damper(model, drive, model.t, &model.v)) - spring.effort();
            sum + damper * rate(drive.0)
        }))
    }

    fn add_stiffness(&self, rest: &Rest<'g>, Tangent { matrix, .. }: &mut Tangent<'_, 'g>) {
        matrix.add_diagonal(linear(self.model).map(|(drive, s, _)| (drive.coordinate.0, self.model.number(s))));
        self.add_limited(rest, |drive| drive.1, matrix);
    }

    fn add_damping(&self, rest: &Rest<'g>, matrix: &mut SymmetricMatrix<'g>) {
        matrix.add_diagonal(linear(self.model).map(|(drive, _, d)| (drive.coordinate.0, self.model.number(d))));
        self.add_limited(rest, |drive| drive.2, matrix);
    }

    fn add_step_matrices(&self, [stiffness, damping]: [&mut SymmetricMatrix<'g>; 2]) {
        for (drive, s, d) in linear(self.model) {
            let j = drive.coordinate.0;
            stiffness.add(j, j, self.model.number(s));
            damping.add(j, j, self.model.number(d));
        }
    }

    fn add_nonlinear(&self, diagonal: &mut [[Expr<'g>; 2]]) {
        for (sum, own) in diagonal.iter_mut().zip(stiffness_and_damping(self.model)) {
            *sum = [sum[0] + own[0], sum[1] + own[1]];
        }
    }
}

impl<'g> Drives<'_, 'g> {
    /// Adds the stiffness or the damping of drives with a limit at rest, on the diagonal.
    fn add_limited(
        &self,
        rest: &Rest<'g>,
        number: impl for<'d> Fn((&'d Drive, &'d Value, &'d Value)) -> &'d Value,
        matrix: &mut SymmetricMatrix<'g>,
    ) {
        let entry = |(drive, spring): ((&Drive, &Value, &Value), Saturation<'g>)| {
            (drive.0.coordinate.0, spring.slope() * self.model.number(number(drive)))
        };
        matrix.add_diagonal(saturations(self.model, &rest.positions, Some(rest.t)).map(entry));
    }
}

/// Drives with a spring, with its stiffness and damping.
fn flexible<'a>(model: &'a Model<'_>) -> impl Iterator<Item = (&'a Drive, &'a Value, &'a Value)> {
    model.chain.drives.iter().filter_map(|drive| drive.spring().map(|(s, d)| (drive, s, d)))
}

/// `s (q_dr − q) + d (q̇_dr − q̇)`
fn spring_and_damper<'g>(
    model: &Model<'g>,
    (drive, stiffness, damping): (&Drive, &Value, &Value),
    t: Expr<'g>,
    v: &[Expr<'g>],
) -> Expr<'g> {
    let j = drive.coordinate.0;
    let stretch = profile::position(model, &drive.profile, t) - model.q[j];
    let rate = profile::rate(model, &drive.profile, t) - v[j];
    model.number(stiffness) * stretch + model.number(damping) * rate
}

/// The effort u of spring and damper, and the effort besides at time t: `u + τ(t)`.
fn with_effort<'g>(model: &Model<'g>, drive: &Drive, effort: Expr<'g>, t: Expr<'g>) -> Expr<'g> {
    drive.effort().map_or(effort, |given| effort + profile::position(model, given, t))
}

/// `s (q_dr − q) + d (q̇_dr − q̇) + τ(t)`
fn unlimited<'g>(model: &Model<'g>, drive: (&Drive, &Value, &Value), t: Expr<'g>, v: &[Expr<'g>]) -> Expr<'g> {
    with_effort(model, drive.0, spring_and_damper(model, drive, t, v), t)
}

/// `t_dr = s (q_dr − q) + d (q̇_dr − q̇) + τ(t)` [Urbaś 2016, Eqs. (20)–(21), with τ besides], within the limits of the drive.
fn effort<'g>(model: &Model<'g>, flexible: (&Drive, &Value, &Value), t: Expr<'g>, v: &[Expr<'g>]) -> Expr<'g> {
    let within = limited(model, flexible.0, unlimited(model, flexible, t, v));
    named(model, flexible.0, delivered(model, flexible.0, within, v[flexible.0.coordinate.0]))
}

/// An effort, limited to the maximum of its drive.
fn limited<'g>(model: &Model<'g>, drive: &Drive, effort: Expr<'g>) -> Expr<'g> {
    drive.max_effort().map_or(effort, |limit| Saturation::new(effort, model.number(limit)).effort())
}

/// Drives with a limit, and the saturation of the efforts of their springs with the drives at given positions; with the efforts besides at
/// a time, if one is given.
fn saturations<'a, 'g>(
    model: &'a Model<'g>,
    positions: &'a [Expr<'g>],
    besides: Option<Expr<'g>>,
) -> impl Iterator<Item = ((&'a Drive, &'a Value, &'a Value), Saturation<'g>)> {
    flexible(model).filter_map(move |drive| {
        let limit = model.number(drive.0.max_effort()?);
        let spring = model.number(drive.1) * stretch(model, drive.0, positions);
        let effort = besides.map_or(spring, |t| with_effort(model, drive.0, spring, t));
        Some((drive, Saturation::new(effort, limit)))
    })
}

/// Positions of the drives at time t, by coordinate.
pub fn positions<'g>(model: &Model<'g>, t: Expr<'g>) -> Vec<Expr<'g>> {
    let mut positions = model.zeros();
    for drive in &model.chain.drives {
        positions[drive.coordinate.0] = profile::position(model, &drive.profile, t);
    }
    positions
}

/// `q_dr − q`
fn stretch<'g>(model: &Model<'g>, drive: &Drive, positions: &[Expr<'g>]) -> Expr<'g> {
    let j = drive.coordinate.0;
    positions[j] - model.q[j]
}

fn named<'g>(model: &Model<'g>, drive: &Drive, effort: Expr<'g>) -> Expr<'g> {
    model.graph.name(effort, format!("effort_{}", model.chain.coordinates[drive.coordinate.0].name));
    effort
}

/// Generalized forces of the flexible drives.
pub fn forces<'g>(model: &Model<'g>, t: Expr<'g>, v: &[Expr<'g>]) -> Vec<Expr<'g>> {
    let mut forces = model.zeros();
    for drive in flexible(model) {
        forces[drive.0.coordinate.0] = effort(model, drive, t, v);
    }
    forces
}

/// Generalized forces of the flexible drives' springs and of the efforts besides, with the crane at rest and the drives at given positions:
/// dampers do not act, even if a motion is in progress.
fn forces_at_rest<'g>(model: &Model<'g>, rest: &Rest<'g>) -> Vec<Expr<'g>> {
    let mut forces = model.zeros();
    for (drive, stiffness, _) in flexible(model) {
        let stretch = stretch(model, drive, &rest.positions);
        let effort = with_effort(model, drive, model.number(stiffness) * stretch, rest.t);
        forces[drive.coordinate.0] = named(model, drive, limited(model, drive, effort));
    }
    forces
}

/// `q̈_dr` of the coordinates that rigid drives prescribe.
pub fn accelerations<'g>(model: &Model<'g>) -> Vec<Option<Expr<'g>>> {
    prescribed(model, |drive| profile::acceleration(model, &drive.profile, model.t))
}

/// Zero for the coordinates that rigid drives prescribe, which are not part of a solution.
pub fn at_rest<'g>(model: &Model<'g>) -> Vec<Option<Expr<'g>>> {
    prescribed(model, |_| model.zero())
}

fn prescribed<'g>(model: &Model<'g>, of: impl Fn(&Drive) -> Expr<'g>) -> Vec<Option<Expr<'g>>> {
    let mut prescribed = vec![None; model.size()];
    for drive in model.chain.rigid_drives() {
        prescribed[drive.coordinate.0] = Some(of(drive));
    }
    prescribed
}

/// `−∂t_dr/∂q` and `−∂t_dr/∂q̇` of drives with a limit, coordinate by coordinate.
fn stiffness_and_damping<'g>(model: &Model<'g>) -> Vec<[Expr<'g>; 2]> {
    let mut stiffness_and_damping = vec![[model.zero(); 2]; model.size()];
    for drive in flexible(model) {
        let Some(limit) = drive.0.max_effort() else { continue };
        let j = drive.0.coordinate.0;
        if drive.0.max_rate().is_some() || drive.0.max_power().is_some() {
            // A step does not need the exact derivative, but `A + D̂` must stay positive definite.
            let effort = effort(model, drive, model.t, &model.v);
            let falling = |by| (-model.graph.derivatives(&[effort], by)[0]).max(model.zero());
            stiffness_and_damping[j] = [falling(model.q[j]), falling(model.v[j])];
            continue;
        }
        let slope = Saturation::new(unlimited(model, drive, model.t, &model.v), model.number(limit)).slope();
        stiffness_and_damping[j] = [drive.1, drive.2].map(|of| slope * model.number(of));
    }
    stiffness_and_damping
}

/// Drives whose efforts have no limit.
fn linear<'a>(model: &'a Model<'_>) -> impl Iterator<Item = (&'a Drive, &'a Value, &'a Value)> {
    flexible(model).filter(|(drive, ..)| drive.max_effort().is_none())
}

/// Maximum effort of every drive, 0 if it has no limit, and its stiffness at the state, `−∂t_dr/∂q`.
pub fn limits<'g>(model: &Model<'g>) -> Vec<Expr<'g>> {
    let zero = model.zero();
    let limit = |drive: &Drive| {
        let Some((stiffness, damping)) = drive.spring() else { return [zero; 2] };
        let linear = model.number(stiffness);
        drive.max_effort().map_or([zero, linear], |limit| {
            let limit = model.number(limit);
            let j = drive.coordinate.0;
            if drive.max_rate().is_some() || drive.max_power().is_some() {
                let effort = effort(model, (drive, stiffness, damping), model.t, &model.v);
                return [limit, -model.graph.derivatives(&[effort], model.q[j])[0]];
            }
            let effort = unlimited(model, (drive, stiffness, damping), model.t, &model.v);
            [limit, Saturation::new(effort, limit).slope() * linear]
        })
    };
    model.chain.drives.iter().flat_map(limit).collect()
}

/// `q_dr, q̇_dr` of drives.
pub fn motions<'g, 'a>(model: &Model<'g>, drives: impl Iterator<Item = &'a Drive>) -> Vec<Expr<'g>> {
    let motion = |drive: &Drive| {
        [profile::position(model, &drive.profile, model.t), profile::rate(model, &drive.profile, model.t)]
    };
    drives.flat_map(motion).collect()
}

/// Opening and its rate for every drive whose valve has a command over time; zeros for all others.
pub fn openings<'g>(model: &Model<'g>) -> Vec<Expr<'g>> {
    let opening = |drive: &Drive| {
        drive.opening().map_or([model.zero(); 2], |profile| {
            [profile::position(model, profile, model.t), profile::rate(model, profile, model.t)]
        })
    };
    model.chain.drives.iter().flat_map(opening).collect()
}

/// Start and end of the smooth intervals of every drive's motion and valve.
pub fn pieces<'g>(model: &Model<'g>) -> Vec<Expr<'g>> {
    let pieces = model.chain.drives.iter().flat_map(Drive::pieces);
    pieces.flatten().map(|time| model.number(&time)).collect()
}

/// Power of the prescribed motions and of the efforts besides: with the efforts w of spring and damper and u of the whole drive, both within
/// its maximum, `Σ w q̇_dr + (u − w) q̇`, minus the power of the effort that slips in drives at their limits of power and rate; for rigid
/// drives, whose efforts are given, `τ q̇`.
pub fn power<'g>(model: &Model<'g>, efforts: &[Expr<'g>]) -> Expr<'g> {
    let flexible = flexible(model).fold(model.zero(), |sum, drive| {
        let (motion, rate) = (profile::rate(model, &drive.0.profile, model.t), model.v[drive.0.coordinate.0]);
        let within = limited(model, drive.0, unlimited(model, drive, model.t, &model.v));
        let slipping = within - delivered(model, drive.0, within, rate);
        if drive.0.effort().is_none() {
            return sum + (within * motion - slipping * rate);
        }
        let passive = limited(model, drive.0, spring_and_damper(model, drive, model.t, &model.v));
        sum + (passive * motion + (within - passive - slipping) * rate)
    });
    model.chain.rigid_drives().map(|drive| drive.coordinate.0).fold(flexible, |sum, j| sum + efforts[j] * model.v[j])
}
