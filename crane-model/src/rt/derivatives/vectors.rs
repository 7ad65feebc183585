//! Vectors of three, and of an angular and a linear part, in several columns.

use super::columns::{Columns, Constant};
use crate::rt::fused::fma;

#[inline]
pub(super) fn zero<C: Columns>() -> C::Number {
    C::Number::constant(0.0)
}

#[inline]
pub(super) fn one<C: Columns>() -> C::Number {
    C::Number::constant(1.0)
}

pub(super) type Three<C> = [<C as Columns>::Block; 3];

/// A wrench or an acceleration: the part about the point, and the linear part.
pub(super) type Six<C> = [Three<C>; 2];

/// `a · b + c`
#[inline]
pub(super) fn dot_add<C: Columns>(a: Three<C>, b: Three<C>, c: C::Block) -> C::Block {
    fma(a[0], b[0], fma(a[1], b[1], fma(a[2], b[2], c)))
}

/// `a · b`
#[inline]
pub(super) fn dot<C: Columns>(a: Three<C>, b: Three<C>) -> C::Block {
    fma(a[0], b[0], fma(a[1], b[1], a[2] * b[2]))
}

/// `a s + b`
#[inline]
pub(super) fn scaled_add<C: Columns>(a: Three<C>, s: C::Block, b: Three<C>) -> Three<C> {
    [fma(a[0], s, b[0]), fma(a[1], s, b[1]), fma(a[2], s, b[2])]
}

/// `d × b + c`, with d and −d
#[inline]
pub(super) fn cross_add<C: Columns>([d, minus]: [Three<C>; 2], b: Three<C>, c: Three<C>) -> Three<C> {
    [
        fma(d[1], b[2], fma(minus[2], b[1], c[0])),
        fma(d[2], b[0], fma(minus[0], b[2], c[1])),
        fma(d[0], b[1], fma(minus[1], b[0], c[2])),
    ]
}

/// A vector and the opposite one.
#[inline]
pub(super) fn both<C: Columns>(d: Three<C>) -> [Three<C>; 2] {
    [d, [-d[0], -d[1], -d[2]]]
}

/// `[V, Ω] + c` of angular and linear parts.
#[inline]
pub(super) fn commutator_add<C: Columns>(v: Six<C>, of: Six<C>, c: Six<C>) -> Six<C> {
    let omega = both::<C>(v[0]);
    let linear = cross_add::<C>(both::<C>(v[1]), of[0], c[1]);
    [cross_add::<C>(omega, of[0], c[0]), cross_add::<C>(omega, of[1], linear)]
}

#[inline]
pub(super) fn nothing<C: Columns>() -> Six<C> {
    [[C::splat(zero::<C>()); 3]; 2]
}

#[inline]
pub(super) fn plus<C: Columns>(a: Three<C>, b: Three<C>) -> Three<C> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}
