//! Elementary rotations of frames, applied as plane rotations, which avoids 3×3 products with known zeros.
//!
//! A rotation is `R = R_axis(angle)`, from the inner frame (towards the tip) to the outer one (towards the base).
//! `to_inner` is `x ↦ Rᵀ x`, from base to tip; `to_outer` is `x ↦ R x`, `S ↦ R S Rᵀ`, from tip to base.

use super::vector::{Matrix3, Symmetric3, Vec3, plane};
use crate::chain::Axis;
use crate::symbolic::Expr;

/// An elementary rotation by its sine and cosine.
#[derive(Clone, Copy, Debug)]
pub struct AxisRotation<'g> {
    pub axis: Axis,
    pub sin: Expr<'g>,
    pub cos: Expr<'g>,
}

impl<'g> AxisRotation<'g> {
    /// `Rᵀ x`
    pub fn to_inner(self, x: Vec3<'g>) -> Vec3<'g> {
        let (a, b) = plane(self.axis);
        let mut rotated = x;
        rotated.0[a] = self.cos * x[a] + self.sin * x[b];
        rotated.0[b] = self.cos * x[b] - self.sin * x[a];
        rotated
    }

    /// `R x`
    pub fn to_outer(self, x: Vec3<'g>) -> Vec3<'g> {
        AxisRotation { sin: -self.sin, ..self }.to_inner(x)
    }

    /// `R S Rᵀ`
    ///
    /// In the plane of rotation, `w` is subtracted from `S_aa` and added to `S_bb`, so that entries of very different size keep
    /// their digits as the angle goes to zero.
    pub fn to_outer_symmetric(self, s: &Symmetric3<'g>) -> Symmetric3<'g> {
        let (a, b) = plane(self.axis);
        let k = self.axis.index();
        let mut rotated = *s;
        let (difference, twice) = (s.at(a, a) - s.at(b, b), s.at(a, b) + s.at(a, b));
        let (w, t) = self.exchange(difference, twice);
        *rotated.at_mut(a, a) = self.diagonal(s.at(a, a), s.at(b, b), -w);
        *rotated.at_mut(b, b) = self.diagonal(s.at(b, b), s.at(a, a), w);
        *rotated.at_mut(a, b) = self.off_diagonal(s.at(a, b), -s.at(a, b), t);
        *rotated.at_mut(k, a) = self.cos * s.at(k, a) - self.sin * s.at(k, b);
        *rotated.at_mut(k, b) = self.sin * s.at(k, a) + self.cos * s.at(k, b);
        rotated
    }

    /// `R M Rᵀ`
    pub fn to_outer_matrix(self, m: &Matrix3<'g>) -> Matrix3<'g> {
        let (a, b) = plane(self.axis);
        let k = self.axis.index();
        let m = m.0;
        let mut rotated = m;
        let (w, t) = self.exchange(m[a][a] - m[b][b], m[a][b] + m[b][a]);
        rotated[a][a] = self.diagonal(m[a][a], m[b][b], -w);
        rotated[b][b] = self.diagonal(m[b][b], m[a][a], w);
        rotated[a][b] = self.off_diagonal(m[a][b], -m[b][a], t);
        rotated[b][a] = self.off_diagonal(m[b][a], -m[a][b], t);
        rotated[k][a] = self.cos * m[k][a] - self.sin * m[k][b];
        rotated[k][b] = self.sin * m[k][a] + self.cos * m[k][b];
        rotated[a][k] = self.cos * m[a][k] - self.sin * m[b][k];
        rotated[b][k] = self.sin * m[a][k] + self.cos * m[b][k];
        Matrix3(rotated)
    }

    /// The amounts that a rotation moves between the entries of a 2×2 block `[[p, q], [r, s]]`, from `p − s` and `q + r`:
    /// `w = sin² (p − s) + sin cos (q + r)` and `t = sin cos (p − s) − sin² (q + r)`.
    fn exchange(&self, difference: Expr<'g>, sum: Expr<'g>) -> (Expr<'g>, Expr<'g>) {
        let (squared, product) = (self.sin * self.sin, self.sin * self.cos);
        (squared * difference + product * sum, product * difference - squared * sum)
    }

    /// `own + change`, or the other's value if the rotation swaps the two.
    fn diagonal(&self, own: Expr<'g>, other: Expr<'g>, change: Expr<'g>) -> Expr<'g> {
        if self.is_quarter() { other } else { own + change }
    }

    /// `own + change`, or the result of a quarter turn.
    fn off_diagonal(&self, own: Expr<'g>, swapped: Expr<'g>, change: Expr<'g>) -> Expr<'g> {
        if self.is_quarter() { swapped } else { own + change }
    }

    /// Whether it is a quarter turn by construction: axes are renamed, nothing is computed.
    fn is_quarter(&self) -> bool {
        self.cos.is_zero()
    }
}
