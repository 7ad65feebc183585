//! Calls every function of the cranes, so that the linker has to find all of them free of panics.

use std::hint::black_box;

use bytemuck::Zeroable;
use crane_model::CraneModel;
use crane_model::dynamics::rk4::State;
use crane_model::rt::lanes::splat;
use crane_quantities::{Extent, FunctionId, quantities};

/// The arguments of functions, by their names in the table.
struct At<'a, V> {
    t: f64,
    q: &'a V,
    v: &'a V,
    a: &'a V,
    r: &'a V,
    positions: &'a V,
}

/// A function of a row of the table.
macro_rules! call {
    (other $($row:tt)*) => {};
    ([$item:ident; $count:ident] $length:ident $id:ident ($($name:tt)*) ($($argument:expr),*)) => {
        let mut list = vec![Zeroable::zeroed(); $length(FunctionId::$id)];
        $($name)*($($argument,)* &mut list);
        black_box(list);
    };
    (matrix $length:ident $id:ident ($($name:tt)*) ($($argument:expr),*)) => {
        let mut matrix = Default::default();
        $($name)*($($argument,)* &mut matrix);
        black_box(matrix);
    };
    ($result:ident $length:ident $id:ident ($($name:tt)*) ($($argument:expr),*)) => {
        black_box($($name)*($($argument),*));
    };
}

/// Calls the functions of all rows: of a module, with a crane, numbers of entries and arguments.
macro_rules! call_rows {
    ($of:ident $crane:ident $length:ident $at:ident $($trait:ident { $(
        $(#[doc = $remark:literal])*
        $id:ident = $name:ident($($argument:ident),*) -> $result:tt $rule:ident $doc:literal $equation:literal
        $(python($($python:tt)*))?;
    )* })*) => {
        $($(call! { $result $length $id ($of::$name) (&$crane $(, $at.$argument)*) })*)*
    };
}

/// Calls every function of a crane.
macro_rules! call_all {
    ($crane:ident) => {{
        use no_std_crane::$crane::{self as of, BaseMatrix, Crane, DESCRIPTION, LaneVector, Matrix, Vector};
        let mut crane = black_box(Crane::default());
        let (t, mut q, mut v) = black_box((0.5, Vector::repeat(0.3), Vector::repeat(0.1)));
        let length = |id: FunctionId| match id.extent() {
            Extent::List(_, count) => black_box(DESCRIPTION.count(&[], count)),
            _ => 0,
        };
        let mut mass = Matrix::zeros();
        let _ = black_box(of::set_parameter(&mut crane, black_box(0), black_box(400.0)));
        let _ = black_box(of::set_parameters(&mut crane, black_box(&[400.0])));
        of::prescribe(&crane, t, &mut q, &mut v);
        let positions = black_box(of::drive_positions(&crane, t));
        let at = At { t, q: &q, v: &v, a: &v, r: &v, positions: &positions };
        quantities! { @(call_rows) [of crane length at] }
        black_box(of::potential_energy(&crane, t, &q));
        black_box(of::mass_matrix_and_bias(&crane, &q, &v, &mut mass));
        let factors: <Crane as CraneModel<{ of::N }>>::Factors = of::factorise(&crane, &q, &v, &BaseMatrix::zeros());
        black_box(of::solve(&crane, &factors, &v));
        black_box(of::linearise(&crane, &q));
        let lanes = Crane::lanes([&crane; 8]);
        let [lane_q, lane_v] = [&q, &v].map(|x| LaneVector::from_iterator(x.iter().map(|x| splat(*x))));
        black_box(of::lane_forward_dynamics(&lanes, splat(t), &lane_q, &lane_v));
        let mut state = State { q, v };
        black_box(of::step(&crane, t, black_box(1e-4), &mut state));
        black_box((state, mass));
    }};
}

fn main() {
    call_all!(eight_link_flexible);
    call_all!(eight_link_hydraulic);
    call_all!(exact);
}
