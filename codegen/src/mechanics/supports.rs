//! Flexible supports of the base.
//!
//! Notation
//! : support at r_E of the first body; stretch `e`, stiffness `s`, damping `d` along the world's x, y, z; J its Jacobian.
//!   Linear kinematics: `e = U q̃ − δ`, J = U constant. Exact: `e = T r_E − r_E0 − δ`, column j of J is `Ω_j T r_E`.
//!
//! Everything is expressed in J and e: `f = −Jᵀ (s e + d ė)`, `E = ½ eᵀ s e`. Linear supports are summed into one
//! 6×6 stiffness and damping of the base, which is then multiplied by the state, because their J is constant. One-sided supports
//! follow the law of [`contact`](super::contact) instead of `s e + d ė`.

use crate::chain::{CoordinateId, Step, Support, SupportKinematics};
use crate::symbolic::Expr;

use super::acts::{Acts, Rest};
use super::contact::Contact;
use super::kinematics::Kinematics;
use super::model::Model;
use super::tangent::Tangent;
use super::vector::{Rotation, Symmetric3, SymmetricMatrix, Vec3};

/// The supports of the base.
pub struct Supports<'a, 'g> {
    pub model: &'a Model<'g>,
    pub kinematics: &'a Kinematics<'g>,
}

impl<'g> Acts<'g> for Supports<'_, 'g> {
    fn in_motion(&self) -> Vec<Expr<'g>> {
        forces(self.model, self.kinematics, &self.model.v)
    }

    fn at_rest(&self, _: &Rest<'g>) -> Vec<Expr<'g>> {
        forces(self.model, self.kinematics, &self.model.zeros())
    }

    /// `E_s = ½ Σ s e²` [Urbaś 2016, Eqs. (16)–(17)].
    fn energy(&self) -> Option<Expr<'g>> {
        Some(0.5 * sum(self.model, self.kinematics, |s| (s.stretch, s.stiffness), Contact::twice_energy))
    }

    /// `Σ d ė²` (2R of [Urbaś 2016, Eq. (17)]).
    fn dissipation(&self) -> Option<Expr<'g>> {
        Some(sum(self.model, self.kinematics, |s| (s.rate, s.damping), Contact::dissipation))
    }

    /// `J_iᵀ (−∂f/∂e) J_j − f · Ω_i Ω_j T r_E` at rest; linear kinematics have no second term.
    fn add_stiffness(&self, _: &Rest<'g>, tangent: &mut Tangent<'_, 'g>) {
        let matrix = &mut tangent.matrix;
        add_stiffness(self.model, self.kinematics, &self.model.zeros(), Stretched::tangent, matrix);
    }

    /// `Jᵀ d J`
    fn add_damping(&self, _: &Rest<'g>, matrix: &mut SymmetricMatrix<'g>) {
        let at_rest = |stretched: &Stretched<'g>| {
            stretched.contact().map_or(stretched.damping, |contact| contact.damping_at_rest())
        };
        add_damping(self.model, self.kinematics, &self.model.zeros(), at_rest, matrix);
    }

    fn add_step_matrices(&self, [stiffness, damping]: [&mut SymmetricMatrix<'g>; 2]) {
        let &Supports { model, kinematics } = self;
        let of = |stretched: &Stretched<'g>| stretched.stiffness_and_damping();
        add_stiffness(model, kinematics, &model.v, |stretched| diagonal(of(stretched)[0]), stiffness);
        add_damping(model, kinematics, &model.v, |stretched| of(stretched)[1], damping);
    }
}

/// The base coordinates that the crane has: place in `x y z ψ θ φ`, and place in q.
fn base_coordinates<'a>(model: &'a Model<'_>) -> impl Iterator<Item = (usize, usize)> + Clone + 'a {
    model.chain.base.iter().enumerate().filter_map(|(index, id)| id.map(|CoordinateId(j)| (index, j)))
}

/// Column of U for a place in `x y z ψ θ φ` [Urbaś 2016, Eq. (16), with the columns in that order]: the displacement of
/// the point at r by a small motion of that coordinate.
fn linear_column<'g>(model: &Model<'g>, r: Vec3<'g>, index: usize) -> Vec3<'g> {
    let (zero, one) = (model.zero(), model.graph.constant(1.0));
    Vec3(match index {
        0 => [one, zero, zero],
        1 => [zero, one, zero],
        2 => [zero, zero, one],
        3 => [-r[1], r[0], zero],
        4 => [r[2], zero, -r[0]],
        _ => [zero, -r[2], r[1]],
    })
}

