//! Whether everything that is drawn hangs together.

use nalgebra::Vector3;

use super::{Figure, Shape};

/// Places on a surface, and its planes: a place of each and its normal.
type Solid = (Vec<Vector3<f64>>, Vec<(Vector3<f64>, Vector3<f64>)>);

impl Figure {
    /// A corner of each shape that floats, m: from shape to shape, whatever is drawn hangs together with the rest. A corner, the middle of a triangle or
    /// of all corners of one lies in the other, which is convex but for hooks and bent beams; to a thousandth of the crane's size.
    #[must_use]
    pub fn floating(&self) -> Vec<Vector3<f64>> {
        let near = 1e-3 * self.all_corners().iter().map(nalgebra::Matrix::norm).fold(1.0, f64::max);
        let holds = |(_, planes): &Solid, (places, _): &Solid| {
            places.iter().any(|position| planes.iter().all(|(on, normal)| (position - on).dot(normal) < near))
        };
        let mut left: Vec<Solid> = self.shapes.iter().map(|shape| self.solid(shape)).collect();
        let mut reached: Vec<Solid> = left.pop().into_iter().collect();
        while let Some(next) =
            left.iter().position(|one| reached.iter().any(|other| holds(one, other) || holds(other, one)))
        {
            reached.push(left.swap_remove(next));
        }
        left.iter().map(|(places, _)| places[0]).collect()
    }

    fn solid(&self, shape: &Shape) -> Solid {
        let corners = self.corners(shape);
        let triangles: Vec<[Vector3<f64>; 3]> =
            shape.mesh.triangles.iter().map(|triangle| triangle.map(|corner| corners[corner])).collect();
        let middles = triangles.iter().map(|[a, b, c]| (a + b + c) / 3.0);
        let middle = corners.iter().sum::<Vector3<f64>>() / corners.len() as f64;
        let places = corners.iter().copied().chain(middles).chain([middle]).collect();
        let planes = triangles.iter().filter_map(|[a, b, c]| Some((*a, (b - a).cross(&(c - a)).try_normalize(0.0)?)));
        (places, planes.collect())
    }
}
