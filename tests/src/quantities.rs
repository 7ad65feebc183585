//! Every quantity that a generated crane computes, as plain numbers in one order: what the proofs of equality to the interpreter and of no
//! allocation, and the check with CasADi, go through.

use bytemuck::{Pod, Zeroable, cast_slice, cast_slice_mut};
use crane_codegen::program::{Extent, FunctionId, Item};
use crane_model::nalgebra::{Matrix4, SMatrix, SVector, Vector3};
use crane_model::rt::lanes::f64x8;
use crane_model::{CraneModel, Description, LaneDynamics, Linearisation, SectionModuli, Tension, Wrench};
use crane_quantities::quantities;

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

/// The quantities of a crane, in order: those of the table, then others that are computed by several functions or in another way.
#[must_use]
pub fn quantities(crane: &Description) -> Vec<Quantity> {
    let n = crane.coordinates.len();
    let of_table = FunctionId::ALL.iter().filter(|id| id.extent() != Extent::Other).map(|id| Quantity {
        name: id.name(),
        // A number is a list of one.
        shape: match id.extent() {
            Extent::Number => vec![1],
            // No crane here has loops.
            extent => extent.shape(n, |count| crane.count(&[], count)).collect(),
        },
    });
    let others = [
        ("mass_matrix_lower", vec![n, n]),
        ("bias_with_mass_matrix", vec![n]),
        ("implicit_solution", vec![n]),
        ("lane_forward_dynamics", vec![n]),
        ("linearised_mass", vec![n, n]),
        ("linearised_stiffness", vec![n, n]),
        ("linearised_damping", vec![n, n]),
        ("prescribed", vec![2, n]),
    ];
    of_table.chain(others.map(|(name, shape)| Quantity { name, shape })).collect()
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

/// The arguments of functions, by their names in the table.
#[derive(Clone, Copy, Debug)]
#[expect(missing_docs, reason = "the names of the table")]
pub struct At<'a, const N: usize> {
    pub t: f64,
    pub q: &'a SVector<f64, N>,
    pub v: &'a SVector<f64, N>,
    pub a: &'a SVector<f64, N>,
    pub r: &'a SVector<f64, N>,
    pub positions: &'a SVector<f64, N>,
}

/// Lists for results, one per item of the table, as long as the longest of a crane.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "the names of the table")]
pub struct Lists<const N: usize> {
    pub vector: Vec<Vector3<f64>>,
    pub pair: Vec<[f64; 2]>,
    pub row: Vec<[f64; N]>,
    pub tension: Vec<Tension>,
    pub wrench: Vec<Wrench>,
    pub moduli: Vec<SectionModuli>,
    pub transform: Vec<Matrix4<f64>>,
}

impl<const N: usize> Lists<N> {
    /// The lists of a crane.
    pub fn new(crane: &impl CraneModel<N>) -> Self {
        fn list<T: Zeroable + Clone>(lengths: &[(Item, usize)], item: Item) -> Vec<T> {
            let of_item = lengths.iter().filter(|(of, _)| *of == item);
            vec![T::zeroed(); of_item.map(|(_, length)| *length).max().unwrap_or_default()]
        }
        let length = |id: &FunctionId| match id.extent() {
            Extent::List(item, count) => Some((item, crane.description().count(crane.loop_joints(), count))),
            _ => None,
        };
        let lengths: Vec<_> = FunctionId::ALL.iter().filter_map(length).collect();
        Self {
            vector: list(&lengths, Item::Vector),
            pair: list(&lengths, Item::Pair),
            row: list(&lengths, Item::Row),
            tension: list(&lengths, Item::Tension),
            wrench: list(&lengths, Item::Wrench),
            moduli: list(&lengths, Item::Moduli),
            transform: list(&lengths, Item::Transform),
        }
    }
}

