//! A crane of any kind, as solvers receive it.

use std::ops::Deref;

use crane_quantities::Part;

use super::{DynCrane, Instance};
use crate::CraneModel;

/// A crane on slices: a reference to one, or an [`Instance`] of a crane of a size in its type.
pub enum CraneRef<'a> {
    /// A crane of any size.
    Slices(&'a dyn DynCrane),
    /// A crane of a size in its type.
    Instance(Box<dyn DynCrane>),
}

impl<'a> Deref for CraneRef<'a> {
    type Target = dyn DynCrane + 'a;

    fn deref(&self) -> &Self::Target {
        match self {
            Self::Slices(crane) => *crane,
            Self::Instance(crane) => &**crane,
        }
    }
}

/// References to cranes that solvers take: those of a size in their type, `&knuckle_boom::Crane`, and those of any size, `&LiveCrane` and `&dyn DynCrane`.
/// `Size` is [`OfSize`] or [`AnySize`], and is inferred.
///
/// With a crane of a size in its type, a solver whose part the spec's `analyses` left out does not compile.
pub trait AnyCrane<'a, Size> {
    /// The parts that it is known to have where the solver is compiled; all of a crane of any size, which says itself.
    const PARTS: &'static [Part];

    /// The same crane on slices.
    fn on_slices(self) -> CraneRef<'a>;
}

/// Cranes with `N` coordinates in their type.
#[derive(Clone, Copy, Debug)]
pub struct OfSize<const N: usize>;

/// Cranes of any size.
#[derive(Clone, Copy, Debug)]
pub struct AnySize;

impl<'a, const N: usize, C: CraneModel<N>> AnyCrane<'a, OfSize<N>> for &'a C {
    const PARTS: &'static [Part] = C::PARTS;

    fn on_slices(self) -> CraneRef<'a> {
        CraneRef::Instance(Box::new(Instance::<N, _>(self.clone())))
    }
}

impl<'a, C: DynCrane> AnyCrane<'a, AnySize> for &'a C {
    const PARTS: &'static [Part] = &Part::ALL;

    fn on_slices(self) -> CraneRef<'a> {
        CraneRef::Slices(self)
    }
}

impl<'a> AnyCrane<'a, AnySize> for &'a (dyn DynCrane + 'a) {
    const PARTS: &'static [Part] = &Part::ALL;

    fn on_slices(self) -> CraneRef<'a> {
        CraneRef::Slices(self)
    }
}
