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
    /// The same crane on slices, for statics.
    fn for_statics(self) -> CraneRef<'a>;

    /// The same crane on slices, for motion.
    fn for_dynamics(self) -> CraneRef<'a>;
}

/// Cranes with `N` coordinates in their type.
#[derive(Clone, Copy, Debug)]
pub struct OfSize<const N: usize>;

/// Cranes of any size.
#[derive(Clone, Copy, Debug)]
pub struct AnySize;

impl<'a, const N: usize, C: CraneModel<N>> AnyCrane<'a, OfSize<N>> for &'a C {
    fn for_statics(self) -> CraneRef<'a> {
        const {
            assert!(Part::Statics.is_in(C::PARTS), "the crane has no statics: add `statics` to `analyses` of its spec");
        }
        CraneRef::Instance(Box::new(Instance::<N, _>(self.clone())))
    }

    fn for_dynamics(self) -> CraneRef<'a> {
        const {
            assert!(
                Part::Dynamics.is_in(C::PARTS),
                "the crane has no dynamics: add `dynamics` to `analyses` of its spec"
            );
        }
        CraneRef::Instance(Box::new(Instance::<N, _>(self.clone())))
    }
}

macro_rules! any_size {
    ($crane:ty $(, $bound:tt: $of:ident)?) => {
        impl<'a $(, $bound: $of)?> AnyCrane<'a, AnySize> for $crane {
            fn for_statics(self) -> CraneRef<'a> {
                CraneRef::Slices(self)
            }

            fn for_dynamics(self) -> CraneRef<'a> {
                CraneRef::Slices(self)
            }
        }
    };
}

any_size! { &'a C, C: DynCrane }
any_size! { &'a (dyn DynCrane + 'a) }