/// Where the supports hold the base, world frame, m.
pub fn positions<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Vec<Expr<'g>> {
    let base = &kinematics.poses[0];
    let position = |support: &Support| {
        (base.origin + base.rotation.apply(model.vector(&support.position)))
            .named(&format!("position_{}", support.name))
            .0
    };
    model.chain.supports.iter().flat_map(position).collect()
}

/// A support at the present state.
struct Stretched<'g> {
    /// e, m.
    stretch: Vec3<'g>,
    /// ė, m/s.
    rate: Vec3<'g>,
    /// Columns of J for the base's coordinates.
    jacobian: Vec<(usize, Vec3<'g>)>,
    stiffness: Vec3<'g>,
    damping: Vec3<'g>,
    /// μ of a one-sided support.
    friction: Option<Expr<'g>>,
    /// Whether J depends on the pose.
    exact: bool,
}

impl<'g> Stretched<'g> {
    fn new(model: &Model<'g>, kinematics: &Kinematics<'g>, support: &Support, v: &[Expr<'g>]) -> Self {
        let r = model.vector(&support.position);
        let free_play = model.vector(&support.free_play);
        let zero = Vec3::zero(model.graph);
        let (attachment, jacobian): (_, Vec<_>) = match support.kinematics {
            SupportKinematics::Linear => {
                (None, base_coordinates(model).map(|(index, j)| (j, linear_column(model, r, index))).collect())
            }
            SupportKinematics::Exact => {
                let base = &kinematics.poses[0];
                let at = base.origin + base.rotation.apply(r);
                let column = |(_, j): (usize, usize)| (j, kinematics.generators[j].velocity(at));
                (Some(at), base_coordinates(model).map(column).collect())
            }
        };
        let displacement = match attachment {
            Some(at) => at - at_rest(model, r),
            None => jacobian.iter().fold(zero, |sum, &(j, column)| sum + model.q[j] * column),
        };
        Stretched {
            stretch: displacement - free_play,
            rate: jacobian.iter().fold(zero, |sum, &(j, column)| sum + v[j] * column),
            jacobian,
            stiffness: model.vector(&support.stiffness),
            damping: model.vector(&support.damping),
            friction: support.friction.as_ref().map(|coefficient| model.number(coefficient)),
            exact: support.kinematics == SupportKinematics::Exact,
        }
    }

    /// Its law if it is one-sided.
    fn contact(&self) -> Option<Contact<'g>> {
        let &Self { stretch: elongation, rate, stiffness, damping, friction, .. } = self;
        friction.map(|friction| Contact { elongation, rate, stiffness, damping, friction })
    }

    /// Force on the crane, `−s e − d ė`, N.
    fn reaction(&self) -> Vec3<'g> {
        self.contact().map_or_else(
            || Vec3([0, 1, 2].map(|a| -(self.stiffness[a] * self.stretch[a] + self.damping[a] * self.rate[a]))),
            |contact| contact.reaction(),
        )
    }

    /// `−f` at rest, N.
    fn pull(&self) -> Vec3<'g> {
        let spring = || Vec3([0, 1, 2].map(|a| self.stiffness[a] * self.stretch[a]));
        self.contact().map_or_else(spring, |contact| contact.pull())
    }

    /// `−∂f/∂e` at rest, N/m.
    fn tangent(&self) -> Symmetric3<'g> {
        self.contact().map_or_else(|| diagonal(self.stiffness), |contact| contact.tangent())
    }

    /// Stiffness and damping for an implicit step, N/m and N s/m.
    fn stiffness_and_damping(&self) -> [Vec3<'g>; 2] {
        self.contact().map_or([self.stiffness, self.damping], |contact| contact.stiffness_and_damping())
    }
}

/// `diag(c)`
fn diagonal(c: Vec3<'_>) -> Symmetric3<'_> {
    let zero = c[0].graph().constant(0.0);
    Symmetric3([c[0], c[1], c[2], zero, zero, zero])
}

/// Where a point of the first body is at q̃ = 0, by its constant placement alone.
fn at_rest<'g>(model: &Model<'g>, r: Vec3<'g>) -> Vec3<'g> {
    model.chain.bodies[0].path.iter().rev().fold(r, |point, step| match step {
        Step::Translate(by) => point + model.vector(by),
        Step::Rotate { axis, sin, cos } => {
            let (sin, cos) = (model.number(sin), model.number(cos));
            Rotation::identity(model.graph).rotated(*axis, sin, cos).apply(point)
        }
        Step::Move(_) | Step::RotationVector(_) => point,
    })
}

/// Whether force and elongation are linear in the base's coordinates.
fn is_linear(support: &Support) -> bool {
    support.kinematics == SupportKinematics::Linear && support.friction.is_none()
}

/// Supports whose J depends on the pose or whose law is nonlinear; these are treated one by one.
fn nonlinear<'a>(model: &'a Model<'_>) -> impl Iterator<Item = &'a Support> {
    model.chain.supports.iter().filter(|support| !is_linear(support))
}

fn linear<'a>(model: &'a Model<'_>) -> impl Iterator<Item = &'a Support> {
    model.chain.supports.iter().filter(|support| is_linear(support))
}

/// `Σ Uᵀ diag(c) U` over the linear supports, c their stiffness or damping [Urbaś 2016, Eq. (18), row by row].
fn linear_matrix<'g>(model: &Model<'g>, of: impl Fn(&Support) -> Vec3<'g>, matrix: &mut SymmetricMatrix<'g>) {
    for ((a, i), (b, j)) in pairs(base_coordinates(model)) {
        matrix.add(i, j, linear_entry(model, &of, a, b));
    }
}

