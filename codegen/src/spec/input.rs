//! Inputs.

use super::{FixedAngle, Motion, Spanned};
use crate::node::FromNode;

/// A number that a controller or a user sets between steps; until then it has a value or follows a motion.
#[derive(Clone, Debug, FromNode)]
pub struct Input {
    /// Value while it is not set, in SI units. Default 0.
    #[key(unit = "its own")]
    pub value: Option<Spanned<FixedAngle>>,
    /// The motion that it follows while it is not set, instead of a value.
    #[key(unit = "its own")]
    pub motion: Option<Spanned<Motion>>,
    /// Unit shown in tables, such as `N`. Default: none.
    pub unit: Option<Spanned<String>>,
    /// Description. Default: empty.
    pub about: Option<Spanned<String>>,
}
