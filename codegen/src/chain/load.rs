//! External loads.

use super::{BodyId, Chain, Parameter, ParameterId, Profile, Value};

/// A force and a moment at a point of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Load {
    /// Unique name.
    pub name: String,
    /// The body it acts on.
    pub body: BodyId,
    /// Position in the body's frame, m.
    pub position: [Value; 3],
    /// N
    pub force: [Value; 3],
    /// N m
    pub moment: [Value; 3],
    /// The axes along which force and moment are given.
    pub axes: LoadAxes,
    /// Factor of both over time; `None` means 1.
    pub scale: Option<Profile>,
}

impl Chain {
    /// The same crane with a factor of its weight and of all loads as one more live parameter, 1 by default; and the index of this parameter.
    #[must_use]
    pub fn with_load_factor(&self) -> (Chain, usize) {
        let index = self.parameters.len();
        let factor = || Value::Parameter(ParameterId(index));
        let mut chain = self.clone();
        chain.parameters.push(Parameter {
            name: "factor_of_weight_and_loads".to_owned(),
            unit: String::new(),
            about: String::new(),
            default: 1.0,
            lower_bound: None,
        });
        let vectors = chain.loads.iter_mut().flat_map(|load| [&mut load.force, &mut load.moment]);
        for number in vectors.chain([&mut chain.gravity]).flatten() {
            *number = factor() * number.clone();
        }
        (chain, index)
    }
}

/// Axes along which a load is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoadAxes {
    /// Those of the world: it keeps its direction.
    World,
    /// Those of the body: it turns with it.
    Link,
}

impl Load {
    /// Number of intervals in which its scale is smooth.
    #[must_use]
    pub fn pieces(&self) -> usize {
        self.scale.as_ref().map_or(0, |scale| scale.pieces().len())
    }
}
