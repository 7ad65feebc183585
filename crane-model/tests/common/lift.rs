//! A mass on a driven spring and damper: `m z̈ = s (z_dr − z) + d (ż_dr − ż) − m g`, `z_dr = z_0 + a sin Ωt`. Linear, so that its
//! motion is known in closed form.

use std::sync::LazyLock;

use crane_model::{
    Bound, CoordinateInfo, CoordinateKind::Translation, CoordinateRole::Driven, CraneModel, Description, DriveInfo,
    Linearisation, List, ParameterError, ParameterInfo, Text,
};
use nalgebra::{Complex, Matrix1, Matrix4, Vector1};

use super::{GRAVITY, coordinate, description};

const COORDINATES: &[CoordinateInfo] = &[coordinate("lift_z", Translation, Driven)];
static DESCRIPTION: LazyLock<Description> = LazyLock::new(|| Description {
    drives: List::Static(&[DriveInfo { coordinate: 0, pieces: 1, max_rate: None, max_power: None }]),
    parameters: List::Static(&[ParameterInfo {
        name: Text::Static("height"),
        unit: Text::Static("m"),
        about: Text::Static("where the support starts"),
        default: 0.0,
        lower_bound: Bound::LOWEST,
        upper_bound: Bound::HIGHEST,
    }]),
    ..description("lift", COORDINATES, &[None])
});
static GUESSED: LazyLock<Description> =
    LazyLock::new(|| Description { guess: List::Static(&[Some(0.5)]), ..DESCRIPTION.clone() });

/// Mass, spring, damper, moved support.
#[derive(Clone, Copy)]
pub struct Lift {
    /// Names and guess.
    pub description: &'static Description,
    /// Where the support starts, m; live.
    pub height: f64,
    /// Mass, kg.
    pub mass: f64,
    /// Spring, N/m.
    pub stiffness: f64,
    /// Damper, N s/m.
    pub damping: f64,
    /// Amplitude of the support, m.
    pub amplitude: f64,
    /// Circular frequency of the support, rad/s.
    pub frequency: f64,
    /// Start and duration of a single motion of the support up and back, s; without it, the support oscillates all the time.
    pub bump: Option<[f64; 2]>,
}

impl Default for Lift {
    fn default() -> Self {
        Self {
            description: &DESCRIPTION,
            height: 0.0,
            mass: 10.0,
            stiffness: 4000.0,
            damping: 40.0,
            amplitude: 0.1,
            frequency: 7.0,
            bump: None,
        }
    }
}

impl Lift {
    /// Starts at a guess that is not the drive's position.
    pub fn guessed() -> Self {
        Self { description: &GUESSED, ..Self::default() }
    }

    /// Its support rests, moves up and back again within `duration`, s, and rests.
    pub fn bumped(begin: f64, duration: f64) -> Self {
        Self { bump: Some([begin, duration]), ..Self::default() }
    }

    /// Position at rest, m.
    pub fn sag(&self) -> f64 {
        self.height - self.mass * GRAVITY / self.stiffness
    }

    /// Position at `t` after a start at rest from the equilibrium: forced plus free vibration.
    pub fn exact(&self, t: f64) -> f64 {
        let i = Complex::i();
        let Self { mass: m, stiffness: s, damping: d, amplitude, frequency, .. } = *self;
        let forced = amplitude * (s + i * d * frequency) / (s - m * frequency.powi(2) + i * d * frequency);
        let lambda = Complex::new(-d / (2.0 * m), (s / m - (d / (2.0 * m)).powi(2)).sqrt());
        // Im(forced) + Re(c) = 0 and Re(forced) Ω + Re(λ c) = 0.
        let re = -forced.im;
        let im = (forced.re * frequency + lambda.re * re) / lambda.im;
        self.sag() + (forced * (i * frequency * t).exp()).im + (Complex::new(re, im) * (lambda * t).exp()).re
    }

