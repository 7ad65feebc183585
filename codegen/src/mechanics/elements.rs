//! Forces whose law depends on one strain: `f = −Jᵀ F(s, ṡ)`.

use super::acts::{Acts, Rest};
use super::kinematics::Kinematics;
use super::laws::{At, Law, law};
use super::model::Model;
use super::strains::Strained;
use super::tangent::Tangent;
use super::vector::SymmetricMatrix;
use crate::chain::{Force, Group};
use crate::symbolic::Expr;

/// The forces of a group.
pub struct Elements<'a, 'g> {
    model: &'a Model<'g>,
    kinematics: &'a Kinematics<'g>,
    forces: &'a [Force],
}

/// A force at the present pose.
pub struct Element<'a, 'g> {
    pub force: &'a Force,
    pub law: &'a dyn Law,
    pub strained: Strained<'g>,
}

impl<'a, 'g> Elements<'a, 'g> {
    pub fn new(model: &'a Model<'g>, kinematics: &'a Kinematics<'g>, group: Group) -> Self {
        Elements { model, kinematics, forces: model.chain.of(group) }
    }

    /// All of them.
    pub fn all(&self) -> impl Iterator<Item = Element<'a, 'g>> + use<'a, 'g> {
        let &Elements { model, kinematics, forces } = self;
        forces.iter().map(move |force| {
            let strained = Strained::new(model, kinematics, &force.strain);
            Element { force, law: law(&force.law), strained }
        })
    }

    /// Generalized forces.
    fn sum(&self, at: At<'_, 'g>, v: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let mut forces = self.model.zeros();
        for Element { law, strained, .. } in self.all() {
            let force = law.force(at, strained.length, strained.rate(self.model, v));
            for (j, column) in strained.jacobian {
                forces[j] = forces[j] - column * force;
            }
        }
        forces
    }
}

impl<'g> Acts<'g> for Elements<'_, 'g> {
    fn in_motion(&self) -> Vec<Expr<'g>> {
        self.sum(At::now(self.model), &self.model.v)
    }

    fn at_rest(&self, rest: &Rest<'g>) -> Vec<Expr<'g>> {
        self.sum(At::rest(self.model, rest.t), &self.model.zeros())
    }

    fn energy(&self) -> Option<Expr<'g>> {
        let at = At::now(self.model);
        let sum = |sum, Element { law, strained, .. }: Element<'_, 'g>| sum + law.twice_energy(at, strained.length);
        Some(0.5 * self.all().fold(self.model.zero(), sum)).filter(|energy| !energy.is_zero())
    }

    fn dissipation(&self) -> Option<Expr<'g>> {
        let at = At::now(self.model);
        Some(self.all().fold(self.model.zero(), |sum, Element { law, strained, .. }| {
            sum + law.dissipation(at, strained.length, strained.rate(self.model, &self.model.v))
        }))
    }

    /// `∂F/∂s Jᵀ J + F ∂²s/∂q∂q`: the stiffness of the material and, since J depends on the pose, that of the geometry.
    fn add_stiffness(&self, rest: &Rest<'g>, tangent: &mut Tangent<'_, 'g>) {
        let (at, model) = (At::rest(self.model, rest.t), self.model);
        for Element { force, law, strained } in self.all() {
            let [stiffness, _] = law.slopes(at, strained.length, model.zero());
            let tension = law.force(at, strained.length, model.zero());
            strained.add_tangent((model, self.kinematics), &force.strain, [tension, stiffness], tangent);
        }
    }

    fn add_damping(&self, rest: &Rest<'g>, matrix: &mut SymmetricMatrix<'g>) {
        let at = At::rest(self.model, rest.t);
        for Element { law, strained, .. } in self.all() {
            strained.add_square(law.damping_at_rest(at, strained.length), matrix);
        }
    }

    /// Those of linear laws on single coordinates.
    fn add_step_matrices(&self, [stiffness, damping]: [&mut SymmetricMatrix<'g>; 2]) {
        let at = At::now(self.model);
        let linear = self.all().filter(|Element { force, law, .. }| force.coordinate().is_some() && law.is_linear());
        for Element { law, strained, .. } in linear {
            let [by_strain, by_rate] = law.slopes(at, strained.length, strained.rate(self.model, &self.model.v));
            strained.add_square(by_strain, stiffness);
            strained.add_square(by_rate, damping);
        }
    }

    /// Those of other laws on single coordinates.
    fn add_nonlinear(&self, diagonal: &mut [[Expr<'g>; 2]]) {
        let at = At::now(self.model);
        for Element { force, law, strained } in self.all() {
            let Some(coordinate) = force.coordinate().filter(|_| !law.is_linear()) else { continue };
            let [stiffness, mut damping] = law.slopes(at, strained.length, strained.rate(self.model, &self.model.v));
            if law.declines() && !damping.is_zero() {
                damping = damping.max(self.model.zero());
            }
            let [of_stiffness, of_damping] = &mut diagonal[coordinate.0];
            (*of_stiffness, *of_damping) = (*of_stiffness + stiffness, *of_damping + damping);
        }
    }
}
