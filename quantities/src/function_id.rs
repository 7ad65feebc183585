//! The table as data.

use crate::{
    Part,
    count::{Count, Extent, Item},
};

/// An argument of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Argument {
    /// One number, `t`.
    Time,
    /// A vector, `q`.
    Position,
    /// A vector, `v`.
    Velocity,
    /// A vector, `a`: accelerations of the coordinates.
    Acceleration,
    /// A generalized force, the right-hand side `r` of a linear system.
    RightHandSide,
    /// What a product with derivatives multiplies them with: weights of results, or changes of what the function depends on.
    Multiplier,
    /// Positions at which drives are held, at the places of their coordinates.
    DrivePositions,
    /// Added inertias of single coordinates, a diagonal.
    AddedInertia,
    /// Added inertia of the base, a symmetric 6×6 matrix.
    BaseAddedInertia,
    /// Results of an earlier function that this one uses.
    Factors,
    /// Values that differ from one iteration of a loop to the next, in order of the loop's sources.
    LoopVarying,
    /// Values that a loop leaves, in order of the function's live-outs.
    LiveOut,
    /// Live parameters.
    Parameters,
    /// Inputs that are set between steps, three numbers each: the value while it is set, else 0; 0 while it is set, else 1; and its rate.
    Inputs,
}

/// Names of the arguments of a method of the Python package: those that must be given, and one that may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PythonArguments {
    /// Those that must be given.
    pub required: &'static [&'static str],
    /// One that may be left out.
    pub optional: Option<&'static str>,
}

impl PythonArguments {
    /// All of them, in order.
    pub fn names(self) -> impl Iterator<Item = &'static str> {
        self.required.iter().copied().chain(self.optional)
    }
}

macro_rules! argument {
    (t) => {
        Argument::Time
    };
    (q) => {
        Argument::Position
    };
    (v) => {
        Argument::Velocity
    };
    (a) => {
        Argument::Acceleration
    };
    (r) => {
        Argument::RightHandSide
    };
    (positions) => {
        Argument::DrivePositions
    };
    (added_inertia) => {
        Argument::AddedInertia
    };
    (base) => {
        Argument::BaseAddedInertia
    };
    (f) => {
        Argument::Factors
    };
}

macro_rules! result {
    (number) => {
        Extent::Number
    };
    (vector) => {
        Extent::Vector
    };
    (matrix) => {
        Extent::Matrix
    };
    (base) => {
        Extent::Base
    };
    (other) => {
        Extent::Other
    };
    ([$item:ident; $count:ident]) => {
        Extent::List(item!($item), count!($count))
    };
}

macro_rules! item {
    (vector) => {
        Item::Vector
    };
    (pair) => {
        Item::Pair
    };
    (row) => {
        Item::Row
    };
    (tension) => {
        Item::Tension
    };
    (wrench) => {
        Item::Wrench
    };
    (moduli) => {
        Item::Moduli
    };
    (transform) => {
        Item::Transform
    };
}

macro_rules! count {
    (bodies) => {
        Count::Bodies
    };
    (points) => {
        Count::Points
    };
    (supports) => {
        Count::Supports
    };
    (drives) => {
        Count::Drives
    };
    (cylinders) => {
        Count::Cylinders
    };
    (connectors) => {
        Count::Connectors
    };
    (sections) => {
        Count::Sections
    };
    (cuts) => {
        Count::Cuts
    };
    (coordinates) => {
        Count::Coordinates
    };
    (loop_equations) => {
        Count::LoopEquations
    };
    (loop_rows) => {
        Count::LoopRows
    };
    (drive_pieces) => {
        Count::DrivePieces
    };
    (load_pieces) => {
        Count::LoadPieces
    };
    (winch_pieces) => {
        Count::WinchPieces
    };
    (attachments) => {
        Count::Attachments
    };
    (cylinder_cuts) => {
        Count::CylinderCuts
    };
    (connector_cuts) => {
        Count::ConnectorCuts
    };
    (loop_cuts) => {
        Count::LoopCuts
    };
    (derivatives) => {
        Count::Derivatives
    };
    (second_derivatives) => {
        Count::SecondDerivatives
    };
    (point_axes) => {
        Count::PointAxes
    };
    (support_axes) => {
        Count::SupportAxes
    };
    (residual_rows) => {
        Count::ResidualRows
    };
    (residual_factors) => {
        Count::ResidualFactors
    };
    (mass_factors) => {
        Count::MassFactors
    };
}

macro_rules! python {
    () => { None };
    ($($required:ident),* $(; $optional:ident)?) => {
        Some(PythonArguments { required: &[$(stringify!($required)),*], optional: python!(@ $($optional)?) })
    };
    (@) => { None };
    (@ $optional:ident) => { Some(stringify!($optional)) };
}

/// The table as an enumeration with functions.
macro_rules! function_id {
    ($($part:ident { $(
        $(#[doc = $remark:literal])*
        $id:ident = $name:ident($($argument:ident),*) -> $result:tt $rule:ident $doc:literal $equation:literal
        $(python($($python:tt)*))?;
    )* })*) => {
        /// A function of a crane, named after the method of the runtime that calls it.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[expect(missing_docs, reason = "the methods are documented")]
        pub enum FunctionId {
            $($($id,)*)*
        }

        impl FunctionId {
            /// All of them, part by part.
            pub const ALL: &[FunctionId] = &[$($(FunctionId::$id,)*)*];

            /// Its name in generated code, an identifier.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $($(FunctionId::$id => stringify!($name),)*)*
                }
            }

            /// The part to which it belongs.
            #[must_use]
            pub const fn part(self) -> Part {
                match self {
                    $($(FunctionId::$id => Part::$part,)*)*
                }
            }

            /// Its arguments in addition to the live parameters and the inputs, in order.
            #[must_use]
            pub const fn arguments(self) -> &'static [Argument] {
                match self {
                    $($(FunctionId::$id => &[$(argument!($argument)),*],)*)*
                }
            }

            /// Shape of its result.
            #[must_use]
            pub const fn extent(self) -> Extent {
                match self {
                    $($(FunctionId::$id => result!($result),)*)*
                }
            }

            /// Extent of each index of its result in words, each after a comma: `, points, 3`.
            #[must_use]
            pub const fn axes(self) -> &'static str {
                match self {
                    $($(FunctionId::$id => crate::axes!($result),)*)*
                }
            }

            /// First line of its documentation: what it returns, with units.
            #[must_use]
            pub const fn doc(self) -> &'static str {
                match self {
                    $($(FunctionId::$id => $doc,)*)*
                }
            }

            /// Equations it implements, and their source.
            #[must_use]
            pub const fn equation(self) -> &'static str {
                match self {
                    $($(FunctionId::$id => $equation,)*)*
                }
            }

            /// Arguments of the method of this name of the Python package, if it has one.
            #[must_use]
            pub const fn python(self) -> Option<PythonArguments> {
                match self {
                    $($(FunctionId::$id => python!($($($python)*)?),)*)*
                }
            }
        }
    };
}

crate::quantities! { function_id }

impl FunctionId {
    /// How many there are.
    pub const COUNT: usize = FunctionId::ALL.len();

    /// The function of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|id| id.name() == name)
    }
}

impl Part {
    /// Its functions, in the order of the table.
    pub fn functions(self) -> impl Iterator<Item = FunctionId> {
        FunctionId::ALL.iter().copied().filter(move |id| id.part() == self)
    }
}
