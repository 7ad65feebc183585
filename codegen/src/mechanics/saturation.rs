//! The effort of a drive with a limit: linear well below it, constant beyond it, and a parabola between.
//!
//! Notation
//! : u the effort of spring and damper without the limit M; `a = (1 − κ) M` where the parabola begins, `b = (1 + κ) M` where it ends,
//!   κM half its width. With `r = min(max(0, |u| − a), 2κM)` and `o = max(0, |u| − b)`:
//!
//! ```text
//! sat(u) = sign(u) (|u| − r²/(4κM) − o)        ∫ sat du = u²/2 − r³/(12κM) − o²/2 − κM o
//! ```

use crate::symbolic::Expr;

/// κ: up to this fraction below the limit, the effort is exactly that of spring and damper.
const CORNER: f64 = 0.05;

/// A limited effort.
pub struct Saturation<'g> {
    /// |u|
    size: Expr<'g>,
    /// u
    effort: Expr<'g>,
    /// r
    corner: Expr<'g>,
    /// o
    beyond: Expr<'g>,
    /// κM
    half: Expr<'g>,
}

impl<'g> Saturation<'g> {
    /// The saturation of the effort u with the limit M.
    pub fn new(effort: Expr<'g>, limit: Expr<'g>) -> Self {
        let zero = limit.graph().constant(0.0);
        let size = effort.max(-effort);
        let half = CORNER * limit;
        Saturation {
            size,
            effort,
            corner: (size - (limit - half)).clamp(zero, 2.0 * half),
            beyond: (size - (limit + half)).max(zero),
            half,
        }
    }

    /// `sat(u)`
    pub fn effort(&self) -> Expr<'g> {
        let size = self.size - self.corner.squared() / (4.0 * self.half) - self.beyond;
        self.effort.select(size, -size)
    }

    /// `∫ sat du` from 0.
    pub fn integral(&self) -> Expr<'g> {
        let corner = self.corner.squared() * self.corner / (12.0 * self.half);
        0.5 * self.effort.squared() - corner - (0.5 * self.beyond + self.half) * self.beyond
    }

    /// `dsat/du`, from 1 down to 0.
    pub fn slope(&self) -> Expr<'g> {
        1.0 - self.corner / (2.0 * self.half)
    }
}
