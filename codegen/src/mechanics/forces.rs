//! Everything that acts on the chain besides inertia and gravity, as one list.
//!
//! Whatever sums over all forces goes through [`Forces`]. Most kinds are groups of [`elements`](super::elements), laws of one strain each;
//! supports have a law of three strains, drives have motions, and loads have no strain.

use super::acts::{Acts, Rest, add};
use super::drives::{self, Drives};
use super::elements::{Elements, Posed};
use super::loads::Loads;
use super::model::Model;
use super::supports::Supports;
use super::tangent::Tangent;
use super::vector::SymmetricMatrix;
use crate::chain::{Chain, Group};
use crate::symbolic::Expr;

/// A kind of force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Springs and dampers between the base and the ground; strains: displacements of the feet.
    Supports,
    /// Springs and dampers between driven coordinates and their motions.
    Drives,
    /// Forces and moments applied from outside.
    Loads,
    /// Laws of one strain.
    Of(Group),
}

impl Kind {
    /// All kinds, in the order in which their forces are added.
    pub const ALL: [Kind; 8] = [
        Kind::Supports,
        Kind::Of(Group::Elements),
        Kind::Drives,
        Kind::Of(Group::JointDampers),
        Kind::Of(Group::Stops),
        Kind::Of(Group::Friction),
        Kind::Loads,
        Kind::Of(Group::Connectors),
    ];

    /// Whether a chain has forces of this kind.
    pub fn is_in(self, chain: &Chain) -> bool {
        match self {
            Kind::Supports => !chain.supports.is_empty(),
            Kind::Drives => !chain.drives.is_empty(),
            Kind::Loads => !chain.loads.is_empty(),
            Kind::Of(group) => !chain.forces_of_group(group).is_empty(),
        }
    }
}

/// The crane at rest at t = 0, with the drives where their motions start.
pub fn rest_at_start<'g>(model: &Model<'g>) -> Rest<'g> {
    Rest { t: model.zero(), positions: drives::positions(model, model.zero()) }
}

/// The forces of a chain, except those of rigid drives, which have no law: they follow from the motion.
pub struct Forces<'a, 'g> {
    posed: Posed<'a, 'g>,
}

impl<'a, 'g> Forces<'a, 'g> {
    pub fn new(posed: Posed<'a, 'g>) -> Self {
        Forces { posed }
    }

    fn model(&self) -> &'a Model<'g> {
        self.posed.0
    }

    /// The kinds that the chain has.
    pub fn kinds(&self) -> impl Iterator<Item = Kind> {
        let chain = self.model().chain;
        Kind::ALL.into_iter().filter(|kind| kind.is_in(chain))
    }

    /// The forces of a kind.
    pub fn forces_of_kind(&self, kind: Kind) -> Box<dyn Acts<'g> + 'a> {
        let (model, kinematics, _) = self.posed;
        match kind {
            Kind::Supports => Box::new(Supports { model, kinematics }),
            Kind::Drives => Box::new(Drives { model }),
            Kind::Loads => Box::new(Loads { model, kinematics }),
            Kind::Of(group) => Box::new(Elements::new(self.posed, group)),
        }
    }

    fn each(&self) -> impl Iterator<Item = Box<dyn Acts<'g> + 'a>> {
        self.kinds().map(|kind| self.forces_of_kind(kind))
    }

    /// Generalized forces of all kinds in motion.
    pub fn all(&self) -> Vec<Expr<'g>> {
        self.each().fold(self.model().zeros(), |sum, forces| add(&sum, &forces.in_motion()))
    }

    /// Generalized forces of all kinds at rest.
    pub fn all_at_rest(&self, rest: &Rest<'g>) -> Vec<Expr<'g>> {
        self.each().fold(self.model().zeros(), |sum, forces| add(&sum, &forces.at_rest(rest)))
    }

    /// Power that all kinds dissipate.
    pub fn dissipation(&self) -> Expr<'g> {
        self.each().filter_map(|forces| forces.dissipation()).fold(self.model().zero(), |sum, power| sum + power)
    }

    /// Adds the tangent stiffness of all kinds at rest, without that of oil.
    pub fn add_stiffness(&self, rest: &Rest<'g>, tangent: &mut Tangent<'_, 'g>) {
        self.each().for_each(|forces| forces.add_stiffness(rest, tangent));
    }

    /// Damping of all kinds at rest.
    pub fn damping(&self, rest: &Rest<'g>) -> SymmetricMatrix<'g> {
        let mut matrix = self.zero_matrix();
        self.each().for_each(|forces| forces.add_damping(rest, &mut matrix));
        matrix
    }

    /// Stiffness and damping of all kinds for an implicit step, without those of [`nonlinear`](Self::nonlinear), and without those of
    /// connectors, which are terms of low rank.
    pub fn step_matrices(&self) -> [SymmetricMatrix<'g>; 2] {
        let mut matrices = [self.zero_matrix(), self.zero_matrix()];
        self.each().for_each(|forces| forces.add_step_matrices(matrices.each_mut()));
        matrices
    }

    /// `∂F/∂q_j` and `∂F/∂q̇_j` of nonlinear laws on each coordinate at the present state, for implicit steps.
    pub fn nonlinear(&self) -> Vec<[Expr<'g>; 2]> {
        let mut diagonal = vec![[self.model().zero(); 2]; self.model().size()];
        self.each().for_each(|forces| forces.add_nonlinear(&mut diagonal));
        diagonal
    }

    fn zero_matrix(&self) -> SymmetricMatrix<'g> {
        SymmetricMatrix::zero(self.model().graph, self.model().size())
    }
}