/// One entry of [`linear_matrix`], for the places a and b in `x y z ψ θ φ`.
fn linear_entry<'g>(model: &Model<'g>, of: impl Fn(&Support) -> Vec3<'g>, a: usize, b: usize) -> Expr<'g> {
    let terms = linear(model).map(|support| {
        let (r, c) = (model.vector(&support.position), of(support));
        let (u, w) = (linear_column(model, r, a), linear_column(model, r, b));
        Vec3([0, 1, 2].map(|axis| c[axis] * u[axis])).dot(w)
    });
    balanced_sum(model, terms.collect())
}

/// A sum in which numbers that cancel, as those of a symmetric layout do, leave exactly zero and not a rounding error, so that
/// uncoupled coordinates stay uncoupled.
fn balanced_sum<'g>(model: &Model<'g>, terms: Vec<Expr<'g>>) -> Expr<'g> {
    let numbers: Option<Vec<f64>> = terms.iter().map(|term| term.as_constant()).collect();
    if let Some(numbers) = numbers {
        let size: f64 = numbers.iter().map(|x| x.abs()).sum();
        let sum: f64 = numbers.iter().sum();
        // Each term contributes a few rounding errors, each addition one.
        if sum.abs() <= (numbers.len() + 4) as f64 * f64::EPSILON * size {
            return model.zero();
        }
    }
    terms.into_iter().fold(model.zero(), |sum, term| sum + term)
}

/// All pairs of items, the first not after the second.
fn pairs<T: Copy>(items: impl Iterator<Item = T> + Clone) -> impl Iterator<Item = (T, T)> {
    items.clone().enumerate().flat_map(move |(k, first)| items.clone().skip(k).map(move |second| (first, second)))
}

/// `f = −Jᵀ (s e + d ė)` of all supports [Urbaś 2016, Eq. (18), row by row and without the absolute value].
fn forces<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, v: &[Expr<'g>]) -> Vec<Expr<'g>> {
    let mut forces = model.zeros();
    for (a, i) in base_coordinates(model) {
        let preload = linear_preload(model, a);
        forces[i] = base_coordinates(model).fold(preload, |sum, (b, j)| {
            let stiffness = linear_entry(model, |s| model.vector(&s.stiffness), a, b);
            let damping = linear_entry(model, |s| model.vector(&s.damping), a, b);
            sum - (stiffness * model.q[j] + damping * v[j])
        });
    }
    for support in nonlinear(model) {
        let stretched = Stretched::new(model, kinematics, support, v);
        let reaction = stretched.reaction();
        for (j, column) in &stretched.jacobian {
            forces[*j] = forces[*j] + column.dot(reaction);
        }
    }
    forces
}

/// `Σ uᵀ s δ`: the force due to the free play of the linear supports at q̃ = 0.
fn linear_preload<'g>(model: &Model<'g>, index: usize) -> Expr<'g> {
    let terms = linear(model).map(|support| {
        let (s, free_play) = (model.vector(&support.stiffness), model.vector(&support.free_play));
        let column = linear_column(model, model.vector(&support.position), index);
        Vec3([0, 1, 2].map(|axis| s[axis] * free_play[axis])).dot(column)
    });
    balanced_sum(model, terms.collect())
}

/// Force of each support on the crane, world frame, N.
pub fn reactions<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Vec<Expr<'g>> {
    let reaction = |s| Stretched::new(model, kinematics, s, &model.v).reaction().0;
    model.chain.supports.iter().flat_map(reaction).collect()
}

/// Gap of each support, that is, its height above the ground, and the rate of the gap, m and m/s: `e_z` and `ė_z` for one-sided
/// supports, with a negative gap where they are pressed in; 0 for all others.
pub fn gaps<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Vec<Expr<'g>> {
    let gap = |support: &Support| {
        let stretched = Stretched::new(model, kinematics, support, &model.v);
        let one_sided = |number: Expr<'g>| if support.friction.is_some() { number } else { model.zero() };
        [one_sided(stretched.stretch[2]), one_sided(stretched.rate[2])]
    };
    model.chain.supports.iter().flat_map(gap).collect()
}

