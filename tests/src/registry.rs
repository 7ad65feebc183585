//! All generated cranes of the tests: the shipped ones and random ones.

use std::path::PathBuf;

use crane_model::dyn_crane::DynCrane;
use crane_model::{CraneModel, Description};

use crate::quantities::{self, State};

/// A generated crane.
#[derive(Clone, Copy)]
pub struct Entry {
    /// Name of the crane.
    pub name: &'static str,
    /// Whether its spec is random.
    pub random: bool,
    /// Names, units and settings.
    pub description: &'static Description,
    /// All quantities at a state, with the given parameters.
    pub evaluate: fn(&State, &[f64]) -> Vec<f64>,
    /// The crane behind one pointer, with the parameters of its spec.
    pub crane: fn() -> Box<dyn DynCrane>,
}

impl Entry {
    /// Its YAML file.
    #[must_use]
    pub fn spec(&self) -> PathBuf {
        let folder = if self.random { PathBuf::from(env!("OUT_DIR")) } else { crate::workspace::root().join("specs") };
        folder.join(format!("{}.yaml", self.name))
    }
}

/// A crane with these parameters.
fn with_parameters<const N: usize, C: CraneModel<N> + Default>(parameters: &[f64]) -> C {
    let mut crane = C::default();
    crane.set_parameters(parameters).unwrap_or_else(|refused| panic!("{refused}"));
    crane
}

macro_rules! entry {
    ($module:path, $name:ident, $random:literal) => {{
        use $module as module;
        Entry {
            name: stringify!($name),
            random: $random,
            description: &module::DESCRIPTION,
            evaluate: |state, parameters| {
                let crane: module::Crane = with_parameters::<{ module::N }, _>(parameters);
                quantities::evaluate::<{ module::N }, _>(&crane, state)
            },
            crane: || crane_model::dyn_crane::boxed::<{ module::N }, module::Crane>(),
        }
    }};
}

macro_rules! registry {
    (shipped: [$($shipped:ident),*], random: [$($random:ident),*]) => {
        /// Random cranes, compiled by the build script. Clippy and rustdoc take minutes over generated code, and have nothing to say.
        #[cfg(not(any(clippy, doc)))]
        pub mod random {
            $(
                #[doc = concat!("The crane `", stringify!($random), "`.")]
                #[allow(clippy::all, clippy::pedantic)]
                pub mod $random {
                    include!(concat!(env!("OUT_DIR"), "/", stringify!($random), ".rs"));
                }
            )*
        }

        /// All generated cranes: the shipped ones, then the random ones.
        #[must_use]
        pub fn all() -> Vec<Entry> {
            let shipped = [$(entry!(crane_shipped::$shipped, $shipped, false)),*];
            #[cfg(any(clippy, doc))]
            let random = [];
            #[cfg(not(any(clippy, doc)))]
            let random = [$(entry!(self::random::$random, $random, true)),*];
            shipped.into_iter().chain(random).collect()
        }
    };
}

include!(concat!(env!("OUT_DIR"), "/registry.rs"));
