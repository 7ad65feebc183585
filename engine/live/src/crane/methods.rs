//! Methods of a live crane, from the table of quantities.

/// The methods: each calls the function of its row.
macro_rules! methods {
    ($($part:ident { $(
        $(#[doc = $remark:literal])*
        $id:ident = $name:ident($($argument:ident),*) -> $result:tt $rule:ident $doc:literal $equation:literal
        $(python($($python:tt)*))?;
    )* })*) => {
        $($(method! { $result $id $name($($argument),*) })*)*
    };
}

/// A method.
macro_rules! method {
    (other $($row:tt)*) => {};
    // Written by hand, of their factors.
    ($result:tt DynamicResidualDerivatives $($row:tt)*) => {};
    ($result:tt InverseMassMatrix $($row:tt)*) => {};
    ([transform; $count:ident] $id:ident $name:ident($($argument:ident),*)) => {
        fn $name(&self, $($argument: slice_argument!($argument),)* out: &mut [Matrix4<f64>]) {
            self.matrices(FunctionId::$id, &Arguments { $($argument,)* ..Arguments::none() }, out);
        }
    };
    ([$item:ident; $count:ident] $id:ident $name:ident($($argument:ident),*)) => {
        fn $name(&self, $($argument: slice_argument!($argument),)* out: &mut [entry_type!($item)]) {
            self.list(FunctionId::$id, &Arguments { $($argument,)* ..Arguments::none() }, out);
        }
    };
    (number $id:ident $name:ident($($argument:ident),*)) => {
        fn $name(&self, $($argument: slice_argument!($argument)),*) -> f64 {
            self.scalar(FunctionId::$id, &Arguments { $($argument,)* ..Arguments::none() })
        }
    };
    ($numbers:ident $id:ident $name:ident($($argument:ident),*)) => {
        fn $name(&self, $($argument: slice_argument!($argument),)* out: &mut [f64]) {
            self.numbers(FunctionId::$id, &Arguments { $($argument,)* ..Arguments::none() }, out);
        }
    };
}

pub(super) use {method, methods};
