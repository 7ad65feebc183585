//! What the bodies of a crane are attached to.

use std::ops::Range;

use super::Description;

/// The tree of a crane's bodies: what each is attached to, and which coordinates move it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tree {
    parents: Vec<Option<usize>>,
    own: Vec<Range<usize>>,
}

impl Tree {
    /// The tree of a crane with these `parents`: for each body after the first, the index of the one that carries it. Without them, each body
    /// is attached to the previous one.
    pub fn new(description: &Description, parents: &[usize]) -> Self {
        let count = description.bodies.len();
        let carrier = |before: usize| parents.get(before).copied().unwrap_or(before);
        let parents: Vec<Option<usize>> = (0..count).map(|body| body.checked_sub(1).map(carrier)).collect();
        let degrees = |body: usize| description.bodies[body].degrees_of_freedom;
        let mut end = 0;
        let own = parents.iter().enumerate().map(|(body, parent)| {
            let first = end;
            end += degrees(body) - parent.map_or(0, degrees);
            first..end
        });
        Tree { own: own.collect(), parents }
    }

    /// The body to which another one is attached; `None` for the first, which is attached to the world.
    pub fn parent(&self, body: usize) -> Option<usize> {
        self.parents[body]
    }

    /// What each body is attached to.
    pub fn parents(&self) -> &[Option<usize>] {
        &self.parents
    }

    /// The coordinates of a body's joint.
    pub fn own(&self, body: usize) -> Range<usize> {
        self.own[body].clone()
    }

    /// The coordinates that move a body, in the order of `q`: those of the joints on its path to the world.
    pub fn coordinates(&self, body: usize) -> Vec<usize> {
        let path = std::iter::successors(Some(body), |&body| self.parents[body]);
        let mut coordinates: Vec<usize> = path.flat_map(|body| self.own(body).rev()).collect();
        coordinates.reverse();
        coordinates
    }

    /// Whether some body is not attached to the previous one.
    pub fn has_branches(&self) -> bool {
        self.parents.iter().enumerate().any(|(body, parent)| *parent != body.checked_sub(1))
    }
}
