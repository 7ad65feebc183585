//! Vectors of three, and of an angular and a linear part.

#![expect(clippy::inline_always, reason = "inlined where wider vectors are known, loops use them")]

use super::columns::Scalar;
use crate::rt::fused::fma;

/// Three numbers by their index. A function of an array is not always inlined.
macro_rules! three {
    (|$k:ident| $number:expr) => {
        [
            {
                let $k = 0;
                $number
            },
            {
                let $k = 1;
                $number
            },
            {
                let $k = 2;
                $number
            },
        ]
    };
}
pub(super) use three;

pub(super) type Three<L> = [L; 3];

/// A wrench or an acceleration: the part about the point, and the linear part.
pub(super) type Six<L> = [Three<L>; 2];

/// `a · b + c`
#[inline(always)]
pub(super) fn dot_add<L: Scalar>(a: Three<L>, b: Three<L>, c: L) -> L {
    fma(a[0], b[0], fma(a[1], b[1], fma(a[2], b[2], c)))
}

/// `a · b`
#[inline(always)]
pub(super) fn dot<L: Scalar>(a: Three<L>, b: Three<L>) -> L {
    fma(a[0], b[0], fma(a[1], b[1], a[2] * b[2]))
}

/// `a s + b`
#[inline(always)]
pub(super) fn scaled_add<L: Scalar>(a: Three<L>, s: L, b: Three<L>) -> Three<L> {
    [fma(a[0], s, b[0]), fma(a[1], s, b[1]), fma(a[2], s, b[2])]
}

/// `d × b + c`
#[inline(always)]
pub(super) fn cross_add<L: Scalar>(d: Three<L>, b: Three<L>, c: Three<L>) -> Three<L> {
    [
        fma(d[1], b[2], fma(-d[2], b[1], c[0])),
        fma(d[2], b[0], fma(-d[0], b[2], c[1])),
        fma(d[0], b[1], fma(-d[1], b[0], c[2])),
    ]
}

/// `c − d × b`
#[inline(always)]
pub(super) fn cross_subtract<L: Scalar>(d: Three<L>, b: Three<L>, c: Three<L>) -> Three<L> {
    cross_add([-d[0], -d[1], -d[2]], b, c)
}

/// `[V, Ω] + c` of angular and linear parts.
#[inline(always)]
pub(super) fn commutator_add<L: Scalar>(v: Six<L>, of: Six<L>, c: Six<L>) -> Six<L> {
    let linear = cross_add(v[1], of[0], c[1]);
    [cross_add(v[0], of[0], c[0]), cross_add(v[0], of[1], linear)]
}

#[inline(always)]
pub(super) fn plus<L: Scalar>(a: Three<L>, b: Three<L>) -> Three<L> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}
