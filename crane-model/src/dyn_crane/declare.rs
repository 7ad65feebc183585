//! Declaration of generated cranes.

/// Declares generated cranes: a module for each, from `$OUT_DIR/<name>.rs`, and `all`, a
/// [`DynCrane`](crate::dyn_crane::DynCrane) of each with the parameters of its spec.
///
/// A crate of its own can use it too: its build script writes `<name>.rs` and the crate says
/// `crane_model::cranes! { my_crane }`.
#[macro_export]
macro_rules! cranes {
    ($($name:ident),* $(,)?) => {
        $(
            #[doc = concat!("The crane `", stringify!($name), "`.")]
            // Words of a spec, such as `[A]`, are not links.
            #[allow(clippy::all, clippy::pedantic, rustdoc::broken_intra_doc_links)]
            pub mod $name {
                include!(concat!(env!("OUT_DIR"), "/", stringify!($name), ".rs"));
            }
        )*

        /// All cranes declared here, in order of name, with the parameters of their specs.
        pub fn all() -> Vec<Box<dyn $crate::dyn_crane::DynCrane>> {
            vec![$($crate::dyn_crane::boxed::<{ $name::N }, $name::Crane>()),*]
        }
    };
}
