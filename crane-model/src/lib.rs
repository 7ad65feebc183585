//! Runtime of cranes compiled by `crane-codegen`.

mod description;
mod model;

pub use description::{
    BodyInfo, CoordinateInfo, CoordinateKind, CoordinateRole, Description, DriveInfo, ParameterInfo, SupportInfo,
};
pub use model::{CraneModel, Dynamics, Linearisation, Linearise, Statics, TransformDerivatives};
