//! A joint that rotates by a rotation vector: `R = exp([ρ]×)`; the components of ρ along the frame's axes are coordinates.
//!
//! Notation
//! : `x = ρ·ρ`; `c_k` Stumpff's functions of x; `f = c_1/(2 c_2)` and `g = (1 − f)/x = (c_3 − 2 c_4)/(2 c_2)`. *Before* and *after*
//!   the joint are the frames on the base's and on the tip's side. `R = c_0 1 + c_1 [ρ]× + c_2 ρρᵀ` transforms components
//!   after the joint to components before it.
//!
//! Output
//! : with `J = c_1 1 + c_2 [ρ]× + c_3 ρρᵀ` the relative angular velocity is `J ρ̇` in components before and `w = Jᵀ ρ̇` after;
//!   `J⁻¹ = f 1 − ½ [ρ]× + g ρρᵀ`. R, J and J⁻¹ are smooth at ρ = 0; J is singular at a rotation of 360°.

use super::model::Model;
use super::vector::{Matrix3, Rotation, Symmetric3, Vec3};
use crate::chain::CoordinateId;
use crate::symbolic::Expr;

/// A rotation vector and the functions of its length.
#[derive(Clone, Copy, Debug)]
pub struct RotationVector<'g> {
    /// For each axis, the index of its coordinate among those of the joint.
    places: [usize; 3],
    rho: Vec3<'g>,
    /// c₀ to c₅
    c: [Expr<'g>; 6],
}

impl<'g> RotationVector<'g> {
    pub fn new(model: &Model<'g>, ids: &[CoordinateId; 3]) -> Self {
        let mut places = [0; 3];
        for (index, id) in ids.iter().enumerate() {
            places[model.chain.coordinates[id.0].axis.index()] = index;
        }
        let rho = Vec3(places.map(|index| model.q[ids[index].0]));
        let x = rho.dot(rho);
        let c = [0, 1, 2, 3, 4, 5].map(|k| x.stumpff(k));
        let name = model.chain.coordinates[ids[0].0].name.rsplit_once('_').map_or("", |(element, _)| element);
        for (k, c) in c.iter().enumerate() {
            model.graph.name(*c, format!("c{k}_{name}"));
        }
        RotationVector { places, rho, c }
    }

    /// Three numbers, one per coordinate, as a vector along the axes.
    pub fn along_axes<T: Copy>(&self, of_coordinates: [T; 3]) -> [T; 3] {
        self.places.map(|index| of_coordinates[index])
    }

    /// The components of a vector, coordinate by coordinate.
    pub fn by_coordinates<T: Copy>(&self, along_axes: [T; 3]) -> [T; 3] {
        let mut numbers = along_axes;
        for (index, number) in self.places.into_iter().zip(along_axes) {
            numbers[index] = number;
        }
        numbers
    }

