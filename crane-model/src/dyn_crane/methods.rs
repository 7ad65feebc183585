//! Methods of cranes on slices, and of [`Instance`](super::Instance), from the table of quantities.

/// The methods of a crane on slices.
macro_rules! slice_methods {
    ($($part:ident { $(
        $(#[doc = $remark:literal])*
        $id:ident = $name:ident($($argument:ident),*) -> $result:tt $rule:ident $doc:literal $equation:literal
        $(python($($python:tt)*))?;
    )* })*) => {
        $($(slice_method! {
            $result [
                #[allow(clippy::doc_markdown, reason = "names of symbols, as in generated code")]
                #[doc = $doc]
                #[doc = concat!("\n`", $equation, "`")]
            ] $name($($argument),*)
        })*)*
    };
}

/// A method of a crane on slices.
macro_rules! slice_method {
    (other $($row:tt)*) => {};
    ([$item:ident; $count:ident] [$($about:tt)*] $name:ident($($argument:ident),*)) => {
        $($about)*
        #[doc = concat!("\n`out`: one ", stringify!($item), " for each of the crane's ", stringify!($count), ".")]
        fn $name(&self, $($argument: slice_argument!($argument),)* out: &mut [entry_type!($item)]);
    };
    (number [$($about:tt)*] $name:ident($($argument:ident),*)) => {
        $($about)*
        fn $name(&self, $($argument: slice_argument!($argument)),*) -> f64;
    };
    (base [$($about:tt)*] $name:ident($($argument:ident),*)) => {
        $($about)*
        #[doc = "\n`out`: 36 numbers, column by column."]
        fn $name(&self, $($argument: slice_argument!($argument),)* out: &mut [f64]);
    };
    ($numbers:ident [$($about:tt)*] $name:ident($($argument:ident),*)) => {
        $($about)*
        fn $name(&self, $($argument: slice_argument!($argument),)* out: &mut [f64]);
    };
}

/// The methods of an instance, which call those of the crane with the size in its type.
macro_rules! instance_methods {
    ($($part:ident { $(
        $(#[doc = $remark:literal])*
        $id:ident = $name:ident($($argument:ident),*) -> $result:tt $rule:ident $doc:literal $equation:literal
        $(python($($python:tt)*))?;
    )* })*) => {
        $($(instance_method! { $result $name($($argument),*) })*)*
    };
}

/// An argument for the crane with the size in its type.
macro_rules! sized {
    (t $t:ident) => {
        $t
    };
    ($kind:ident $slice:ident) => {
        &vector($slice)
    };
}

/// A method of an instance.
macro_rules! instance_method {
    (other $($row:tt)*) => {};
    ([row; $count:ident] $name:ident($($argument:ident),*)) => {
        fn $name(&self, $($argument: slice_argument!($argument),)* out: &mut [f64]) {
            self.0.$name($(sized!($argument $argument),)* out.as_chunks_mut().0);
        }
    };
    ([$item:ident; $count:ident] $name:ident($($argument:ident),*)) => {
        fn $name(&self, $($argument: slice_argument!($argument),)* out: &mut [entry_type!($item)]) {
            self.0.$name($(sized!($argument $argument),)* out);
        }
    };
    (number $name:ident($($argument:ident),*)) => {
        fn $name(&self, $($argument: slice_argument!($argument)),*) -> f64 {
            self.0.$name($(sized!($argument $argument)),*)
        }
    };
    (matrix $name:ident($($argument:ident),*)) => {
        fn $name(&self, $($argument: slice_argument!($argument),)* out: &mut [f64]) {
            // Matrices without rows have no size to cast to.
            for out in bytemuck::try_cast_slice_mut::<f64, SMatrix<f64, N, N>>(out).into_iter().flatten() {
                self.0.$name($(sized!($argument $argument),)* out);
            }
        }
    };
    ($numbers:ident $name:ident($($argument:ident),*)) => {
        fn $name(&self, $($argument: slice_argument!($argument),)* out: &mut [f64]) {
            out.copy_from_slice(self.0.$name($(sized!($argument $argument)),*).as_slice());
        }
    };
}

pub(super) use {instance_method, instance_methods, sized, slice_method, slice_methods};
