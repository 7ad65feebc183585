//! Everything that acts on the chain besides inertia and gravity, kind by kind.
//!
//! Whatever sums over all forces goes through [`Forces`]: a new kind is a variant of [`Kind`], listed in `Kind::ALL`, and the compiler
//! finds the places that must handle it. A kind has a law on strains of the pose, `f = −Jᵀ F(s, ṡ)`; if it stores energy, it exerts
//! −∂E/∂q at rest.

use super::kinematics::Kinematics;
use super::model::Model;
use super::vector::SymmetricMatrix;
use super::{connectors, cylinders, drives, joints, loads, springs, supports};
use crate::symbolic::Expr;

/// A kind of force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Springs and dampers between the base and the ground; strains: displacements of the feet.
    Supports,
    /// Springs and dampers between rigid elements; strains: their angles.
    BeamSprings,
    /// Springs and dampers between driven coordinates and their motions.
    Drives,
    /// Viscous damping of passive joints.
    JointDampers,
    /// End stops of joints.
    Stops,
    /// Friction of joints.
    Friction,
    /// Forces and moments applied from outside.
    Loads,
    /// Elements between two points, and couplings of coordinates; strains: their lengths.
    Connectors,
}

impl Kind {
    /// All kinds, in the order in which their forces are added.
    const ALL: [Kind; 8] = [
        Kind::Supports,
        Kind::BeamSprings,
        Kind::Drives,
        Kind::JointDampers,
        Kind::Stops,
        Kind::Friction,
        Kind::Loads,
        Kind::Connectors,
    ];
}

/// What is given at rest besides the pose.
pub struct Rest<'g> {
    /// Time of loads and winches, s.
    pub t: Expr<'g>,
    /// Positions at which the drives hold the crane, by coordinate.
    pub positions: Vec<Expr<'g>>,
}

impl<'g> Rest<'g> {
    /// At any time, with the drives at any positions.
    pub fn given(model: &Model<'g>) -> Self {
        Rest { t: model.t, positions: model.drive_positions.clone() }
    }

    /// At t = 0, with the drives where their motions start.
    pub fn at_start(model: &Model<'g>) -> Self {
        Rest { t: model.zero(), positions: drives::positions(model, model.zero()) }
    }
}

/// The forces of a chain, except those of rigid drives, which have no law: they follow from the motion.
pub struct Forces<'a, 'g> {
    model: &'a Model<'g>,
    kinematics: &'a Kinematics<'g>,
}

impl<'a, 'g> Forces<'a, 'g> {
    pub fn new(model: &'a Model<'g>, kinematics: &'a Kinematics<'g>) -> Self {
        Forces { model, kinematics }
    }

    /// The kinds that the chain has.
    pub fn kinds(&self) -> impl Iterator<Item = Kind> {
        let chain = self.model.chain;
        Kind::ALL.into_iter().filter(move |kind| match kind {
            Kind::Supports => !chain.supports.is_empty(),
            Kind::BeamSprings => !chain.beam_springs.is_empty(),
            Kind::Drives => !chain.drives.is_empty(),
            Kind::JointDampers => !chain.joint_dampers.is_empty(),
            Kind::Stops => chain.stops().next().is_some(),
            Kind::Friction => chain.frictions().next().is_some(),
            Kind::Loads => !chain.loads.is_empty(),
            Kind::Connectors => !chain.connectors.is_empty(),
        })
    }