    fn half(&self) -> Vec3<'g> {
        Vec3(self.rho.0.map(|component| 0.5 * component))
    }

    /// R: the axes of the frame after, in the frame before.
    pub fn rotation(&self) -> Rotation<'g> {
        let [c0, c1, c2, ..] = self.c;
        let Matrix3(rows) = dyadic(self.rho, [c0, c1, c2]);
        Rotation([0, 1, 2].map(|j| Vec3([0, 1, 2].map(|i| rows[i][j]))))
    }

    /// J: column k is the angular velocity at a unit rate of component k, in the frame before.
    pub fn jacobian(&self) -> Matrix3<'g> {
        let [_, c1, c2, c3, ..] = self.c;
        dyadic(self.rho, [c1, c2, c3])
    }

    /// The columns of `dJ/dt` and `d²J/dt²`, from the rates of ρ and their rates: `dc_k/dt = σ d_k` and `d²c_k/dt² = σ̇ d_k + σ² d_k'` with
    /// `σ = ρ·ρ̇`, `d_k = k c_{k+2} − c_{k+1}` and `d_k' = k (k + 2) c_{k+4} − (2k + 1) c_{k+3} + c_{k+2}`.
    pub fn jacobian_rates(&self, rates: Vec3<'g>, seconds: Vec3<'g>) -> [[Vec3<'g>; 3]; 2] {
        let (rho, [_, _, c2, c3, c4, c5]) = (self.rho, self.c);
        let [c6, c7] = [6, 7].map(|k| rho.dot(rho).stumpff(k));
        let (sigma, sigma_rate) = (rho.dot(rates), rates.dot(rates) + rho.dot(seconds));
        let slopes = [c3 - c2, 2.0 * c4 - c3, 3.0 * c5 - c4];
        let curvatures = [3.0 * c5 - 3.0 * c4 + c3, 8.0 * c6 - 5.0 * c5 + c4, 15.0 * c7 - 7.0 * c6 + c5];
        let first = slopes.map(|slope| sigma * slope);
        let square = sigma.squared();
        let second = [0, 1, 2].map(|k| sigma_rate * slopes[k] + square * curvatures[k]);
        let graph = c2.graph();
        let unit = |k: usize| Vec3([0, 1, 2].map(|i| graph.constant(if i == k { 1.0 } else { 0.0 })));
        let of_first = |k: usize| {
            let own = first[0] * unit(k) + first[1] * rho.cross(unit(k)) + (first[2] * rho[k]) * rho;
            own + c2 * rates.cross(unit(k)) + c3 * (rates[k] * rho + rho[k] * rates)
        };
        let of_second = |k: usize| {
            let own = second[0] * unit(k) + second[1] * rho.cross(unit(k)) + (second[2] * rho[k]) * rho;
            let mixed = first[1] * rates.cross(unit(k)) + first[2] * (rates[k] * rho + rho[k] * rates);
            let last = c2 * seconds.cross(unit(k)) + c3 * (seconds[k] * rho + rho[k] * seconds);
            own + mixed + mixed + last + (2.0 * c3 * rates[k]) * rates
        };
        [[0, 1, 2].map(of_first), [0, 1, 2].map(of_second)]
    }

    /// f and g.
    fn inverse_functions(&self) -> [Expr<'g>; 2] {
        let [_, c1, c2, c3, c4, _] = self.c;
        let half_over = 0.5 / c2;
        [c1 * half_over, (c3 - 2.0 * c4) * half_over]
    }

    /// `Jᵀ y`
    pub fn project(&self, y: Vec3<'g>) -> Vec3<'g> {
        let [_, c1, c2, c3, ..] = self.c;
        c1 * y - (c2 * self.rho).cross(y) + (c3 * self.rho.dot(y)) * self.rho
    }

    /// `w = Jᵀ ρ̇`: the relative angular velocity, in the frame after.
    pub fn spin(&self, rates: Vec3<'g>) -> Vec3<'g> {
        self.project(rates)
    }

    /// `dJᵀ/dt ρ̇`, the part of `ẇ` that depends only on rates:
    /// `σ (2c_3 − c_2) ρ̇ + σ (c_3 − 2c_4) ρ × ρ̇ + (c_3 ρ̇·ρ̇ + σ² (3c_5 − c_4)) ρ` with `σ = ρ·ρ̇`.
    pub fn spin_rate(&self, rates: Vec3<'g>) -> Vec3<'g> {
        let [_, _, c2, c3, c4, c5] = self.c;
        let sigma = self.rho.dot(rates);
        let along = c3 * rates.dot(rates) + sigma.squared() * (3.0 * c5 - c4);
        (sigma * (2.0 * c3 - c2)) * rates + (sigma * (c3 - 2.0 * c4)) * self.rho.cross(rates) + along * self.rho
    }

    /// The moment n of efforts τ on the three coordinates, in components before and after:
    /// `J⁻ᵀ τ` and `J⁻¹ τ`, which differ in the sign of one product.
    pub fn moments(&self, efforts: Vec3<'g>) -> [Vec3<'g>; 2] {
        let [f, g] = self.inverse_functions();
        let even = f * efforts + (g * self.rho.dot(efforts)) * self.rho;
        let odd = self.half().cross(efforts);
        [even + odd, even - odd]
    }

    /// `J⁻ᵀ D̂ J⁻¹`, in components after the joint: the effect of added inertias D̂ of the coordinates on the relative angular
    /// acceleration.
    pub fn added_inertia(&self, added_inertias: Vec3<'g>) -> Symmetric3<'g> {
        let [f, g] = self.inverse_functions();
        // ρ̈ = M w with M = J⁻ᵀ.
        let inverse = dyadic(self.rho, [f, self.rho[0].graph().constant(0.5), g]);
        let scaled = [0, 1, 2].map(|k| added_inertias[k] * inverse.row(k));
        Symmetric3::from_entries(|i, j| {
            scaled[0][i] * inverse.0[0][j] + scaled[1][i] * inverse.0[1][j] + scaled[2][i] * inverse.0[2][j]
        })
    }

    /// ρ̈ from the relative angular acceleration Jᵀ ρ̈, at rest.
    pub fn accelerations_at_rest(&self, relative: Vec3<'g>) -> Vec3<'g> {
        let [before, _] = self.moments(relative);
        before
    }

    /// ρ̈ from the angular accelerations before and after, each in components of its own frame, with the terms of the rates:
    /// `J⁻ᵀ (α' − ω' × w) − J⁻¹ α + 2gσ ρ̇ − (c_3 (ρ̇·ρ̇ + 2gσ²) + (3c_5 − c_4) σ²) ρ`.
    ///
    /// `ρ̇ = J⁻ᵀ w` with `J⁻ᵀ = J⁻¹ R`, so α is never transformed to the frame after. The terms in σ are `−J⁻ᵀ dJᵀ/dt ρ̇`, in which
    /// the part along `ρ × ρ̇` cancels.
    pub fn accelerations(&self, before: Vec3<'g>, after: Vec3<'g>, gyration: Vec3<'g>, rates: Vec3<'g>) -> Vec3<'g> {
        let [_, _, _, c3, c4, c5] = self.c;
        let [f, g] = self.inverse_functions();
        let own = after - gyration;
        let (difference, sum) = (own - before, own + before);
        let sigma = self.rho.dot(rates);
        let twice = (2.0 * g) * sigma;
        let along = c3 * (rates.dot(rates) + twice * sigma) + (3.0 * c5 - c4) * sigma.squared();
        f * difference + self.half().cross(sum) + twice * rates + (g * self.rho.dot(difference) - along) * self.rho
    }

    /// `∂(J e_n)/∂ρ_m − (J e_m) × (J e_n)`, in the frame before: the term of the second derivative with respect to two components in addition to the
    /// product of their generators, `∂²R/∂ρ_m∂ρ_n = Ω_m Ω_n R + [·]× R`.
    pub fn curvature(&self, (m, n): (usize, usize)) -> Vec3<'g> {
        let [_, _, c2, c3, c4, c5] = self.c;
        let graph = c2.graph();
        let unit = |k: usize| Vec3([0, 1, 2].map(|i| graph.constant(if i == k { 1.0 } else { 0.0 })));
        let jacobian = self.jacobian();
        let direct = (c3 - c2) * unit(n)
            + (2.0 * c4 - c3) * self.rho.cross(unit(n))
            + ((3.0 * c5 - c4) * self.rho[n]) * self.rho;
        let mut derivative = self.rho[m] * direct + c2 * unit(m).cross(unit(n)) + (c3 * self.rho[n]) * unit(m);
        if m == n {
            derivative = derivative + c3 * self.rho;
        }
        derivative - jacobian.column(m).cross(jacobian.column(n))
    }

    /// Its scalar product with t, a vector in the frame before: `t · (∂(J e_n)/∂ρ_m − J e_m × J e_n)`, with
    /// `J e_m × J e_n = 2c_2 J⁻ᵀ (e_m × e_n)`.
    pub fn curvature_along(&self, t: Vec3<'g>, (m, n): (usize, usize)) -> Expr<'g> {
        let [_, c1, c2, c3, c4, c5] = self.c;
        let rho = self.rho;
        let (along, across) = (rho.dot(t), t.cross(rho));
        let direct = (c3 - c2) * t + (2.0 * c4 - c3) * across + ((3.0 * c5 - c4) * along) * rho;
        let even = rho[m] * direct[n] + c3 * (rho[n] * t[m]);
        if m == n {
            return even + c3 * along;
        }
        let k = 3 - m - n;
        // e_m × e_n = ±e_k
        let odd = (c2 - c1) * t[k] - (c2 * across[k] + ((c3 - 2.0 * c4) * along) * rho[k]);
        if (m + 1) % 3 == n { even + odd } else { even - odd }
    }

    /// Rates whose angular velocity before the joint is y: `J⁻¹ y`.
    pub fn rates_of(&self, before: Vec3<'g>) -> Vec3<'g> {
        let [_, rates] = self.moments(before);
        rates
    }
}

/// `a 1 + b [ρ]× + c ρρᵀ`
fn dyadic<'g>(rho: Vec3<'g>, [a, b, c]: [Expr<'g>; 3]) -> Matrix3<'g> {
    let (scaled, odd) = (c * rho, Matrix3::cross(b * rho));
    Matrix3([0, 1, 2].map(|i| {
        [0, 1, 2].map(|j| {
            let (low, high) = (i.min(j), i.max(j));
            let even = scaled[low] * rho[high];
            if i == j { a + even } else { even + odd.0[i][j] }
        })
    }))
}
