//! A double pendulum of point masses, its first joint sprung; angles from the downward vertical, both absolute.
//! L. D. Landau, E. M. Lifshitz, Mechanics, §5, problem 1.

use std::f64::consts::FRAC_PI_2;

use crane_model::{
    CoordinateInfo, CoordinateKind::Rotation, CoordinateRole::Passive, CraneModel, Description, Linearisation,
    ParameterError,
};
use nalgebra::{Matrix2, Matrix4, Vector2};

use super::{GRAVITY, coordinate, description, implicit::mass_matrix};

const COORDINATES: &[CoordinateInfo] =
    &[coordinate("upper", Rotation, Passive), coordinate("lower", Rotation, Passive)];
static HANGING: Description = description("double_pendulum", COORDINATES, &[Some(0.4), Some(-0.3)]);
static UPSIDE_DOWN: Description = description("upside_down", COORDINATES, &[Some(0.1), Some(3.0)]);
static HORIZONTAL: Description = description("horizontal", COORDINATES, &[Some(FRAC_PI_2), Some(FRAC_PI_2)]);

static TOPPLING: Description = description("toppling", COORDINATES, &[Some(1.8), Some(0.1)]);

/// Two point masses on massless rods.
#[derive(Clone, Copy)]
pub struct DoublePendulum {
    /// Names and guess.
    pub description: &'static Description,
    /// Masses, kg.
    pub mass: [f64; 2],
    /// Lengths, m.
    pub length: [f64; 2],
    /// Spring of the first joint, N m/rad.
    pub stiffness: f64,
    /// Angle at which that spring is at rest, rad.
    pub rest: f64,
    /// Gravity, m/s².
    pub gravity: f64,
}

impl DoublePendulum {
    /// Starts near the hanging pose.
    pub fn hanging() -> Self {
        Self {
            description: &HANGING,
            mass: [2.0, 1.5],
            length: [1.0, 0.7],
            stiffness: 0.0,
            rest: 0.0,
            gravity: GRAVITY,
        }
    }

    /// Starts with the second mass above its joint.
    pub fn upside_down() -> Self {
        Self { description: &UPSIDE_DOWN, ..Self::hanging() }
    }

    /// Starts with the first mass somewhat above its joint, far from either equilibrium.
    pub fn toppling() -> Self {
        Self { description: &TOPPLING, ..Self::hanging() }
    }

    /// Starts where the tangent stiffness vanishes.
    pub fn horizontal() -> Self {
        Self { description: &HORIZONTAL, ..Self::hanging() }
    }

    /// `(m₁ + m₂) l₁` and `m₂ l₂`, kg m.
    fn static_moments(&self) -> [f64; 2] {
        [(self.mass[0] + self.mass[1]) * self.length[0], self.mass[1] * self.length[1]]
    }

    /// `m₂ l₁ l₂`, kg m².
    fn coupling(&self) -> f64 {
        self.mass[1] * self.length[0] * self.length[1]
    }
}

impl CraneModel<2> for DoublePendulum {
    crate::common::implicit::by_hand! { 2 }

    fn joint_stiffness_and_damping(&self, out: &mut [[f64; 2]]) {
        out.fill([0.0; 2]);
    }

    fn description(&self) -> &Description {
        self.description
    }

    fn parameter(&self, _: usize) -> f64 {
        f64::NAN
    }

    fn set_parameter(&mut self, _: usize, _: f64) -> Result<(), ParameterError> {
        Ok(())
    }

    fn transforms(&self, _: &Vector2<f64>, _: &mut [Matrix4<f64>]) {}

    fn body_sizes(&self, _: &mut [[f64; 2]]) {}

    fn forces(&self, _: f64, q: &Vector2<f64>, _: &Vector2<f64>) -> Vector2<f64> {
        Vector2::new(-self.stiffness * (q.x - self.rest), 0.0)
    }

    fn gravity_energy(&self, q: &Vector2<f64>) -> f64 {
        let [upper, lower] = self.static_moments();
        -self.gravity * (upper * q.x.cos() + lower * q.y.cos())
    }

    fn element_energy(&self, q: &Vector2<f64>) -> f64 {
        0.5 * self.stiffness * (q.x - self.rest).powi(2)
    }

    fn mass_matrix(&self, q: &Vector2<f64>, out: &mut Matrix2<f64>) {
        let [upper, lower] = self.static_moments();
        let coupling = self.coupling() * (q.x - q.y).cos();
        *out = Matrix2::new(upper * self.length[0], coupling, coupling, lower * self.length[1]);
    }

    fn bias(&self, q: &Vector2<f64>, v: &Vector2<f64>) -> Vector2<f64> {
        let [upper, lower] = self.static_moments();
        let coupling = self.coupling() * (q.x - q.y).sin();
        Vector2::new(
            -coupling * v.y * v.y - self.gravity * upper * q.x.sin(),
            coupling * v.x * v.x - self.gravity * lower * q.y.sin(),
        )
    }

    fn kinetic_energy(&self, q: &Vector2<f64>, v: &Vector2<f64>) -> f64 {
        0.5 * v.dot(&(mass_matrix(self, q) * v))
    }

    fn static_residual(&self, _: f64, q: &Vector2<f64>, _: &Vector2<f64>) -> Vector2<f64> {
        let [upper, lower] = self.static_moments();
        Vector2::new(self.gravity * upper * q.x.sin(), self.gravity * lower * q.y.sin())
            - self.forces(0.0, q, &Vector2::zeros())
    }

    fn tangent_stiffness(&self, _: f64, q: &Vector2<f64>, _: &Vector2<f64>, out: &mut Matrix2<f64>) {
        let [upper, lower] = self.static_moments();
        *out = Matrix2::from_diagonal(&Vector2::new(
            self.gravity * upper * q.x.cos() + self.stiffness,
            self.gravity * lower * q.y.cos(),
        ));
    }

    fn linearise(&self, q: &Vector2<f64>) -> Linearisation<2> {
        let [mut mass, mut stiffness, damping] = [Matrix2::zeros(); 3];
        self.mass_matrix(q, &mut mass);
        self.tangent_stiffness(0.0, q, q, &mut stiffness);
        Linearisation { mass, stiffness, damping }
    }
}
