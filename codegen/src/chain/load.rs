//! External loads.

use super::{BodyId, Chain, Inertia, Parameter, ParameterId, Profile, Value};

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

/// Partial factors of weights and loads.
#[derive(Clone, Debug, PartialEq)]
pub struct Combination {
    /// Unique name.
    pub name: String,
    /// Factor of the weight of everything, above 0.
    pub weight: f64,
    /// Factors of the weight of masses in place of that one, by parameters in kg.
    pub masses: Vec<(ParameterId, f64)>,
    /// Factors of loads, by their indices; 1 of all others.
    pub loads: Vec<(usize, f64)>,
}

impl Chain {
    /// The same crane with weight and loads as a combination has them. Gravity is that of the weight of everything; masses with a factor of
    /// their own make up for the difference, whatever their parameters are.
    pub(crate) fn combined(mut self, combination: &Combination) -> Chain {
        let of_load =
            |index: usize| combination.loads.iter().find(|(load, _)| *load == index).map_or(1.0, |(_, factor)| *factor);
        self.scale_weight_and_loads(&Value::from(combination.weight), |index| of_load(index).into());
        let of_mass = |id: ParameterId| {
            let own = combination.masses.iter().find(|(mass, _)| *mass == id);
            own.map_or(1.0, |(_, factor)| factor / combination.weight)
        };
        for Inertia { mass, first, second } in self.bodies.iter_mut().filter_map(|body| body.inertia.as_mut()) {
            for number in std::iter::once(mass).chain(first).chain(second) {
                *number = number.with_factors(&of_mass);
            }
        }
        self.title = format!("{}, combination {}", self.title, combination.name);
        self.combination = Some(combination.name.clone());
        self
    }

    /// The same crane with a factor of its weight and of all loads as one more live parameter, 1 by default; and the index of this parameter.
    #[must_use]
    pub fn with_load_factor(&self) -> (Chain, usize) {
        let index = self.parameters.len();
        let mut chain = self.clone();
        chain.parameters.push(Parameter {
            name: "factor_of_weight_and_loads".to_owned(),
            unit: String::new(),
            about: String::new(),
            default: 1.0,
            lower_bound: None,
        });
        let factor = Value::Parameter(ParameterId(index));
        chain.scale_weight_and_loads(&factor, |_| factor.clone());
        (chain, index)
    }

    /// Multiplies gravity, and each load by its index.
    fn scale_weight_and_loads(&mut self, of_weight: &Value, of_load: impl Fn(usize) -> Value) {
        for number in &mut self.gravity {
            *number = of_weight.clone() * number.clone();
        }
        for (index, load) in self.loads.iter_mut().enumerate() {
            for number in [&mut load.force, &mut load.moment].into_iter().flatten() {
                *number = of_load(index) * number.clone();
            }
        }
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
