//! Any crane without rustc: the interpreter of the compiler behind the traits of a generated crane.
//!
//! Slower than compiled code by a factor of ten, and ready at once: for many cranes that are each used little.

mod crane;
mod describe;
mod routine;

use crane_codegen::chain::Chain;

use crane::Interpreted;
use crane_model::dyn_crane::{DynCrane, Instance};

macro_rules! sizes {
    ($($size:literal)*) => {
        /// The crane of a chain; `None` unless its number of coordinates is one of those that are listed here.
        pub fn interpret(chain: &Chain) -> Option<Box<dyn DynCrane>> {
            match chain.coordinates.len() {
                $($size => Some(Box::new(Instance(Box::new(Interpreted::<$size>::new(chain))))),)*
                _ => None,
            }
        }
    };
}

sizes! { 1 2 3 4 6 12 13 16 24 25 61 150 }
