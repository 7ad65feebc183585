//! A crane of any kind, as what takes cranes on slices receives it.

use std::ops::Deref;

use super::{DynCrane, DynDynamics, DynImplicit, DynStatics, Instance};
use crate::{Dynamics, Implicit, Statics};

/// A crane on slices, `D`: a reference to one, or an [`Instance`] that has a reference to a crane of a size in its type.
pub enum CraneRef<'a, D: ?Sized> {
    /// A crane of any size.
    Slices(&'a D),
    /// A crane of a size in its type.
    Instance(Box<D>),
}

impl<D: ?Sized> Deref for CraneRef<'_, D> {
    type Target = D;

    fn deref(&self) -> &D {
        match self {
            Self::Slices(crane) => crane,
            Self::Instance(crane) => crane,
        }
    }
}

/// References to cranes that solvers take: those of a size in their type, `&knuckle_boom::Crane`, and those of any size, `&LiveCrane` and `&dyn DynCrane`.
/// `D` is the trait of cranes on slices that a solver needs. `Size` is [`OfSize`] or [`AnySize`], and is inferred.
pub trait AnyCrane<'a, D: ?Sized, Size> {
    /// The same crane on slices.
    fn on_slices(self) -> CraneRef<'a, D>;
}

/// Cranes with `N` coordinates in their type.
#[derive(Clone, Copy, Debug)]
pub struct OfSize<const N: usize>;

/// Cranes of any size.
#[derive(Clone, Copy, Debug)]
pub struct AnySize;

macro_rules! any_crane {
    ($($slices:ident of $sized:ident),*) => { $(
        impl<'a, const N: usize, C: $sized<N>> AnyCrane<'a, dyn $slices + 'a, OfSize<N>> for &'a C {
            fn on_slices(self) -> CraneRef<'a, dyn $slices + 'a> {
                CraneRef::Instance(Box::new(Instance::<N, _>(self)))
            }
        }

        any_crane! { $slices by &'a C, C: $slices }
        any_crane! { $slices by &'a (dyn $slices + 'a), }
        any_crane! { $slices by &'a (dyn DynCrane + 'a), }
    )* };
    ($slices:ident by $crane:ty, $($bound:tt)*) => {
        impl<'a, $($bound)*> AnyCrane<'a, dyn $slices + 'a, AnySize> for $crane {
            fn on_slices(self) -> CraneRef<'a, dyn $slices + 'a> {
                CraneRef::Slices(self)
            }
        }
    };
}

any_crane! { DynStatics of Statics, DynDynamics of Dynamics, DynImplicit of Implicit }
