//! A block on springs whose base moves along x and z, its axes turned about y, under live gravity: its weight is known.

use std::sync::LazyLock;

use crane_model::{
    BodyInfo, Bound, CoordinateInfo, CoordinateKind::Translation, CoordinateRole::Base, CraneModel, Description,
    Linearisation, List, ParameterError, ParameterInfo, Text, Wrench,
};
use nalgebra::{Matrix2, Matrix3, Matrix4, Vector2, Vector3};

use super::{GRAVITY, coordinate, description};

const COORDINATES: &[CoordinateInfo] =
    &[coordinate("sledge_x", Translation, Base), coordinate("sledge_z", Translation, Base)];
static DESCRIPTION: LazyLock<Description> = LazyLock::new(|| Description {
    parameters: List::Static(&[ParameterInfo {
        name: Text::Static("gravity"),
        unit: Text::Static("m/s²"),
        about: Text::Static("downwards"),
        default: GRAVITY,
        lower_bound: Bound::LOWEST,
        upper_bound: Bound::HIGHEST,
    }]),
    bodies: List::Static(&[BodyInfo {
        name: Text::Static("sledge"),
        link: Text::Static("sledge"),
        degrees_of_freedom: 2,
    }]),
    ..description("sledge", COORDINATES, &[Some(0.0), Some(0.0)])
});
/// Mass, kg.
const MASS: f64 = 20.0;
/// Springs along both axes, N/m.
const STIFFNESS: f64 = 1e4;
/// Turn of the axes about y, rad.
const TURN: f64 = 0.3;

/// Mass on two springs.
#[derive(Clone, Copy)]
pub struct Sledge {
    /// Gravity, m/s².
    pub gravity: f64,
}

impl Default for Sledge {
    fn default() -> Self {
        Self { gravity: GRAVITY }
    }
}

impl Sledge {
    /// Directions of the coordinates in the world frame.
    fn directions() -> [Vector3<f64>; 2] {
        let (sin, cos) = TURN.sin_cos();
        [Vector3::new(cos, 0.0, -sin), Vector3::new(sin, 0.0, cos)]
    }

    /// Weight, world frame, N.
    pub fn weight(self) -> Vector3<f64> {
        Vector3::new(0.0, 0.0, -MASS * self.gravity)
    }
}

impl CraneModel<2> for Sledge {
    crate::common::implicit::by_hand! { 2 }

    fn joint_stiffness_and_damping(&self, out: &mut [[f64; 2]]) {
        out.fill([0.0; 2]);
    }

    fn description(&self) -> &Description {
        &DESCRIPTION
    }

    fn parameter(&self, _: usize) -> f64 {
        self.gravity
    }

    fn set_parameter(&mut self, _: usize, value: f64) -> Result<(), ParameterError> {
        self.gravity = value;
        Ok(())
    }

    fn body_sizes(&self, out: &mut [[f64; 2]]) {
        out[0] = [MASS, 0.0];
    }

    fn transforms(&self, q: &Vector2<f64>, out: &mut [Matrix4<f64>]) {
        let [x, z] = Self::directions();
        let rotation = Matrix3::from_columns(&[x, z.cross(&x), z]);
        out[0] = rotation.to_homogeneous().append_translation(&(x * q.x + z * q.y));
    }

    fn forces(&self, _: f64, q: &Vector2<f64>, _: &Vector2<f64>) -> Vector2<f64> {
        -STIFFNESS * q
    }

    fn gravity_energy(&self, q: &Vector2<f64>) -> f64 {
        -self.bias(q, &Vector2::zeros()).dot(q)
    }

    fn mass_matrix(&self, _: &Vector2<f64>, out: &mut Matrix2<f64>) {
        *out = Matrix2::identity() * MASS;
    }

    fn bias(&self, _: &Vector2<f64>, _: &Vector2<f64>) -> Vector2<f64> {
        Self::directions().map(|direction| direction.dot(&self.weight())).into()
    }

    fn kinetic_energy(&self, _: &Vector2<f64>, v: &Vector2<f64>) -> f64 {
        0.5 * MASS * v.norm_squared()
    }

    fn static_residual(&self, _: f64, q: &Vector2<f64>, _: &Vector2<f64>) -> Vector2<f64> {
        STIFFNESS * q - self.bias(q, &Vector2::zeros())
    }

    fn tangent_stiffness(&self, _: f64, _: &Vector2<f64>, _: &Vector2<f64>, out: &mut Matrix2<f64>) {
        *out = Matrix2::identity() * STIFFNESS;
    }

    fn linearise(&self, _: &Vector2<f64>) -> Linearisation<2> {
        let [mass, stiffness, damping] = [MASS, STIFFNESS, 0.0].map(|entry| Matrix2::identity() * entry);
        Linearisation { mass, stiffness, damping }
    }

    fn internal_forces(&self, _: f64, _: &Vector2<f64>, _: &Vector2<f64>, _: &Vector2<f64>, _: &mut [Wrench]) {}
}
