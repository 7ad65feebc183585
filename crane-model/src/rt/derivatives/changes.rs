//! What changes of coordinates and of their rates do to accelerations.
//!
//! While coordinates hold, a change of `q_j` accelerates everything beyond by `Ω̈_j` and requires a wrench there; one of `q̇_j` by `2 Ω̇_j`. What is beyond
//! gives way: by its articulated instead of its composite inertia, and to the rates `2 ω̇_j` or `2 ω_j`, to which each coordinate k beyond has one answer for
//! all j, the solution of an inward sweep for `z_k`. So ∂r is not needed, and its product with A⁻¹ neither: entry k of a column of `−A⁻¹ ∂r` is the product
//! of the wrench with the acceleration that a unit force at k causes at j; for k beyond j also that of the acceleration and the rates with the wrench
//! and the answers that this force brings to j. The sweeps for A⁻¹ know both.

use super::columns::{Carried, Columns, Constant};
use super::vectors::{cross_subtract, three};
use crate::rt::fused::fma;

/// Columns of what arrives where changes give way: linear and angular accelerations, and angular rates.
pub const COLUMNS: usize = 9;

/// Moment and force, angular and linear acceleration, and twice the angular rates, of a change of one coordinate and of its rate. Once what is
/// beyond gives way, the opposite of each.
#[derive(Clone, Copy)]
pub struct Changes<C: Columns> {
    pub(super) of: [[C::Number; 15]; 2],
    /// The coordinate's point.
    pub(super) point: [C::Number; 3],
}

impl<C: Columns> Changes<C> {
    /// All zero.
    pub fn zero() -> Self {
        let zero = C::Number::constant(0.0);
        Changes { of: [[zero; 15]; 2], point: [zero; 3] }
    }

    /// From the world's origin to the point; `carried`: what arrives there for unit accelerations and rates.
    #[inline(always)]
    pub(super) fn give_way(&mut self, carried: &[Carried<C>]) {
        /// Places of the accelerations and rates, in the order of the columns.
        const PLACES: [usize; COLUMNS] = [9, 10, 11, 6, 7, 8, 12, 13, 14];
        let mut wrenches = [[C::zero(); 6]; 2];
        for which in 0..2 {
            let (of, units) = (&self.of[which], &mut wrenches[which]);
            for state in 0..C::STATES {
                let number = |first: usize| three!(|k| C::lane(&of[first + k], state));
                let m = cross_subtract(three!(|k| C::lane(&self.point[k], state)), number(3), number(0));
                for k in 0..3 {
                    units[k].as_mut()[state] = m[k];
                    units[3 + k].as_mut()[state] = C::lane(&of[3 + k], state);
                }
            }
        }
        for column in 0..COLUMNS {
            let Some([a, b, c, d, e, f, ..]) = carried.get(column / C::WIDTH) else { break };
            let (arriving, index) = ([a, b, c, d, e, f], PLACES[column]);
            let by = [self.of[0][index], self.of[1][index]];
            for state in 0..C::STATES {
                for k in 0..6 {
                    let of = arriving[k].as_ref()[column % C::WIDTH + state];
                    for which in 0..2 {
                        let sum = &mut wrenches[which][k].as_mut()[state];
                        *sum = fma(-C::lane(&by[which], state), of, *sum);
                    }
                }
            }
        }
        for which in 0..2 {
            let (of, mut units) = (&mut self.of[which], [C::zero(); 15]);
            for state in 0..C::STATES {
                let number = |first: usize| three!(|k| C::lane(&of[first + k], state));
                let l = cross_subtract(three!(|k| C::lane(&self.point[k], state)), number(6), number(9));
                for k in 0..6 {
                    units[k].as_mut()[state] = -wrenches[which][k].as_ref()[state];
                }
                for k in 0..3 {
                    units[6 + k].as_mut()[state] = -C::lane(&of[6 + k], state);
                    units[9 + k].as_mut()[state] = -l[k];
                    units[12 + k].as_mut()[state] = -C::lane(&of[12 + k], state);
                }
            }
            for index in 0..15 {
                of[index] = C::number(&units[index], 0);
            }
        }
    }
}
