//! Methods of a crane, from the table of quantities.

use crane_quantities::Part;

/// What a function returns that a crane of these parts does not have: 0 where it lacks such a component, NaN if its parts do not contain it.
pub const fn absent(part: Part, parts: &[Part]) -> f64 {
    if part.is_in(parts) { 0.0 } else { f64::NAN }
}

/// Type of an argument of the trait with the number of coordinates `N` in its type.
macro_rules! sized_argument {
    (t) => { f64 };
    ($vector:ident) => { &SVector<f64, N> };
}

/// Type of a result of that trait.
macro_rules! sized_result {
    (number) => { f64 };
    (vector) => { SVector<f64, N> };
    (base) => { SMatrix<f64, 6, 6> };
}

/// Type of an entry of a list of that trait.
macro_rules! sized_entry {
    (row) => {
        [f64; N]
    };
    ($item:ident) => {
        $crate::entry_type!($item)
    };
}

/// A method of that trait. What a crane without the function returns is [`absent`].
macro_rules! sized_method {
    ($part:ident $rule:ident other $($row:tt)*) => {};
    ($part:ident written $result:tt $($row:tt)*) => {};
    (Common required [$item:ident; $count:ident] [$($about:tt)*] $name:ident($($argument:ident),*)) => {
        $($about)*
        #[doc = concat!("\n`out`: one ", stringify!($item), " for each of the crane's ", stringify!($count), ".")]
        fn $name(&self, $($argument: sized_argument!($argument),)* out: &mut [sized_entry!($item)]);
    };
    (Common required $result:ident [$($about:tt)*] $name:ident($($argument:ident),*)) => {
        $($about)*
        fn $name(&self, $($argument: sized_argument!($argument)),*) -> sized_result!($result);
    };
    ($part:ident $rule:ident [$item:ident; $count:ident] [$($about:tt)*] $name:ident($($argument:ident),*)) => {
        $($about)*
        #[doc = concat!("\n`out`: one ", stringify!($item), " for each of the crane's ", stringify!($count), ".")]
        #[allow(unused_variables, reason = "a crane without the function needs no arguments")]
        fn $name(&self, $($argument: sized_argument!($argument),)* out: &mut [sized_entry!($item)]) {
            cast_slice_mut::<_, f64>(out).fill(const { absent(Part::$part, Self::PARTS) });
        }
    };
    ($part:ident $rule:ident matrix [$($about:tt)*] $name:ident($($argument:ident),*)) => {
        $($about)*
        #[doc = "\n`out`: the whole matrix, whatever it was before."]
        #[allow(unused_variables, reason = "a crane without the function needs no arguments")]
        fn $name(&self, $($argument: sized_argument!($argument),)* out: &mut SMatrix<f64, N, N>) {
            out.fill(const { absent(Part::$part, Self::PARTS) });
        }
    };
    ($part:ident $rule:ident number [$($about:tt)*] $name:ident($($argument:ident),*)) => {
        $($about)*
        #[allow(unused_variables, reason = "a crane without the function needs no arguments")]
        fn $name(&self, $($argument: sized_argument!($argument)),*) -> f64 {
            const { absent(Part::$part, Self::PARTS) }
        }
    };
    ($part:ident $rule:ident $result:ident [$($about:tt)*] $name:ident($($argument:ident),*)) => {
        $($about)*
        #[allow(unused_variables, reason = "a crane without the function needs no arguments")]
        fn $name(&self, $($argument: sized_argument!($argument)),*) -> sized_result!($result) {
            <sized_result!($result)>::repeat(const { absent(Part::$part, Self::PARTS) })
        }
    };
}

/// The methods of that trait.
macro_rules! sized_methods {
    ($($part:ident { $(
        $(#[doc = $remark:literal])*
        $id:ident = $name:ident($($argument:ident),*) -> $result:tt $rule:ident $doc:literal $equation:literal
        $(python($($python:tt)*))?;
    )* })*) => {
        $($(sized_method! {
            $part $rule $result [
                #[allow(clippy::doc_markdown, reason = "names of symbols, as in generated code")]
                #[doc = $doc] #[doc = concat!("\n`", $equation, "`\n")] $(#[doc = $remark])*]
            $name($($argument),*)
        })*)*
    };
}

pub(crate) use {sized_argument, sized_entry, sized_method, sized_methods, sized_result};

/// Type of an entry of a list of results.
#[doc(hidden)]
#[macro_export]
macro_rules! entry_type {
    (vector) => { $crate::nalgebra::Vector3<f64> };
    (pair) => { [f64; 2] };
    (tension) => { $crate::Tension };
    (wrench) => { $crate::Wrench };
    (moduli) => { $crate::SectionModuli };
    (transform) => { $crate::nalgebra::Matrix4<f64> };
    // Row by row.
    (row) => { f64 };
}

/// Type of an argument of the trait on slices.
#[doc(hidden)]
#[macro_export]
macro_rules! slice_argument {
    (t) => {
        f64
    };
    ($vector:ident) => {
        &[f64]
    };
}
