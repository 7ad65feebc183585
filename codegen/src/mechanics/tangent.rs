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
//!
//! Entries are written out, or left to a loop over pairs: a sum serves all coordinates from where it begins to where the next one does.

use std::collections::BTreeMap;

use super::kinematics::Kinematics;
use super::model::Model;
use super::vector::{SymmetricMatrix, Vec3};
use crate::chain::BodyId;
use crate::program::Shape;
use crate::symbolic::Expr;

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
    columns: Vec<BTreeMap<BodyId, Acting<'g>>>,
}

/// Wrenches that act along a path, by where they end.
#[derive(Clone, Default)]
struct Acting<'g> {
    wrenches: BTreeMap<End, Wrench<'g>>,
    /// Their sum, once known.
    sum: Option<Wrench<'g>>,
}

impl<'g> Acting<'g> {
    fn add(&mut self, end: End, [force, moment]: Wrench<'g>) {
        let added = |[others, moments]: &mut Wrench<'g>| (*others, *moments) = (*others + force, *moments + moment);
        self.wrenches.entry(end).and_modify(added).or_insert([force, moment]);
        self.sum = None;
    }

    fn end_at(&mut self, body: BodyId) {
        if self.wrenches.remove(&Some(body)).is_some() {
            self.sum = None;
        }
    }

    fn sum(&mut self) -> Option<Wrench<'g>> {
        let plus = |[force, moment]: Wrench<'g>, [more, more_moment]: Wrench<'g>| [force + more, moment + more_moment];
        self.sum = self.sum.or_else(|| self.wrenches.values().copied().reduce(plus));
        self.sum
    }
}

impl<'a, 'g> Tangent<'a, 'g> {
    pub fn new(model: &Model<'g>, kinematics: &'a Kinematics<'g>) -> Self {
        let matrix = SymmetricMatrix::zero(model.graph, model.size());
        Tangent { kinematics, matrix, columns: vec![BTreeMap::new(); model.size()] }
    }

    /// Adds to `S_j` a wrench on a body; it counts on the path from there to `end`, that one excluded.
    pub fn add(&mut self, j: usize, [body, end]: [End; 2], wrench: Wrench<'g>) {
        if let Some(body) = body.filter(|_| body != end) {
            self.columns[j].entry(body).or_default().add(end, wrench);
        }
    }

    /// The sum.
    pub fn into_matrix(self, model: &Model<'g>) -> SymmetricMatrix<'g> {
        let Tangent { kinematics, mut matrix, columns } = self;
        meetings(model, kinematics, columns, |j, rows, [force, moment]| {
            for &i in rows {
                let generator = &kinematics.generators[i];
                matrix.add(i, j, generator.omega.dot(moment) + generator.upsilon.dot(force));
            }
        });
        matrix
    }

    /// The factors of the sum, as [`Shape::Tangent`] orders them. In the rows and columns of `prescribed` coordinates, which do not move, it is
    /// zero except for 1 on the diagonal.
    pub fn into_factors(self, model: &Model<'g>, prescribed: &[usize]) -> (Shape, Vec<Expr<'g>>) {
        let Tangent { kinematics, matrix, columns } = self;
        let n = model.size();
        let generators = &kinematics.generators;
        let axes = generators.iter().map(|generator| generator.omega);
        let mut vectors: Vec<Vec3<'g>> = axes.chain(generators.iter().map(|generator| generator.upsilon)).collect();
        let mut segments: Vec<[usize; 3]> = Vec::new();
        // That of the last segment.
        let mut last: Option<Wrench<'g>> = None;
        meetings(model, kinematics, columns, |j, rows, wrench| {
            for &i in rows.iter().rev().filter(|i| ![**i, j].iter().any(|one| prescribed.contains(one))) {
                let is_last = last.is_some_and(|last| is_same(last, wrench));
                match segments.last_mut() {
                    Some([column, first, _]) if is_last && *column == j && *first == i + 1 => *first = i,
                    _ => {
                        segments.push([j, i, i + 1]);
                        let [force, moment] = wrench;
                        vectors.extend([moment, force]);
                        last = Some(wrench);
                    }
                }
            }
        });
        let mut numbers: Vec<Expr<'g>> = vectors.into_iter().flat_map(|vector| vector.0).collect();
        let one = model.graph.constant(1.0);
        let matrix = prescribed.iter().fold(matrix, |matrix, j| matrix.without(*j, one));
        let pairs = (0..n).flat_map(|i| (i..n).map(move |j| [i, j]));
        let entries: Vec<[usize; 2]> = pairs.filter(|[i, j]| !matrix.at(*i, *j).is_zero()).collect();
        numbers.extend(entries.iter().map(|[i, j]| matrix.at(*i, *j)));
        (Shape::Tangent { n, segments, entries }, numbers)
    }
}

/// Visits what columns meet: j, the coordinates i ≤ j of a body, and the sum of `S_j` beyond them; column by column, from the tips to the base.
fn meetings<'g>(
    model: &Model<'g>,
    kinematics: &Kinematics<'g>,
    columns: Vec<BTreeMap<BodyId, Acting<'g>>>,
    mut meet: impl FnMut(usize, &[usize], Wrench<'g>),
) {
    let bodies = &model.chain.bodies;
    let mut own: Vec<Vec<usize>> = vec![Vec::new(); bodies.len()];
    for (i, generator) in kinematics.generators.iter().enumerate() {
        own[generator.body].push(i);
    }
    for (j, mut begun) in columns.into_iter().enumerate() {
        while let Some((BodyId(body), mut acting)) = begun.pop_last() {
            acting.end_at(BodyId(body));
            let Some(sum) = acting.sum() else { continue };
            let rows = &own[body];
            meet(j, &rows[..rows.partition_point(|i| *i <= j)], sum);
            let Some(parent) = bodies[body].parent else { continue };
            match begun.get_mut(&parent) {
                Some(others) => acting.wrenches.into_iter().for_each(|(end, wrench)| others.add(end, wrench)),
                None => drop(begun.insert(parent, acting)),
            }
        }
    }
}

/// Whether two wrenches are the same expressions.
fn is_same(one: Wrench<'_>, other: Wrench<'_>) -> bool {
    let ids = |wrench: Wrench<'_>| wrench.map(|vector| vector.0.map(Expr::id));
    ids(one) == ids(other)
}