/// Elongation of each support, e, m.
pub fn elongations<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Vec<Expr<'g>> {
    let elongation = |support| Stretched::new(model, kinematics, support, &model.v).stretch.0;
    model.chain.supports.iter().flat_map(elongation).collect()
}

/// J of each support: its rows along x, y and z.
pub fn jacobians<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Vec<Expr<'g>> {
    let rows = |support| {
        let mut rows = [model.zeros(), model.zeros(), model.zeros()];
        for (j, column) in Stretched::new(model, kinematics, support, &model.v).jacobian {
            rows.iter_mut().zip(column.0).for_each(|(row, entry)| row[j] = entry);
        }
        rows
    };
    model.chain.supports.iter().flat_map(rows).flatten().collect()
}

/// Where each support is attached, in the frame of the base, m.
pub fn places<'g>(model: &Model<'g>) -> Vec<Expr<'g>> {
    model.chain.supports.iter().flat_map(|support| model.vector(&support.position).0).collect()
}

/// Stiffness s of each support along the world's axes, N/m.
pub fn stiffnesses<'g>(model: &Model<'g>) -> Vec<Expr<'g>> {
    model.chain.supports.iter().flat_map(|support| model.vector(&support.stiffness).0).collect()
}

/// Damping d of each support along the world's axes, N s/m.
pub fn dampings<'g>(model: &Model<'g>) -> Vec<Expr<'g>> {
    model.chain.supports.iter().flat_map(|support| model.vector(&support.damping).0).collect()
}

/// Pressing force N of each support, the lateral force μ N up to which it sticks, and the lateral force |F| that holds it where the spec puts it,
/// N; zeros for supports that are not one-sided.
pub fn grips<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>) -> Vec<Expr<'g>> {
    let grip = |support| {
        let contact = Stretched::new(model, kinematics, support, &model.v).contact();
        contact.map_or([model.zero(); 3], |contact| [contact.pressing(), contact.grip(), contact.lateral_size()])
    };
    model.chain.supports.iter().flat_map(grip).collect()
}

/// `Σ c x²` over supports and axes; for one-sided supports, the value that their law gives.
fn sum<'g>(
    model: &Model<'g>,
    kinematics: &Kinematics<'g>,
    of: impl Fn(&Stretched<'g>) -> (Vec3<'g>, Vec3<'g>),
    of_contact: impl Fn(&Contact<'g>) -> Expr<'g>,
) -> Expr<'g> {
    model.chain.supports.iter().fold(model.zero(), |sum, support| {
        let stretched = Stretched::new(model, kinematics, support, &model.v);
        if let Some(contact) = stretched.contact() {
            return sum + of_contact(&contact);
        }
        let (x, c) = of(&stretched);
        (0..3).fold(sum, |sum, axis| sum + c[axis] * x[axis].squared())
    })
}

fn add_stiffness<'g>(
    model: &Model<'g>,
    kinematics: &Kinematics<'g>,
    v: &[Expr<'g>],
    tangent: impl Fn(&Stretched<'g>) -> Symmetric3<'g>,
    matrix: &mut SymmetricMatrix<'g>,
) {
    linear_matrix(model, |s| model.vector(&s.stiffness), matrix);
    for support in nonlinear(model) {
        let stretched = Stretched::new(model, kinematics, support, v);
        let (tangent, pull) = (tangent(&stretched), stretched.pull());
        for (&(i, u), &(j, w)) in pairs(stretched.jacobian.iter()) {
            let first_order = tangent.apply(u).dot(w);
            // J_j is Ω_j T r_E, a direction that Ω_i turns.
            let second_order =
                if stretched.exact { pull.dot(kinematics.generators[i].rotate(w)) } else { model.zero() };
            matrix.add(i, j, first_order + second_order);
        }
    }
}

fn add_damping<'g>(
    model: &Model<'g>,
    kinematics: &Kinematics<'g>,
    v: &[Expr<'g>],
    damping: impl Fn(&Stretched<'g>) -> Vec3<'g>,
    matrix: &mut SymmetricMatrix<'g>,
) {
    linear_matrix(model, |s| model.vector(&s.damping), matrix);
    for support in nonlinear(model) {
        let stretched = Stretched::new(model, kinematics, support, v);
        let d = damping(&stretched);
        for (&(i, u), &(j, w)) in pairs(stretched.jacobian.iter()) {
            matrix.add(i, j, Vec3([0, 1, 2].map(|a| d[a] * u[a])).dot(w));
        }
    }
}
