//! The reference crane with several numbers of sections, compiled by the build script.

use crane_model::dynamics::Method;

use crate::kernel::Kernel;
use crate::runs::{self, Plan};
use crate::{kernels, states};

/// A crane and its kernels to be timed.
pub struct Entry {
    /// How many coordinates it has.
    pub coordinates: usize,
    /// Its YAML text.
    pub spec: &'static str,
    /// Its kernels.
    pub kernels: fn() -> Vec<Kernel>,
    /// The start and the times of its run.
    pub plan: fn() -> Plan,
    /// Its [`run`](runs::run).
    pub run: fn(Method, f64, usize) -> Result<Vec<f64>, String>,
    /// Its states as records `t, q, v, f`, `f` being the generalized forces.
    pub records: fn() -> Vec<f64>,
}

impl Entry {
    /// The kernel with this name.
    #[must_use]
    pub fn kernel(&self, name: &str) -> Option<Kernel> {
        (self.kernels)().into_iter().find(|kernel| kernel.name == name)
    }
}

/// The crane with this many coordinates.
#[must_use]
pub fn find(coordinates: usize) -> Option<Entry> {
    all().into_iter().find(|entry| entry.coordinates == coordinates)
}

macro_rules! cranes {
    (small: [$($small:ident),*], large: [$($large:ident),*]) => {
        $(module!($small);)*
        $(module!($large);)*

        /// The cranes, from the smallest to the largest.
        #[must_use]
        pub fn all() -> Vec<Entry> {
            vec![$(entry!($small, all_of_small),)* $(entry!($large, all)),*]
        }
    };
}

macro_rules! module {
    ($name:ident) => {
        #[doc = concat!("The crane `", stringify!($name), "`.")]
        #[allow(clippy::all, clippy::pedantic, rustdoc::broken_intra_doc_links)]
        pub mod $name {
            include!(concat!(env!("OUT_DIR"), "/", stringify!($name), ".rs"));
        }
    };
}

macro_rules! entry {
    ($name:ident, $kernels:ident) => {{
        const SPEC: &str = include_str!(concat!(env!("OUT_DIR"), "/", stringify!($name), ".yaml"));
        Entry {
            coordinates: $name::N,
            spec: SPEC,
            kernels: || kernels::$kernels::<{ $name::N }, $name::Crane>(SPEC),
            plan: || runs::plan(&$name::Crane::default()),
            run: runs::run::<{ $name::N }, $name::Crane>,
            records: || states::records::<{ $name::N }, $name::Crane>(),
        }
    }};
}

include!(concat!(env!("OUT_DIR"), "/cranes.rs"));