    fn support(&self, t: f64) -> [f64; 2] {
        if let Some([begin, duration]) = self.bump {
            // a (4 τ (1 − τ))³
            let tau = ((t - begin) / duration).clamp(0.0, 1.0);
            let bow = 4.0 * tau * (1.0 - tau);
            let rate = 3.0 * bow.powi(2) * 4.0 * (1.0 - 2.0 * tau) / duration;
            return [self.height + self.amplitude * bow.powi(3), self.amplitude * rate];
        }
        let (sin, cos) = (self.frequency * t).sin_cos();
        [self.height + self.amplitude * sin, self.amplitude * self.frequency * cos]
    }
}

impl CraneModel<1> for Lift {
    crate::common::implicit::by_hand! { 1 }

    fn joint_stiffness_and_damping(&self, out: &mut [[f64; 2]]) {
        out.copy_from_slice(&[[self.stiffness, self.damping]]);
    }

    fn description(&self) -> &Description {
        self.description
    }

    fn parameter(&self, _: usize) -> f64 {
        self.height
    }

    fn set_parameter(&mut self, _: usize, value: f64) -> Result<(), ParameterError> {
        self.height = value;
        Ok(())
    }

    fn transforms(&self, _: &Vector1<f64>, _: &mut [Matrix4<f64>]) {}

    fn body_sizes(&self, _: &mut [[f64; 2]]) {}

    fn forces(&self, t: f64, q: &Vector1<f64>, v: &Vector1<f64>) -> Vector1<f64> {
        self.drive_forces(t, q, v)
    }

    fn drive_forces(&self, t: f64, q: &Vector1<f64>, v: &Vector1<f64>) -> Vector1<f64> {
        let [z, rate] = self.support(t);
        Vector1::new(self.stiffness * (z - q.x) + self.damping * (rate - v.x))
    }

    fn drive_motions(&self, t: f64, out: &mut [[f64; 2]]) {
        out[0] = self.support(t);
    }

    fn drive_pieces(&self, out: &mut [[f64; 2]]) {
        if let (Some([begin, duration]), [piece]) = (self.bump, out) {
            *piece = [begin, begin + duration];
        }
    }

    fn gravity_energy(&self, q: &Vector1<f64>) -> f64 {
        self.mass * GRAVITY * q.x
    }

    fn drive_energy(&self, t: f64, q: &Vector1<f64>) -> f64 {
        0.5 * self.stiffness * (self.support(t)[0] - q.x).powi(2)
    }

    fn drive_power(&self, t: f64, q: &Vector1<f64>, v: &Vector1<f64>) -> f64 {
        self.drive_forces(t, q, v).x * self.support(t)[1]
    }

    fn dissipation(&self, t: f64, _: &Vector1<f64>, v: &Vector1<f64>) -> f64 {
        self.damping * (self.support(t)[1] - v.x).powi(2)
    }

    fn mass_matrix(&self, _: &Vector1<f64>, out: &mut Matrix1<f64>) {
        *out = Matrix1::new(self.mass);
    }

    fn bias(&self, _: &Vector1<f64>, _: &Vector1<f64>) -> Vector1<f64> {
        Vector1::new(-self.mass * GRAVITY)
    }

    fn kinetic_energy(&self, _: &Vector1<f64>, v: &Vector1<f64>) -> f64 {
        0.5 * self.mass * v.x * v.x
    }

    fn static_residual(&self, t: f64, q: &Vector1<f64>, positions: &Vector1<f64>) -> Vector1<f64> {
        -self.bias(q, &Vector1::zeros()) - self.drive_forces_at_rest(t, q, positions)
    }

    fn tangent_stiffness(&self, _: f64, _: &Vector1<f64>, _: &Vector1<f64>, out: &mut Matrix1<f64>) {
        *out = Matrix1::new(self.stiffness);
    }

    fn drive_forces_at_rest(&self, _: f64, q: &Vector1<f64>, positions: &Vector1<f64>) -> Vector1<f64> {
        (positions - q) * self.stiffness
    }

    fn linearise(&self, _: &Vector1<f64>) -> Linearisation<1> {
        let [mass, stiffness, damping] = [self.mass, self.stiffness, self.damping].map(Matrix1::new);
        Linearisation { mass, stiffness, damping }
    }
}
