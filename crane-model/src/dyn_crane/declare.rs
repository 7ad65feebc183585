//! Declaration of generated cranes.

/// Declares generated cranes: a module for each, from `$OUT_DIR/<name>.rs`, and a function `all` that returns a
/// [`DynCrane`](crate::dyn_crane::DynCrane) for each, with the parameters of its spec.
///
/// Any crate can use it: its build script writes `<name>.rs`, and the crate contains
/// `crane_model::cranes! { my_crane }`.
#[macro_export]
macro_rules! cranes {
    ($($name:ident),* $(,)?) => {
        $(
            #[doc = concat!("The crane `", stringify!($name), "`.")]
            // Text from a spec, such as `[A]`, is not a link.
            #[allow(clippy::all, clippy::pedantic, rustdoc::broken_intra_doc_links)]
            pub mod $name {
                include!(concat!(env!("OUT_DIR"), "/", stringify!($name), ".rs"));
            }
        )*

        /// All cranes declared here, in the order of declaration, with the parameters of their specs.
        pub fn all() -> Vec<Box<dyn $crate::dyn_crane::DynCrane>> {
            vec![$($crate::dyn_crane::boxed::<{ $name::N }, $name::Crane>()),*]
        }
    };
}
