//! Forces whose law depends on one strain: `f = −Jᵀ F(s, ṡ)`.
//!
//! Where a [compliance c](super::pads::Series) that depends on a coordinate k is in series, `∂E/∂c = −½ F²` with the force F at rest: on k acts
//! `½ F² ∂c/∂q_k`, too, and the stiffness is `∂F/∂s J̃ᵀ J̃ + F ∂²s/∂q∂q − ½ F² ∂²c/∂q∂q` with `J̃ = J − F ∂c/∂q`.

use std::borrow::Cow;
use std::cell::OnceCell;

use super::acts::{Acts, Rest};
use super::kinematics::Kinematics;
use super::laws::{Law, LawState, law};
use super::model::Model;
use super::pads::Series;
use super::strains::Strained;
use super::tangent::Tangent;
use super::vector::SymmetricMatrix;
use crate::chain::{Chain, Force, Group, Sliding};
use crate::symbolic::Expr;

/// The strains of all forces at the present pose, each made when it is first asked for.
pub struct Strains<'g>(Vec<OnceCell<Pose<'g>>>);

/// A strain at the present pose, and what is in series with it.
type Pose<'g> = (Strained<'g>, Option<Series<'g>>);

impl<'g> Strains<'g> {
    pub fn new(chain: &Chain) -> Self {
        Strains(chain.forces.iter().map(|_| OnceCell::new()).collect())
    }

    /// Those of a group.
    fn poses_of_group(&self, chain: &Chain, group: Group) -> &[OnceCell<Pose<'g>>] {
        let (before, count) =
            (chain.forces.partition_point(|force| force.group < group), chain.forces_of_group(group).len());
        &self.0[before..before + count]
    }
}

/// The forces of a group.
pub struct Elements<'a, 'g> {
    model: &'a Model<'g>,
    kinematics: &'a Kinematics<'g>,
    forces: &'a [Force],
    strains: &'a [OnceCell<Pose<'g>>],
}

/// A chain at the present pose.
pub type Posed<'a, 'g> = (&'a Model<'g>, &'a Kinematics<'g>, &'a Strains<'g>);

fn pose<'g>(model: &Model<'g>, kinematics: &Kinematics<'g>, force: &Force) -> Pose<'g> {
    let sliding = force.strain.sliding();
    let series = sliding.and_then(|sliding| Series::new(model, kinematics, sliding));
    let series = match (sliding, force.spring()) {
        (Some(Sliding { exact: true, .. }), Some(spring)) => series.map(|series| series.beyond(model, spring)),
        _ => series,
    };
    (Strained::new(model, kinematics, &force.strain), series)
}

/// A force at the present pose.
pub struct Element<'a, 'g> {
    pub force: &'a Force,
    pub law: &'a dyn Law,
    pub strained: &'a Strained<'g>,
    /// What is in series with it.
    series: Option<Series<'g>>,
}

impl<'g> Element<'_, 'g> {
    fn at<'a>(&self, at: LawState<'a, 'g>) -> LawState<'a, 'g> {
        LawState { series: self.series.map(|series| [series.compliance, series.viscous]), ..at }
    }

    /// F
    pub fn force(&self, at: LawState<'_, 'g>, rate: Expr<'g>) -> Expr<'g> {
        self.law.force(self.at(at), self.strained.length, rate)
    }

    /// `∂F/∂s` and `∂F/∂ṡ`.
    pub fn slopes(&self, at: LawState<'_, 'g>, rate: Expr<'g>) -> [Expr<'g>; 2] {
        self.law.slopes(self.at(at), self.strained.length, rate)
    }

    /// `½ F²`, which acts on a coordinate on which what is in series depends, and slopes of the compliance.
    fn on_series(&self, at: LawState<'_, 'g>) -> Option<(usize, Expr<'g>, [Expr<'g>; 2])> {
        let (coordinate, slopes) = self.series?.by;
        Some((coordinate, 0.5 * self.force(at, at.zero()).squared(), slopes))
    }
}

impl<'a, 'g> Elements<'a, 'g> {
    pub fn new(posed: Posed<'a, 'g>, group: Group) -> Self {
        let (model, kinematics, strains) = posed;
        Elements {
            model,
            kinematics,
            forces: model.chain.forces_of_group(group),
            strains: strains.poses_of_group(model.chain, group),
        }
    }

