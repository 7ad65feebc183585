//! What is attached to what: the tree of a chain's bodies.
//!
//! A body is moved by the coordinates of the joints on its path to the world. Without branches these are the first ones of q.

use super::{BodyId, Chain, CoordinateId, Step};

impl Chain {
    /// The bodies on the path from the world to a body: each is attached to the previous one, and the body itself is the last.
    #[must_use]
    pub fn path(&self, body: BodyId) -> Vec<BodyId> {
        let mut path: Vec<BodyId> =
            std::iter::successors(Some(body), |BodyId(index)| self.bodies.get(*index)?.parent).collect();
        path.reverse();
        path
    }

    /// The last body that carries both of two, or is one of them; `None` for the world.
    #[must_use]
    pub fn meeting(&self, bodies: [Option<BodyId>; 2]) -> Option<BodyId> {
        let [one, other] = bodies.map(|body| body.map_or_else(Vec::new, |body| self.path(body)));
        one.into_iter().zip(other).take_while(|(one, other)| one == other).last().map(|(body, _)| body)
    }

    /// The coordinates that move a body, in the order of q.
    #[must_use]
    pub fn coordinates_of(&self, body: BodyId) -> Vec<CoordinateId> {
        let path = self.path(body);
        path.iter().flat_map(|BodyId(index)| self.own_coordinates(*index)).collect()
    }

    /// The coordinates of the joint of a body.
    pub fn own_coordinates(&self, body: usize) -> impl Iterator<Item = CoordinateId> {
        self.bodies.get(body).into_iter().flat_map(|body| &body.path).flat_map(Step::coordinates).copied()
    }

    /// A range of coordinates that contains all of these: the first and one past the last.
    #[must_use]
    pub fn range(coordinates: &[CoordinateId]) -> [usize; 2] {
        let ends = coordinates.first().zip(coordinates.last());
        ends.map_or([0, 0], |(CoordinateId(first), CoordinateId(last))| [*first, last + 1])
    }

    /// The coordinates that are in some of these lists but not in all, in the order of q.
    pub(super) fn between(&self, lists: &[Vec<CoordinateId>]) -> Vec<CoordinateId> {
        let mut counts = vec![0; self.coordinates.len()];
        for CoordinateId(coordinate) in lists.iter().flatten() {
            counts[*coordinate] += 1;
        }
        let some = |(_, count): &(usize, usize)| (1..lists.len()).contains(count);
        counts.into_iter().enumerate().filter(some).map(|(coordinate, _)| CoordinateId(coordinate)).collect()
    }

    /// The coordinate before each one on its path to the world; `None` for the first on a path.
    #[must_use]
    pub fn coordinates_before(&self) -> Vec<Option<CoordinateId>> {
        let mut before = vec![None; self.coordinates.len()];
        // The last coordinate that moves each body.
        let mut last: Vec<Option<CoordinateId>> = Vec::with_capacity(self.bodies.len());
        for (index, body) in self.bodies.iter().enumerate() {
            let mut reached = body.parent.and_then(|BodyId(parent)| last[parent]);
            for id in self.own_coordinates(index) {
                before[id.0] = reached.replace(id);
            }
            last.push(reached);
        }
        before
    }

    /// Number of coordinates that move a body: `n_dof(p)`, Eq. (2).
    #[must_use]
    pub fn degrees_of_freedom(&self, body: BodyId) -> usize {
        self.coordinates_of(body).len()
    }

    /// Whether a coordinate moves a body.
    #[must_use]
    pub fn moves(&self, CoordinateId(coordinate): CoordinateId, body: BodyId) -> bool {
        self.is_beyond(body, self.coordinates[coordinate].body)
    }

    /// Whether a body is another one or beyond it.
    #[must_use]
    pub fn is_beyond(&self, body: BodyId, other: BodyId) -> bool {
        // A body comes after its parent.
        let mut path = std::iter::successors(Some(body), |BodyId(index)| self.bodies[*index].parent);
        path.find(|place| *place <= other) == Some(other)
    }

    /// All bodies, each followed by everything beyond it.
    #[must_use]
    pub fn depth_first(&self) -> Vec<BodyId> {
        let mut children: Vec<Vec<BodyId>> = vec![Vec::new(); self.bodies.len()];
        for (index, body) in self.bodies.iter().enumerate().rev() {
            if let Some(BodyId(parent)) = body.parent {
                children[parent].push(BodyId(index));
            }
        }
        let mut stack: Vec<BodyId> = (0..self.bodies.len().min(1)).map(BodyId).collect();
        let mut order = Vec::new();
        while let Some(body) = stack.pop() {
            order.push(body);
            stack.extend(&children[body.0]);
        }
        order
    }

    /// Whether a body begins a branch: it is not attached to the end of the body before it.
    #[must_use]
    pub fn begins_branch(&self, BodyId(index): BodyId) -> bool {
        index.checked_sub(1).is_some_and(|before| {
            let body = &self.bodies[index];
            body.parent != Some(BodyId(before)) || body.along != self.bodies[before].length
        })
    }

    /// Whether some body is not attached to the previous one.
    #[must_use]
    pub fn has_branches(&self) -> bool {
        let before = (0..self.bodies.len()).map(|index| index.checked_sub(1).map(BodyId));
        self.bodies.iter().map(|body| body.parent).ne(before)
    }
}
