//! A and e by the published sums over T, ∂T/∂q and ∂²T/∂q∂q: a baseline for the formulation of the generated functions.

use crane_codegen::chain::{Chain, Inertia};
use crane_codegen::{SourceFile, compile};
use crane_model::CraneModel;
use crane_model::nalgebra::{Matrix4, SMatrix, SVector, Vector3};
use crane_model::rt::fma;

use crate::kernel::Numbers;

/// A body: how many coordinates move it, and its pseudo-inertia H.
struct Body {
    degrees_of_freedom: usize,
    pseudo_inertia: Matrix4<f64>,
}

/// The sums of [Urbaś 2016, Eqs. (5), (7) and (9)], terms with n > m counted twice.
pub struct TripleSum {
    gravity: Vector3<f64>,
    bodies: Vec<Body>,
}

/// A and e, with room for intermediate results.
pub struct Sums<const N: usize> {
    mass_matrix: SMatrix<f64, N, N>,
    bias: SVector<f64, N>,
    first: Vec<Matrix4<f64>>,
    second: Vec<Matrix4<f64>>,
    /// `∂T/∂q_i H` of one body, one row per entry and one column per coordinate i.
    momenta: [[f64; N]; 16],
}

impl TripleSum {
    /// Inertias and gravity of a spec, with the parameters at their defaults; `None` for a spec with mistakes.
    #[must_use]
    pub fn read(spec: &str) -> Option<Self> {
        let source = SourceFile::from_bytes("spec".to_owned(), spec.as_bytes()).ok()?;
        let chain = compile::load(&source).ok()?;
        let parameters = chain.parameter_defaults();
        Some(Self {
            gravity: Vector3::from_fn(|i, _| chain.gravity[i].at(&parameters)),
            bodies: bodies(&chain, &parameters),
        })
    }

    /// Zeros of the right size.
    #[must_use]
    pub fn workspace<const N: usize>(&self) -> Sums<N> {
        let counts = self.bodies.iter().map(|body| body.degrees_of_freedom);
        Sums {
            mass_matrix: SMatrix::zeros(),
            bias: SVector::zeros(),
            first: vec![Matrix4::zeros(); counts.clone().sum()],
            second: vec![Matrix4::zeros(); counts.map(|n| n * (n + 1) / 2).sum()],
            momenta: [[0.0; N]; 16],
        }
    }

    /// A and e at a state.
    pub fn evaluate<const N: usize, C: CraneModel<N>>(
        &self,
        crane: &C,
        q: &SVector<f64, N>,
        v: &SVector<f64, N>,
        sums: &mut Sums<N>,
    ) {
        crane.transform_derivatives(q, &mut sums.first);
        crane.transform_second_derivatives(q, &mut sums.second);
        sums.mass_matrix.fill(0.0);
        sums.bias.fill(0.0);
        let (mut first, mut second) = (&sums.first[..], sums.second.iter());
        for body in &self.bodies {
            let count = body.degrees_of_freedom;
            let (derivatives, further) = first.split_at(count);
            first = further;
            sums.momenta = [[0.0; N]; 16];
            for (i, derivative) in derivatives.iter().enumerate() {
                let momentum = derivative * body.pseudo_inertia;
                for (row, entry) in sums.momenta.iter_mut().zip(&momentum) {
                    row[i] = *entry;
                }
                sums.bias[i] += self.gravity.dot(&momentum.fixed_view::<3, 1>(0, 3));
            }
            for (j, derivative) in derivatives.iter().enumerate() {
                add_products(&mut sums.mass_matrix.data.0[j], 1.0, &sums.momenta, derivative);
            }
            for m in 0..count {
                for (n, derivative) in (m..count).zip(&mut second) {
                    let twice = if n > m { 2.0 } else { 1.0 };
                    add_products(&mut sums.bias.data.0[0], -twice * v[m] * v[n], &sums.momenta, derivative);
                }
            }
        }
    }
}

impl<const N: usize> Numbers for Sums<N> {
    fn append_to(&self, numbers: &mut Vec<f64>) {
        self.mass_matrix.append_to(numbers);
        self.bias.append_to(numbers);
    }
}

fn bodies(chain: &Chain, parameters: &[f64]) -> Vec<Body> {
    let body = |(p, body): (usize, &crane_codegen::chain::Body)| Body {
        degrees_of_freedom: chain.degrees_of_freedom(crane_codegen::chain::BodyId(p)),
        pseudo_inertia: body
            .inertia
            .as_ref()
            .map_or_else(Matrix4::zeros, |inertia| pseudo_inertia(inertia, parameters)),
    };
    chain.bodies.iter().enumerate().map(body).collect()
}

/// H of Eq. (4).
fn pseudo_inertia(inertia: &Inertia, parameters: &[f64]) -> Matrix4<f64> {
    let [xx, yy, zz, xy, xz, yz] = [0, 1, 2, 3, 4, 5].map(|i| inertia.second[i].at(parameters));
    let [x, y, z] = [0, 1, 2].map(|i| inertia.first[i].at(parameters));
    Matrix4::new(xx, xy, xz, x, xy, yy, yz, y, xz, yz, zz, z, x, y, z, inertia.mass.at(parameters))
}

/// Adds `factor · tr(∂T/∂q_i H Bᵀ)` for all i.
fn add_products<const N: usize>(sums: &mut [f64; N], factor: f64, momenta: &[[f64; N]; 16], matrix: &Matrix4<f64>) {
    let mut products = [0.0; N];
    for (row, entry) in momenta.iter().zip(matrix) {
        for i in 0..N {
            products[i] = fma(row[i], *entry, products[i]);
        }
    }
    for i in 0..N {
        sums[i] = fma(products[i], factor, sums[i]);
    }
}