/// Calls a method.
macro_rules! call {
    (other $($row:tt)*) => {};
    ([transform; $count:ident] $crane:ident $lists:ident $visit:ident $id:ident $name:ident($($argument:expr),*)) => {
        let list = part(&mut $lists.transform, $crane, FunctionId::$id);
        $crane.$name($($argument,)* list);
        $visit(FunctionId::$id, &mut list.iter().flat_map(|matrix| (0..16).map(|index| matrix[(index / 4, index % 4)])));
    };
    ([$item:ident; $count:ident] $crane:ident $lists:ident $visit:ident $id:ident $name:ident($($argument:expr),*)) => {
        let list = part(&mut $lists.$item, $crane, FunctionId::$id);
        $crane.$name($($argument,)* list);
        $visit(FunctionId::$id, &mut cast_slice::<_, f64>(list).iter().copied());
    };
    (number $crane:ident $lists:ident $visit:ident $id:ident $name:ident($($argument:expr),*)) => {
        $visit(FunctionId::$id, &mut std::iter::once($crane.$name($($argument),*)));
    };
    (matrix $crane:ident $lists:ident $visit:ident $id:ident $name:ident($($argument:expr),*)) => {
        // With other contents.
        let mut matrix = SMatrix::<f64, N, N>::repeat(f64::NAN);
        $crane.$name($($argument,)* &mut matrix);
        $visit(FunctionId::$id, &mut matrix.transpose().iter().copied());
    };
    ($numbers:ident $crane:ident $lists:ident $visit:ident $id:ident $name:ident($($argument:expr),*)) => {
        $visit(FunctionId::$id, &mut $crane.$name($($argument),*).transpose().iter().copied());
    };
}

/// Calls every method of the table and passes its numbers on, matrices row by row; allocates nothing.
pub fn call_every<const N: usize, C: CraneModel<N>>(
    crane: &C,
    at: &At<'_, N>,
    lists: &mut Lists<N>,
    visit: &mut dyn FnMut(FunctionId, &mut dyn Iterator<Item = f64>),
) {
    macro_rules! call_rows {
        ($($trait:ident { $(
            $(#[doc = $remark:literal])*
            $id:ident = $name:ident($($argument:ident),*) -> $result:tt $rule:ident $doc:literal $equation:literal
            $(python($($python:tt)*))?;
        )* })*) => {
            $($(call! { $result crane lists visit $id $name($(at.$argument),*) })*)*
        };
    }
    quantities! { call_rows }
}

/// The part of a list that a function writes, with other contents.
fn part<'a, const N: usize, T: Pod>(list: &'a mut [T], crane: &impl CraneModel<N>, id: FunctionId) -> &'a mut [T] {
    let Extent::List(_, count) = id.extent() else { return &mut [] };
    let part = &mut list[..crane.description().count(crane.loop_joints(), count)];
    cast_slice_mut::<_, f64>(part).fill(f64::NAN);
    part
}

/// All quantities of a generated crane at a state, one after the other.
pub fn evaluate<const N: usize, C: CraneModel<N>>(crane: &C, state: &State) -> Vec<f64> {
    let (t, q, v) =
        (state.t, &SVector::<f64, N>::from_column_slice(&state.q), &SVector::<f64, N>::from_column_slice(&state.v));
    let mut out = Vec::new();
    // The rates also serve as accelerations and as the right-hand side.
    let at = At { t, q, v, a: v, r: v, positions: &crane.drive_positions(t) };
    call_every(crane, &at, &mut Lists::new(crane), &mut |_, numbers| out.extend(numbers));

    let mut lower = SMatrix::zeros();
    let with_mass_matrix = crane.mass_matrix_and_bias(q, v, &mut lower);
    push_matrix(&mut out, &lower.lower_triangle());
    for vector in [with_mass_matrix, implicit_solution(crane, q, v), in_a_lane(crane, t, q, v)] {
        out.extend(vector.iter());
    }
    let Linearisation { mass, stiffness, damping } = crane.linearise(q);
    for matrix in [mass, stiffness, damping] {
        push_matrix(&mut out, &matrix);
    }
    let (mut q, mut v) = (*q, *v);
    crane.prescribe(t, &mut q, &mut v);
    out.extend(q.iter().chain(&v));
    out
}

/// Step of the implicit solution among the quantities, s.
pub const IMPLICIT_STEP: f64 = 0.01;

/// x of `(A + h D + h² K) x = v`, D and K without gravity.
fn implicit_solution<const N: usize, C: CraneModel<N>>(
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
fn in_a_lane<const N: usize, C: CraneModel<N>>(
    crane: &C,
    t: f64,
    q: &SVector<f64, N>,
    v: &SVector<f64, N>,
) -> SVector<f64, N> {
    let lanes = |x: &SVector<f64, N>| x.map(|x| f64x8::new(std::array::from_fn(|lane| x * (0.8 + 0.1 * lane as f64))));
    let accelerations = C::lanes([crane; 8]).forward_dynamics(f64x8::splat(t), &lanes(q), &lanes(v));
    accelerations.map(|x| x.to_array()[2])
}

fn push_matrix<const N: usize>(out: &mut Vec<f64>, matrix: &SMatrix<f64, N, N>) {
    out.extend(matrix.transpose().iter());
}
