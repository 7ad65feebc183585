//! The quantities that a crane computes, one row of a table each.
//!
//! The compiler takes identifiers, documentation, arguments and shapes of its functions from the table, the runtime its
//! methods, live cranes their calls, the Python package its methods, the command what it can evaluate, and the tests the lists of what they
//! must prove. [`quantities!`] hands the rows to a macro; [`FunctionId`] has them as data.
//!
//! Beside it stands the [`Description`] of a crane: what its parts are called. The compiler makes it, for live cranes and for generated code.

#![cfg_attr(not(feature = "std"), no_std)]

mod column_kind;
mod count;
mod description;
mod display_unit;
mod function_id;
mod part;
mod table;

pub use column_kind::{ColumnKind, END, PEAKS, Size, Strain};
pub use count::{Count, Extent, Item};
pub use description::{
    AttachmentInfo, BodyInfo, Bound, BristleInfo, ConditionInfo, ConnectorInfo, CoordinateInfo, CoordinateKind,
    CoordinateRole, Cut, CylinderInfo, Description, DriveInfo, EventInfo, InputInfo, JoinsInfo, LARGE_TILT, List,
    LoadInfo, LoopEquationInfo, LoopJointInfo, Moment, NEAR_SINGULAR, ParameterError, ParameterInfo, PumpInfo, Refusal,
    SectionInfo, Side, StageInfo, SupportInfo, TIPPED, Text, ValveInfo,
};
#[cfg(feature = "std")]
pub use description::{PUMP, PartColumn, Tree};
pub use display_unit::DisplayUnit;
pub use function_id::{Argument, FunctionId, PythonArguments};
pub use part::Part;