    /// All of them.
    pub fn all(&self) -> impl Iterator<Item = Element<'a, 'g>> + use<'a, 'g> {
        let &Elements { model, kinematics, forces, strains } = self;
        forces.iter().zip(strains).map(move |(force, kept)| {
            let (strained, series) = kept.get_or_init(|| pose(model, kinematics, force));
            Element { force, law: law(&force.law), strained, series: *series }
        })
    }

    /// Generalized forces.
    fn sum(&self, at: LawState<'_, 'g>, v: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let mut forces = self.model.zeros();
        for element in self.all() {
            let force = element.force(at, element.strained.rate(self.model, v));
            if let Some((k, effort, [slope, _])) = element.on_series(at) {
                forces[k] = forces[k] + effort * slope;
            }
            for &(j, column) in &element.strained.jacobian {
                forces[j] = forces[j] - column * force;
            }
        }
        forces
    }
}

impl<'g> Acts<'g> for Elements<'_, 'g> {
    fn in_motion(&self) -> Vec<Expr<'g>> {
        self.sum(LawState::now(self.model), &self.model.v)
    }

    fn at_rest(&self, rest: &Rest<'g>) -> Vec<Expr<'g>> {
        self.sum(LawState::rest(self.model, rest.t), &self.model.zeros())
    }

    fn energy(&self) -> Option<Expr<'g>> {
        let at = LawState::now(self.model);
        let twice = |element: Element<'_, 'g>| element.law.twice_energy(element.at(at), element.strained.length);
        let sum = self.all().map(twice).fold(self.model.zero(), |sum, twice| sum + twice);
        Some(0.5 * sum).filter(|energy| !energy.is_zero())
    }

    fn dissipation(&self) -> Option<Expr<'g>> {
        let at = LawState::now(self.model);
        let lost = |element: Element<'_, 'g>| {
            let Element { law, strained, .. } = &element;
            law.dissipation(element.at(at), strained.length, strained.rate(self.model, &self.model.v))
        };
        Some(self.all().map(lost).fold(self.model.zero(), |sum, lost| sum + lost))
    }

    /// `∂F/∂s Jᵀ J + F ∂²s/∂q∂q`: the stiffness of the material and, since J depends on the pose, that of the geometry.
    fn add_stiffness(&self, rest: &Rest<'g>, tangent: &mut Tangent<'_, 'g>) {
        let (at, model) = (LawState::rest(self.model, rest.t), self.model);
        for element in self.all() {
            let [stiffness, _] = element.slopes(at, model.zero());
            let tension = element.force(at, model.zero());
            let mut strained = Cow::Borrowed(element.strained);
            if let Some((k, effort, [slope, bend])) = element.on_series(at) {
                tangent.matrix.add(k, k, -effort * bend);
                for (_, column) in strained.to_mut().jacobian.iter_mut().filter(|(j, _)| *j == k) {
                    *column = *column - tension * slope;
                }
            }
            strained.add_tangent((model, self.kinematics), &element.force.strain, [tension, stiffness], tangent);
        }
    }

    fn add_damping(&self, rest: &Rest<'g>, matrix: &mut SymmetricMatrix<'g>) {
        let at = LawState::rest(self.model, rest.t);
        for element in self.all() {
            let Element { law, strained, .. } = &element;
            strained.add_square(law.damping_at_rest(element.at(at), strained.length), matrix);
        }
    }

    /// Those of linear laws on single coordinates.
    fn add_step_matrices(&self, [stiffness, damping]: [&mut SymmetricMatrix<'g>; 2]) {
        let at = LawState::now(self.model);
        let linear = self.all().filter(|Element { force, law, .. }| force.coordinate().is_some() && law.is_linear());
        for element in linear {
            let strained = element.strained;
            let [by_strain, by_rate] = element.slopes(at, strained.rate(self.model, &self.model.v));
            strained.add_square(by_strain, stiffness);
            strained.add_square(by_rate, damping);
        }
    }

    /// Those of other laws on single coordinates.
    fn add_nonlinear(&self, diagonal: &mut [[Expr<'g>; 2]]) {
        let at = LawState::now(self.model);
        for element in self.all() {
            let Element { force, law, strained, .. } = &element;
            let Some(coordinate) = force.coordinate().filter(|_| !law.is_linear()) else { continue };
            let [stiffness, mut damping] = element.slopes(at, strained.rate(self.model, &self.model.v));
            if law.declines() && !damping.is_zero() {
                damping = damping.max(self.model.zero());
            }
            let [of_stiffness, of_damping] = &mut diagonal[coordinate.0];
            (*of_stiffness, *of_damping) = (*of_stiffness + stiffness, *of_damping + damping);
        }
    }
}
