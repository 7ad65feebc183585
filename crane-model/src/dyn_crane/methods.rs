//! Methods of cranes on slices, and of [`Instance`](super::Instance), from the table of quantities.

/// The methods of a crane on slices.
macro_rules! slice_methods {
    ($($part:ident { $(
        $(#[doc = $remark:literal])*
        $id:ident = $name:ident($($argument:ident),*) -> $result:tt $rule:ident $doc:literal $equation:literal
        $(python($($python:tt)*))?;
    )* })*) => {
        $($(slice_method! {
            $id $result [
                #[allow(clippy::doc_markdown, reason = "names of symbols, as in generated code")]
                #[doc = $doc]
                #[doc = concat!("\n`", $equation, "`")]
            ] $name($($argument),*)
        })*)*
    };
}

/// A method of a crane on slices.
macro_rules! slice_method {
    ($id:ident other $($row:tt)*) => {};
    ($id:ident number [$($about:tt)*] $name:ident($($argument:ident),*)) => {
        $($about)*
        fn $name(&self, $($argument: slice_argument!($argument)),*) -> f64 {
            let mut number = [f64::NAN];
            self.call(FunctionId::$id, &Arguments { $($argument,)* ..Arguments::none() }, &mut number);
            number[0]
        }
    };
    ($id:ident [$item:ident; $count:ident] [$($about:tt)*] $name:ident($($argument:ident),*)) => {
        $($about)*
        #[doc = concat!("\n`out`: one ", stringify!($item), " for each of the crane's ", stringify!($count), ".")]
        fn $name(&self, $($argument: slice_argument!($argument),)* out: &mut [entry_type!($item)]) {
            self.call(FunctionId::$id, &Arguments { $($argument,)* ..Arguments::none() }, cast_slice_mut(out));
        }
    };
    ($id:ident base [$($about:tt)*] $($signature:tt)*) => {
        slice_method! { $id numbers [$($about)* #[doc = "\n`out`: 36 numbers, column by column."]] $($signature)* }
    };
    ($id:ident $numbers:ident [$($about:tt)*] $name:ident($($argument:ident),*)) => {
        $($about)*
        fn $name(&self, $($argument: slice_argument!($argument),)* out: &mut [f64]) {
            self.call(FunctionId::$id, &Arguments { $($argument,)* ..Arguments::none() }, out);
        }
    };
}

/// Calls the function of an identifier of the crane with the size in its type; `absent`: for one of a part that the crane `C` does not have.
macro_rules! call_sized {
    ($id:ident $absent:block $call:tt $($part:ident { $(
        $(#[doc = $remark:literal])*
        $row:ident = $name:ident($($argument:ident),*) -> $result:tt $rule:ident $doc:literal $equation:literal
        $(python($($python:tt)*))?;
    )* })*) => {
        match $id {
            $($(FunctionId::$row if const { Part::$part.is_in(C::PARTS) } => {
                call_sized_row! { $result $call $name($($argument),*) }
            })*)*
            _ => $absent
        }
    };
}

/// An argument for the crane with the size in its type.
macro_rules! sized {
    ($at:ident t) => {
        $at.t
    };
    ($at:ident $vector:ident) => {
        &vector($at.$vector)
    };
}

/// A call of a row.
macro_rules! call_sized_row {
    (other ($crane:expr, $at:ident, $out:ident, $other:expr) $name:ident($($argument:ident),*)) => { $other };
    ([row; $count:ident] ($crane:expr, $at:ident, $out:ident, $other:expr) $name:ident($($argument:ident),*)) => {
        $crane.$name($(sized!($at $argument),)* $out.as_chunks_mut().0)
    };
    ([$item:ident; $count:ident] ($crane:expr, $at:ident, $out:ident, $other:expr) $name:ident($($argument:ident),*)) => {
        $crane.$name($(sized!($at $argument),)* cast_slice_mut($out))
    };
    (number ($crane:expr, $at:ident, $out:ident, $other:expr) $name:ident($($argument:ident),*)) => {
        $out.fill($crane.$name($(sized!($at $argument)),*))
    };
    (matrix ($crane:expr, $at:ident, $out:ident, $other:expr) $name:ident($($argument:ident),*)) => {
        // Matrices without rows have no size to cast to.
        for out in try_cast_slice_mut::<f64, SMatrix<f64, N, N>>($out).into_iter().flatten() {
            $crane.$name($(sized!($at $argument),)* out);
        }
    };
    ($numbers:ident ($crane:expr, $at:ident, $out:ident, $other:expr) $name:ident($($argument:ident),*)) => {
        $out.copy_from_slice($crane.$name($(sized!($at $argument)),*).as_slice())
    };
}

pub(super) use {call_sized, call_sized_row, sized, slice_method, slice_methods};