    /// Generalized forces of a kind in motion.
    pub fn in_motion(&self, kind: Kind) -> Vec<Expr<'g>> {
        let &Forces { model, kinematics } = self;
        let (t, v) = (model.t, &model.v);
        match kind {
            Kind::Supports => supports::forces(model, kinematics, v),
            Kind::BeamSprings => springs::element_forces(model, &model.q, v),
            Kind::Drives => drives::forces(model, t, v),
            Kind::JointDampers => springs::joint_damper_forces(model, v),
            Kind::Stops => joints::stop_forces(model, v),
            Kind::Friction => joints::friction_forces(model, v),
            Kind::Loads => loads::forces(model, kinematics, t),
            Kind::Connectors => connectors::forces(model, kinematics, t, Some(v)),
        }
    }

    /// Generalized forces of a kind at rest, `−∂E/∂q`: oil holds its joints, and no winch moves.
    fn at_rest(&self, kind: Kind, rest: &Rest<'g>) -> Vec<Expr<'g>> {
        let &Forces { model, kinematics } = self;
        let zeros = model.zeros();
        match kind {
            Kind::Supports => supports::forces(model, kinematics, &zeros),
            Kind::BeamSprings => springs::element_forces(model, &model.q, &zeros),
            Kind::Drives => self.drives_at_rest(rest),
            Kind::JointDampers | Kind::Friction => zeros,
            Kind::Stops => joints::stop_forces(model, &zeros),
            Kind::Loads => loads::forces(model, kinematics, rest.t),
            Kind::Connectors => connectors::forces(model, kinematics, rest.t, None),
        }
    }

    /// Generalized forces of flexible drives and cylinders with a valve at rest.
    pub fn drives_at_rest(&self, rest: &Rest<'g>) -> Vec<Expr<'g>> {
        let springs = drives::forces_at_rest(self.model, &rest.positions);
        if !self.model.chain.has_valves() {
            return springs;
        }
        add(&springs, &cylinders::holding_forces(self.model, &rest.positions))
    }

    /// Energy of a kind, if it stores any.
    pub fn energy(&self, kind: Kind) -> Option<Expr<'g>> {
        let &Forces { model, kinematics } = self;
        match kind {
            Kind::Supports => Some(supports::energy(model, kinematics)),
            Kind::BeamSprings => Some(springs::element_energy(model)),
            Kind::Drives => {
                model.chain.drives.iter().any(|drive| drive.spring().is_some()).then(|| drives::energy(model))
            }
            Kind::Stops => Some(joints::stop_energy(model)),
            Kind::Connectors => Some(connectors::energy(model, kinematics)),
            Kind::JointDampers | Kind::Friction | Kind::Loads => None,
        }
    }

    /// Power that a kind dissipates.
    fn dissipation_of(&self, kind: Kind) -> Expr<'g> {
        let &Forces { model, kinematics } = self;
        match kind {
            Kind::Supports => supports::dissipation(model, kinematics),
            Kind::BeamSprings => springs::element_dissipation(model),
            Kind::Drives => drives::dissipation(model),
            Kind::JointDampers => springs::joint_dissipation(model),
            Kind::Stops => joints::stop_dissipation(model),
            Kind::Friction => joints::friction_dissipation(model),
            Kind::Loads => model.zero(),
            Kind::Connectors => connectors::dissipation(model, kinematics),
        }
    }

    /// Adds the tangent stiffness of a kind at rest, `∂²E/∂q∂q`, without that of oil, which follows from its volumes.
    fn add_stiffness(&self, kind: Kind, rest: &Rest<'g>, matrix: &mut SymmetricMatrix<'g>) {
        let &Forces { model, kinematics } = self;
        match kind {
            Kind::Supports => supports::stiffness(model, kinematics, matrix),
            Kind::BeamSprings => springs::stiffness(model, matrix),
            Kind::Drives => {
                drives::linear_stiffness(model, matrix);
                drives::limited_stiffness(model, &rest.positions, matrix);
            }
            Kind::Stops => joints::stop_stiffness(model, matrix),
            Kind::Loads => loads::stiffness(model, kinematics, rest.t, matrix),
            Kind::Connectors => connectors::stiffness(model, kinematics, rest.t, matrix),
            Kind::JointDampers | Kind::Friction => {}
        }
    }

    /// Adds the damping of a kind at rest, `−∂f/∂q̇`.
    fn add_damping(&self, kind: Kind, rest: &Rest<'g>, matrix: &mut SymmetricMatrix<'g>) {
        let &Forces { model, kinematics } = self;
        match kind {
            Kind::Supports => supports::damping(model, kinematics, matrix),
            Kind::BeamSprings => springs::element_damping(model, matrix),
            Kind::Drives => {
                drives::linear_damping(model, matrix);
                drives::limited_damping(model, &rest.positions, matrix);
            }
            Kind::JointDampers => springs::joint_damping(model, matrix),
            Kind::Stops => joints::stop_damping(model, matrix),
            Kind::Friction => joints::viscous_damping(model, matrix),
            Kind::Loads => {}
            Kind::Connectors => connectors::damping(model, kinematics, rest.t, matrix),
        }
    }

    /// Adds stiffness and damping of a kind for an implicit step: constants for linear springs and dampers on single coordinates, and for
    /// the base's coordinates values at the present state, which are never negative. A separate function computes those of other laws on
    /// single coordinates, and those of connectors are terms of low rank.
    fn add_step_matrices(&self, kind: Kind, [stiffness, damping]: [&mut SymmetricMatrix<'g>; 2]) {
        let &Forces { model, kinematics } = self;
        match kind {
            Kind::Supports => {
                supports::step_stiffness(model, kinematics, stiffness);
                supports::step_damping(model, kinematics, damping);
            }
            Kind::BeamSprings => {
                springs::stiffness(model, stiffness);
                springs::element_damping(model, damping);
            }
            Kind::Drives => {
                drives::linear_stiffness(model, stiffness);
                drives::linear_damping(model, damping);
            }
            Kind::JointDampers => springs::joint_damping(model, damping),
            Kind::Stops | Kind::Friction | Kind::Loads | Kind::Connectors => {}
        }
    }

    /// Generalized forces of all kinds in motion.
    pub fn all(&self) -> Vec<Expr<'g>> {
        self.sum(|kind| self.in_motion(kind))
    }

    /// Generalized forces of all kinds at rest.
    pub fn all_at_rest(&self, rest: &Rest<'g>) -> Vec<Expr<'g>> {
        self.sum(|kind| self.at_rest(kind, rest))
    }

    fn sum(&self, of: impl Fn(Kind) -> Vec<Expr<'g>>) -> Vec<Expr<'g>> {
        self.kinds().fold(self.model.zeros(), |sum, kind| add(&sum, &of(kind)))
    }

    /// Power that all kinds dissipate.
    pub fn dissipation(&self) -> Expr<'g> {
        self.kinds().fold(self.model.zero(), |sum, kind| sum + self.dissipation_of(kind))
    }

    /// Tangent stiffness of all kinds at rest, without that of oil.
    pub fn stiffness(&self, rest: &Rest<'g>) -> SymmetricMatrix<'g> {
        let mut matrix = SymmetricMatrix::zero(self.model.graph, self.model.size());
        self.kinds().for_each(|kind| self.add_stiffness(kind, rest, &mut matrix));
        matrix
    }

    /// Damping of all kinds at rest.
    pub fn damping(&self, rest: &Rest<'g>) -> SymmetricMatrix<'g> {
        let mut matrix = SymmetricMatrix::zero(self.model.graph, self.model.size());
        self.kinds().for_each(|kind| self.add_damping(kind, rest, &mut matrix));
        matrix
    }

    /// Stiffness and damping of all kinds for an implicit step.
    pub fn step_matrices(&self) -> [SymmetricMatrix<'g>; 2] {
        let mut matrices = [(); 2].map(|()| SymmetricMatrix::zero(self.model.graph, self.model.size()));
        self.kinds().for_each(|kind| self.add_step_matrices(kind, matrices.each_mut()));
        matrices
    }
}

/// The sum of two vectors of generalized forces.
pub fn add<'g>(a: &[Expr<'g>], b: &[Expr<'g>]) -> Vec<Expr<'g>> {
    a.iter().zip(b).map(|(&a, &b)| a + b).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A new kind does not compile here before it has its place in the list.
    #[test]
    fn all_kinds_are_listed() {
        let place = |kind| match kind {
            Kind::Supports => 0,
            Kind::BeamSprings => 1,
            Kind::Drives => 2,
            Kind::JointDampers => 3,
            Kind::Stops => 4,
            Kind::Friction => 5,
            Kind::Loads => 6,
            Kind::Connectors => 7,
        };
        assert!(Kind::ALL.into_iter().map(place).eq(0..8));
    }
}
