//! The tangent stiffness of forces at points, in a few operations per entry however many forces there are.
//!
//! A force at a point of a body is a wrench, and `f_i = Ω_i · Σ W` over the bodies beyond coordinate i. A coordinate j that is not before i leaves `Ω_i`
//! as it is, so that
//!
//! ```text
//! K_ij = −∂f_i/∂q_j = Ω_i · Σ S_j      S_j = −∂W/∂q_j, over the bodies beyond i;  i ≤ j
//! ```
//!
//! A column is what a motion of j changes, a few wrenches on bodies, summed along the tree; it meets each `Ω_i` once. What acts between two bodies
//! changes nothing before the body from which both are reached: its wrenches end there.

use std::collections::BTreeMap;

use super::kinematics::Kinematics;
use super::model::Model;
use super::vector::{SymmetricMatrix, Vec3};
use crate::chain::BodyId;

/// Force, and moment about the world's origin.
type Wrench<'g> = [Vec3<'g>; 2];

/// Where wrenches end: at a body, or at the world.
type End = Option<BodyId>;

/// A tangent stiffness that is being summed.
pub struct Tangent<'a, 'g> {
    kinematics: &'a Kinematics<'g>,
    /// What is not given by wrenches.
    pub matrix: SymmetricMatrix<'g>,
    /// `S_j` by the bodies on which they begin.
    columns: Vec<BTreeMap<BodyId, BTreeMap<End, Wrench<'g>>>>,
}

impl<'a, 'g> Tangent<'a, 'g> {
    pub fn new(model: &Model<'g>, kinematics: &'a Kinematics<'g>) -> Self {
        let matrix = SymmetricMatrix::zero(model.graph, model.size());
        Tangent { kinematics, matrix, columns: vec![BTreeMap::new(); model.size()] }
    }

    /// Adds to `S_j` a wrench on a body; it counts on the path from there to `end`, that one excluded.
    pub fn add(&mut self, j: usize, [body, end]: [End; 2], wrench: Wrench<'g>) {
        if let Some(body) = body.filter(|_| body != end) {
            add(self.columns[j].entry(body).or_default(), end, wrench);
        }
    }

    /// The sum.
    pub fn into_matrix(self, model: &Model<'g>) -> SymmetricMatrix<'g> {
        let Tangent { kinematics, mut matrix, columns } = self;
        let bodies = &model.chain.bodies;
        let mut own: Vec<Vec<usize>> = vec![Vec::new(); bodies.len()];
        for (i, generator) in kinematics.generators.iter().enumerate() {
            own[generator.body].push(i);
        }
        for (j, mut begun) in columns.into_iter().enumerate() {
            while let Some((BodyId(body), mut wrenches)) = begun.pop_last() {
                wrenches.remove(&Some(BodyId(body)));
                let sum = wrenches.values().copied().reduce(plus);
                if let Some([force, moment]) = sum {
                    for &i in own[body].iter().filter(|i| **i <= j) {
                        let generator = &kinematics.generators[i];
                        matrix.add(i, j, generator.omega.dot(moment) + generator.upsilon.dot(force));
                    }
                }
                if let Some(parent) = bodies[body].parent {
                    let passed = begun.entry(parent).or_default();
                    for (end, wrench) in wrenches {
                        add(passed, end, wrench);
                    }
                }
            }
        }
        matrix
    }
}

fn add<'g>(wrenches: &mut BTreeMap<End, Wrench<'g>>, end: End, wrench: Wrench<'g>) {
    wrenches.entry(end).and_modify(|others| *others = plus(*others, wrench)).or_insert(wrench);
}

fn plus<'g>([force, moment]: Wrench<'g>, [more, more_moment]: Wrench<'g>) -> Wrench<'g> {
    [force + more, moment + more_moment]
}
