//! Inputs.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{FixedAngle, Motion, Spanned};

/// A number that a controller or a user sets between steps; until then it has a value or follows a motion.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a mapping of `value` or `motion`, `unit` and `about`")]
pub struct Input {
    /// Value unless set, in SI units; default 0.
    pub value: Option<Spanned<FixedAngle>>,
    /// What it follows unless set, in place of a value.
    pub motion: Option<Spanned<Motion>>,
    /// Unit, for tables, such as `N`. Default: none.
    pub unit: Option<Spanned<String>>,
    /// What it is. Default: empty.
    pub about: Option<Spanned<String>>,
}
