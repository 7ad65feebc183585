//! Your own crane: where it rests, and how it lifts its load.

use std::error::Error;
use std::ops::ControlFlow;

use crane_model::nalgebra::{SVector, Vector3};
use crane_model::{CraneModel, dynamics, statics};
use own_crane::{Crane, N, Params};

/// The crane of `crane.yaml`, as the build script compiled it; a program need not use all of it.
#[allow(dead_code, clippy::all)]
mod own_crane {
    include!(concat!(env!("OUT_DIR"), "/own_crane.rs"));
}

fn main() -> Result<(), Box<dyn Error>> {
    let crane = Crane::new(Params { payload: 500.0 })?;
    let rest = statics::Problem::new(&crane).solve();
    println!("{}, {} Newton steps", rest.status, rest.steps());

    let start = dynamics::InitialState::at_rest(rest.q);
    // Of the run in the spec, a line per half second.
    let settings = dynamics::Settings { output: 0.5, ..dynamics::Settings::from_description(crane.description()) };
    println!("{:>5}  {:>8}  {:>8}  {:>11}", "t [s]", "x [m]", "z [m]", "drive [N m]");
    dynamics::Simulation::new(&crane, start, &settings).observe(|sample| {
        let q = SVector::<f64, N>::from_column_slice(sample.q);
        let v = SVector::<f64, N>::from_column_slice(sample.v);
        let mut hook = [Vector3::zeros()];
        crane.points(&q, &mut hook);
        let torque = crane.drive_forces(sample.t, &q, &v)[0];
        println!("{:5.1}  {:8.4}  {:8.4}  {torque:11.1}", sample.t, hook[0].x, hook[0].z);
        ControlFlow::Continue(())
    })?;
    Ok(())
}
