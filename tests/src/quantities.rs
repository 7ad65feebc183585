//! Every quantity that a generated crane computes, as plain numbers in one order.

use crane_model::dyn_crane::Crane;
use crane_model::nalgebra::{Matrix4, SMatrix, SVector, Vector3};
use crane_model::rt::lanes::f64x8;
use crane_model::{Description, LaneDynamics, Linearisation, SectionModuli, Tension, TransformDerivatives, Wrench};

/// A quantity: its name and the shape of its numbers, row-major.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Quantity {
    /// Name, that of the generated function.
    pub name: &'static str,
    /// Extent of each index.
    pub shape: Vec<usize>,
}

impl Quantity {
    /// How many numbers.
    #[must_use]
    pub fn len(&self) -> usize {
        self.shape.iter().product()
    }

    /// Whether it has no numbers.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// The quantities of a crane, in order.
#[must_use]
pub fn quantities(crane: &Description) -> Vec<Quantity> {
    let n = crane.coordinates.len();
    let (bodies, points, supports, drives) =
        (crane.bodies.len(), crane.points.len(), crane.supports.len(), crane.drives.len());
    let (first, second) = derivative_counts(crane);
    let rows: Vec<(&'static str, Vec<usize>)> = vec![
        ("transforms", vec![bodies, 4, 4]),
        ("transform_derivatives", vec![first, 4, 4]),
        ("transform_second_derivatives", vec![second, 4, 4]),
        ("mass_matrix", vec![n, n]),
        ("bias", vec![n]),
        ("mass_matrix_lower", vec![n, n]),
        ("bias_with_mass_matrix", vec![n]),
        ("forces", vec![n]),
        ("support_forces", vec![n]),
        ("element_forces", vec![n]),
        ("drive_forces", vec![n]),
        ("joint_damper_forces", vec![n]),
        ("stop_forces", vec![n]),
        ("friction_forces", vec![n]),
        ("load_forces", vec![n]),
        ("drive_forces_at_rest", vec![n]),
        ("forward_dynamics", vec![n]),
        ("mass_solution", vec![n]),
        ("implicit_solution", vec![n]),
        ("lane_forward_dynamics", vec![n]),
        ("kinetic_energy", vec![1]),
        ("gravity_energy", vec![1]),
        ("support_energy", vec![1]),
        ("element_energy", vec![1]),
        ("drive_energy", vec![1]),
        ("stop_energy", vec![1]),
        ("static_residual", vec![n]),
        ("tangent_stiffness", vec![n, n]),
        ("linearised_mass", vec![n, n]),
        ("linearised_stiffness", vec![n, n]),
        ("linearised_damping", vec![n, n]),
        ("points", vec![points, 3]),
        ("point_velocities", vec![points, 3]),
        ("support_reactions", vec![supports, 3]),
        ("support_gaps", vec![supports, 2]),
        ("cylinder_states", vec![crane.cylinders.len(), 3]),
        ("drive_limits", vec![drives, 2]),
        ("drive_motions", vec![drives, 2]),
        ("valve_openings", vec![drives, 2]),
        ("drive_power", vec![1]),
        ("dissipation", vec![1]),
        ("prescribed", vec![2, n]),
        ("nonlinear_stiffness_and_damping", vec![n, 2]),
        ("internal_forces", vec![crane.cuts().len(), 6]),
        ("support_positions", vec![supports, 3]),
        ("section_moduli", vec![crane.sections.len(), 8]),
        ("load_power", vec![1]),
        ("connector_forces", vec![n]),
        ("connector_lengths", vec![crane.connectors.len(), 2]),
        ("connector_tensions", vec![crane.connectors.len(), 3]),
        ("connector_jacobians", vec![crane.connectors.len(), n]),
        ("connector_energy", vec![1]),
        ("winch_power", vec![1]),
        ("connector_wrenches", vec![crane.connectors.len(), crane.cuts().len(), 6]),
        ("cylinder_jacobians", vec![crane.cylinders.len(), n]),
        ("cylinder_wrenches", vec![crane.cylinders.len(), crane.cuts().len(), 6]),
    ];
    rows.into_iter().map(|(name, shape)| Quantity { name, shape }).collect()
}

/// How many first and second derivatives of transforms a crane has.
fn derivative_counts(crane: &Description) -> (usize, usize) {
    let degrees = crane.bodies.iter().map(|body| body.degrees_of_freedom);
    (degrees.clone().sum(), degrees.map(|n| n * (n + 1) / 2).sum())
}

/// A state: time, coordinates, velocities.
#[derive(Clone, Debug)]
pub struct State {
    /// Time, s.
    pub t: f64,
    /// Coordinates.
    pub q: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
}

/// All quantities of a generated crane at a state, one after the other.
pub fn evaluate<const N: usize, C: Crane<N> + TransformDerivatives<N>>(crane: &C, state: &State) -> Vec<f64> {
    let (t, q, v) =
        (state.t, &SVector::<f64, N>::from_column_slice(&state.q), &SVector::<f64, N>::from_column_slice(&state.v));
    let info = crane.description();
    let (first, second) = derivative_counts(info);
    let held = &crane.drive_positions(t);
    let mut out = Vec::new();

    let mut transforms = vec![Matrix4::zeros(); info.bodies.len()];
    crane.transforms(q, &mut transforms);
    push_matrices(&mut out, &transforms);
    let mut derivatives = vec![Matrix4::zeros(); first];
    crane.transform_derivatives(q, &mut derivatives);
    push_matrices(&mut out, &derivatives);
    let mut derivatives = vec![Matrix4::zeros(); second];
    crane.transform_second_derivatives(q, &mut derivatives);
    push_matrices(&mut out, &derivatives);

    push_matrix(&mut out, &crane.mass_matrix(q));
    let bias = crane.bias(q, v);
    let mut lower = SMatrix::zeros();
    let with_mass_matrix = crane.mass_matrix_and_bias(q, v, &mut lower);
    out.extend(bias.iter());
    push_matrix(&mut out, &lower.lower_triangle());
    for vector in [
        with_mass_matrix,
        crane.forces(t, q, v),
        crane.support_forces(q, v),
        crane.element_forces(q, v),
        crane.drive_forces(t, q, v),
        crane.joint_damper_forces(v),
        crane.stop_forces(q, v),
        crane.friction_forces(v),
        crane.load_forces(t, q),
        crane.drive_forces_at_rest(t, q, held),
        crane.forward_dynamics(t, q, v),
        crane.solve_mass(q, v),
        implicit_solution(crane, q, v),
        in_a_lane(crane, t, q, v),
    ] {
        out.extend(vector.iter());
    }
    out.extend([
        crane.kinetic_energy(q, v),
        crane.gravity_energy(q),
        crane.support_energy(q),
        crane.element_energy(q),
        crane.drive_energy(t, q),
        crane.stop_energy(q),
    ]);
    out.extend(crane.static_residual(t, q, held).iter());
    push_matrix(&mut out, &crane.tangent_stiffness(t, q, held));
    let Linearisation { mass, stiffness, damping } = crane.linearise(q);
    for matrix in [mass, stiffness, damping] {
        push_matrix(&mut out, &matrix);
    }
    let mut points = vec![Vector3::zeros(); info.points.len()];
    crane.points(q, &mut points);
    out.extend(points.iter().flatten());
    crane.point_velocities(q, v, &mut points);
    out.extend(points.iter().flatten());
    let mut reactions = vec![Vector3::zeros(); info.supports.len()];
    crane.support_reactions(q, v, &mut reactions);
    out.extend(reactions.iter().flatten());
    let mut gaps = vec![[0.0; 2]; info.supports.len()];
    crane.support_gaps(q, v, &mut gaps);
    out.extend(gaps.iter().flatten());
    let mut cylinders = vec![Vector3::zeros(); info.cylinders.len()];
    crane.cylinder_states(q, v, &mut cylinders);
    out.extend(cylinders.iter().flatten());
    let mut motions = vec![[0.0; 2]; info.drives.len()];
    crane.drive_limits(t, q, v, &mut motions);
    out.extend(motions.iter().flatten());
    crane.drive_motions(t, &mut motions);
    out.extend(motions.iter().flatten());
    motions.fill([0.0; 2]);
    crane.valve_openings(t, &mut motions);
    out.extend(motions.iter().flatten());
    out.extend([crane.drive_power(t, q, v), crane.dissipation(t, q, v)]);
    let mut wrenches = vec![Wrench::ZERO; info.cuts().len()];
    // The rates also serve as accelerations.
    crane.internal_forces(t, q, v, v, &mut wrenches);
    crane.support_positions(q, &mut reactions);
    let mut moduli = vec![SectionModuli::ZERO; info.sections.len()];
    crane.section_moduli(&mut moduli);
    let mut tangents = vec![[0.0; 2]; info.coordinates.len()];
    crane.nonlinear_stiffness_and_damping(t, q, v, &mut tangents);
    let load_power = crane.load_power(t, q, v);
    let mut connectors_and_cylinders = of_connectors(crane, t, q, v);
    connectors_and_cylinders.extend(of_cylinders(crane, q));
    let (mut q, mut v) = (*q, *v);
    crane.prescribe(t, &mut q, &mut v);
    out.extend(q.iter().chain(&v));
    out.extend(tangents.iter().flatten());
    out.extend(flat(&wrenches));
    out.extend(reactions.iter().flatten());
    for of in moduli {
        let SectionModuli { area, bending_y, bending_z, torsion, shear_y, shear_z, corners, allowable_stress } = of;
        out.extend([area, bending_y, bending_z, torsion, shear_y, shear_z, corners, allowable_stress]);
    }
    out.push(load_power);
    out.extend(connectors_and_cylinders);
    out
}

/// The numbers of wrenches.
fn flat(wrenches: &[Wrench]) -> impl Iterator<Item = &f64> {
    wrenches.iter().flat_map(|wrench| wrench.force.iter().chain(&wrench.moment))
}

/// The quantities of connectors.
fn of_connectors<const N: usize, C: Crane<N>>(crane: &C, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> Vec<f64> {
    let count = crane.description().connectors.len();
    let (mut lengths, mut tensions) = (vec![[0.0; 2]; count], vec![Tension::ZERO; count]);
    let mut jacobians = vec![[0.0; N]; count];
    crane.connector_lengths(q, v, &mut lengths);
    crane.connector_tensions(t, q, v, &mut tensions);
    crane.connector_jacobians(q, &mut jacobians);
    let mut out = Vec::new();
    out.extend(&crane.connector_forces(t, q, v));
    out.extend(lengths.iter().flatten());
    out.extend(tensions.iter().flat_map(|tension| [tension.force, tension.stiffness, tension.damping]));
    out.extend(jacobians.iter().flatten());
    out.extend([crane.connector_energy(t, q), crane.winch_power(t, q, v)]);
    let mut wrenches = vec![Wrench::ZERO; count * crane.description().cuts().len()];
    crane.connector_wrenches(q, &mut wrenches);
    out.extend(flat(&wrenches));
    out
}

/// What cylinders do in directions besides that of their joint.
fn of_cylinders<const N: usize, C: Crane<N>>(crane: &C, q: &SVector<f64, N>) -> Vec<f64> {
    let count = crane.description().cylinders.len();
    let mut jacobians = vec![[0.0; N]; count];
    let mut wrenches = vec![Wrench::ZERO; count * crane.description().cuts().len()];
    crane.cylinder_jacobians(q, &mut jacobians);
    crane.cylinder_wrenches(q, &mut wrenches);
    let mut out: Vec<f64> = jacobians.into_iter().flatten().collect();
    out.extend(flat(&wrenches));
    out
}

/// Step of the implicit solution among the quantities, s.
pub const IMPLICIT_STEP: f64 = 0.01;

/// x of `(A + h D + h² K) x = v`, D and K without gravity.
fn implicit_solution<const N: usize, C: Crane<N>>(
    crane: &C,
    q: &SVector<f64, N>,
    v: &SVector<f64, N>,
) -> SVector<f64, N> {
    let h = IMPLICIT_STEP;
    let mut joints = [[0.0; 2]; N];
    crane.joint_stiffness_and_damping(&mut joints);
    let added_inertia = SVector::from_fn(|i, _| h * joints[i][1] + h * h * joints[i][0]);
    let base = crane.base_damping(q, v) * h + crane.base_stiffness(q, v) * (h * h);
    crane.solve(&crane.factorise(q, &added_inertia, &base), v)
}

/// Accelerations of the crane in the third lane of eight; the other lanes are in other states.
fn in_a_lane<const N: usize, C: Crane<N>>(
    crane: &C,
    t: f64,
    q: &SVector<f64, N>,
    v: &SVector<f64, N>,
) -> SVector<f64, N> {
    let lanes = |x: &SVector<f64, N>| x.map(|x| f64x8::new(std::array::from_fn(|lane| x * (0.8 + 0.1 * lane as f64))));
    let accelerations = C::lanes([crane; 8]).forward_dynamics(f64x8::splat(t), &lanes(q), &lanes(v));
    accelerations.map(|x| x.to_array()[2])
}

fn push_matrices(out: &mut Vec<f64>, matrices: &[Matrix4<f64>]) {
    for matrix in matrices {
        out.extend(matrix.transpose().iter());
    }
}

fn push_matrix<const N: usize>(out: &mut Vec<f64>, matrix: &SMatrix<f64, N, N>) {
    out.extend(matrix.transpose().iter());
}
