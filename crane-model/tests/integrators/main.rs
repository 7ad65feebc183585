//! Orders, stability and error control of the methods, on cranes written by hand.

/// `CraneModel` for a crane in a wrapper: that of its field `crane`.
macro_rules! impl_model_as_in_crane {
    ($wrapper:ident $($more:tt)*) => {
        impl<const N: usize, C: CraneModel<N>> CraneModel<N> for $wrapper<C> {
            const PARTS: &'static [crane_model::Part] = C::PARTS;

            type Lanes = crane_model::OneByOne<Self>;

            fn lanes(cranes: [&Self; 8]) -> Self::Lanes {
                crane_model::OneByOne(cranes.map(Clone::clone))
            }
            fn description(&self) -> &Description {
                self.crane.description()
            }
            fn parameter(&self, index: usize) -> f64 {
                self.crane.parameter(index)
            }
            fn set_parameter(&mut self, index: usize, value: f64) -> Result<(), ParameterError> {
                self.crane.set_parameter(index, value)
            }
            fn transforms(&self, q: &SVector<f64, N>, out: &mut [Matrix4<f64>]) {
                self.crane.transforms(q, out);
            }

            fn body_sizes(&self, out: &mut [[f64; 2]]) {
                self.crane.body_sizes(out);
            }
            fn forces(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> SVector<f64, N> {
                self.crane.forces(t, q, v)
            }
            fn gravity_energy(&self, q: &SVector<f64, N>) -> f64 {
                self.crane.gravity_energy(q)
            }
            $($more)*
        }
    };
}

#[path = "../common/mod.rs"]
mod common;
mod orders;
mod runs;

use common::Lift;
use crane_model::{
    CraneModel,
    dynamics::{rk4::State, rosenbrock},
};
use nalgebra::Complex;

/// A lift on a spring of 2e5 rad/s, far beyond what steps resolve: the mass follows its drive, z ≈ sag + 0.1 m sin 7t, except
/// for m a Ω²/s = 1e-10 m.
fn stiff_lift() -> Lift {
    Lift { stiffness: 4e11, damping: 4e5, ..Lift::default() }
}

/// A lift without drive, swinging freely with the circular frequency 20 rad/s and a damping ratio.
fn swinging(ratio: f64) -> (Lift, Complex<f64>) {
    let lift = Lift { amplitude: 0.0, ..Lift::default() };
    let omega = (lift.stiffness / lift.mass).sqrt();
    let lift = Lift { damping: 2.0 * ratio * omega * lift.mass, ..lift };
    (lift, Complex::new(-ratio, (1.0 - ratio * ratio).sqrt()) * omega)
}

/// State one second after `start`, in equal steps of a method or of its embedded formula, whose result then starts the next step.
fn state_after_a_second<const N: usize>(
    steps: i32,
    start: State<N>,
    step: impl Fn(f64, f64, &State<N>) -> (State<N>, State<N>),
    embedded: bool,
) -> State<N> {
    let h = f64::from(steps).recip();
    (0..steps).fold(start, |state, k| {
        let (end, error) = step(h * f64::from(k), h, &state);
        if embedded { State { q: end.q - error.q, v: end.v - error.v } } else { end }
    })
}

fn implicit<const N: usize, C: CraneModel<N>>(crane: &C) -> impl Fn(f64, f64, &State<N>) -> (State<N>, State<N>) {
    move |t, h, state| rosenbrock::step(crane, t, h, state).expect("inertia")
}
