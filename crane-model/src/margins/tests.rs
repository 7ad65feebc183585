//! Margins against closed forms, and stability against eigenvalues with a Padé approximation of the dead time.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{Complex, DMatrix, DVector};

use super::{Loop, Margins, NoMargins, NoMotions, Plant, Term, margins};
use crate::modes::eigenvalues;

mod motions;

fn plant(a: &[f64], b: &[f64], c: &[f64]) -> Plant {
    let n = b.len();
    let term = Term { power: 0, b: DVector::from_column_slice(b), d: 0.0 };
    Plant::new(&DMatrix::from_row_slice(n, n, a), vec![term], &DVector::from_column_slice(c)).unwrap()
}

fn found(plant: &Plant, of: &Loop) -> Margins {
    margins(plant, of).unwrap()
}

/// Bisections and golden sections end at rounding; minima are flat to its square root.
fn assert_close(what: &str, value: f64, expected: f64) {
    assert!((value - expected).abs() < 1e-7 * expected.abs().max(1e-3), "{what}: {value} for {expected}");
}

/// `L = k e^(−Ts)/s`: a phase margin of 90° − k T, a gain margin of π/(2 k T), stable up to k T = π/2.
#[test]
fn an_integrator_with_dead_time() {
    let integrator = plant(&[0.0], &[1.0], &[1.0]);
    for (k, delay) in [(2.0, 0.1), (5.0, 0.3), (5.0, 0.32)] {
        let of = Loop { p: k, delay, ..Loop::default() };
        let margins = found(&integrator, &of);
        let (phase, crossover) = margins.phase.unwrap();
        assert_close("phase", phase, FRAC_PI_2 - k * delay);
        assert_close("crossover", crossover, k);
        let factor = FRAC_PI_2 / (k * delay);
        let (gain, at) = if factor > 1.0 { margins.gain } else { margins.reduction }.unwrap();
        assert_close("gain", gain, factor);
        assert_close("at", at, FRAC_PI_2 / delay);
        assert_eq!(margins.stable, factor > 1.0, "{k} {delay}");
        assert_eq!(margins.unstable, if factor > 1.0 { 0 } else { 2 });
        // A pair of roots k e^(−Ts) = −s.
        let root = margins.closed.unwrap().unwrap();
        let residual = root + (-root * delay).exp() * k;
        assert!(residual.norm() < 1e-8, "{root}");
    }
}

/// `L = (p + d s)/s²`: ω⁴ = p² + d² ω², a phase margin of atan(d ω/p), a damping ratio of d/(2 √p).
#[test]
fn a_double_integrator_with_a_derivative() {
    let mass = plant(&[0.0, 1.0, 0.0, 0.0], &[0.0, 1.0], &[1.0, 0.0]);
    let (p, d) = (4.0_f64, 0.7_f64);
    let margins = found(&mass, &Loop { p, d, ..Loop::default() });
    let crossover = (0.5 * (d * d + (d.powi(4) + 4.0 * p * p).sqrt())).sqrt();
    let (phase, at) = margins.phase.unwrap();
    assert_close("crossover", at, crossover);
    assert_close("phase", phase, (d * crossover / p).atan());
    assert_close("damping", margins.damping().unwrap(), d / (2.0 * p.sqrt()));
    assert!(margins.stable && margins.gain.is_none());
    // A lead instead, (1 + a s)/(1 + b s): its phase where |L| = 1.
    let (a, b) = (0.8, 0.05);
    let margins = found(&mass, &Loop { p, lead: [a, b], ..Loop::default() });
    let (phase, at) = margins.phase.unwrap();
    assert_close("phase of the lead", phase, (a * at).atan() - (b * at).atan());
    assert_close("|L|", p * ((1.0 + (a * at).powi(2)) / (1.0 + (b * at).powi(2))).sqrt() / (at * at), 1.0);
    // Without either it oscillates: on the verge, neither counted as unstable nor damped.
    let margins = found(&mass, &Loop { p, ..Loop::default() });
    assert!(margins.stable && margins.damping().unwrap().abs() < 1e-9 && margins.distance.unwrap().0 < 1e-6);
}

/// An undamped mass on a spring, `p e^(−sT)/(m s² + k)` with a small p: the dead time turns the force, which drives the oscillation if
/// sin ω T > 0 and brakes it otherwise; to first order in p the root moves by p sin(ω T)/(2 m ω).
#[test]
fn a_mass_on_a_spring() {
    let (m, omega, p) = (2.0, 3.0, 0.05);
    let spring = plant(&[0.0, 1.0, -omega * omega, 0.0], &[0.0, 1.0 / m], &[1.0, 0.0]);
    for delay in [0.2, 0.7, 1.3, 1.9, 2.3, 3.9] {
        let margins = found(&spring, &Loop { p, delay, ..Loop::default() });
        let growth = p * (omega * delay).sin() / (2.0 * m * omega);
        assert_eq!(margins.unstable, if growth > 0.0 { 2 } else { 0 }, "{delay}");
        let root = margins.closed.unwrap().unwrap();
        // The second order is p/k of the first.
        assert!((root.re - growth).abs() < 0.02 * growth.abs(), "{delay}: {root} for {growth}");
    }
}

/// `1/(s − 1)`: unstable without the loop, stable with p > 1; the gain may fall to 1/p.
#[test]
fn an_unstable_plant() {
    let falling = plant(&[1.0], &[1.0], &[1.0]);
    for p in [0.5, 2.0, 8.0] {
        let margins = found(&falling, &Loop { p, ..Loop::default() });
        assert_eq!((margins.stable, margins.unstable), (p > 1.0, usize::from(p < 1.0)));
        let factor = if p > 1.0 { margins.reduction } else { margins.gain };
        assert_close("factor", factor.unwrap().0, 1.0 / p);
    }
}

/// The bandwidth of 1/(1 + s/k), the largest sensitivity of a second-order loop, and integral gains.
#[test]
fn bandwidth_and_distance() {
    let integrator = plant(&[0.0], &[1.0], &[1.0]);
    assert_close("bandwidth", found(&integrator, &Loop { p: 3.0, ..Loop::default() }).bandwidth.unwrap(), 3.0);
    // L = k/(s (1 + τ s)): |1 + L| with x = ω² has its minimum where its derivative is zero, here by a fine scan.
    let (k, lag) = (10.0, 0.2);
    let margins = found(&integrator, &Loop { p: k, lag, ..Loop::default() });
    let far = |omega: f64| {
        let s = Complex::new(0.0, omega);
        (Complex::from(k) / (s * (s * lag + 1.0)) + 1.0).norm()
    };
    let least = (1..400_000).map(|step| far(f64::from(step) * 1e-4)).fold(f64::INFINITY, f64::min);
    assert_close("distance", margins.distance.unwrap().0, least);
    // p + i/s around 1/s: s² + p s + i.
    let (p, i) = (1.2_f64, 3.0_f64);
    let margins = found(&integrator, &Loop { p, i, ..Loop::default() });
    assert_close("damping", margins.damping().unwrap(), p / (2.0 * i.sqrt()));
}

/// Velocity loops of a real timber crane, `(p + d s) e^(−0.065 s)/(1 + τ s) k/(s (M s² + d s + k))`, as its authors print them for axes without
/// stiffness of their own and with the pendulum locked: crossover, phase margin, gain margin in dB, bandwidth, whether it is stable
/// (`Geryyy/crane_model`, `doc/inner_loop_bandwidth.md`).
#[test]
fn margins_of_a_timber_crane_are_those_published() {
    let slew = [3.190_742e5, 7519.87, 0.1, 0.07, 0.004];
    let rotator = [7296.0, 483.672, 0.125, 2.35, 0.118];
    for (axis, mass, [crossover, phase, decibels, bandwidth], stable) in [
        (slew, 851.0, [0.07, 89.0, 43.8, 0.07], true),
        (slew, 13955.0, [0.07, 89.0, 18.9, 0.07], true),
        (slew, 69419.0, [0.07, 89.0, 4.1, 0.07], true),
        (slew, 159_590.0, [0.07, -53.0, -3.3, 0.07], false),
        (rotator, 65.0, [2.35, 62.0, 8.9, 5.66], true),
    ] {
        let [k, damping, lag, p, d] = axis;
        let body = plant(&[0.0, 1.0, -k / mass, -damping / mass], &[0.0, k / mass], &[1.0, 0.0]);
        let margins = found(&body, &Loop { p: d, i: p, delay: 0.065, lag, ..Loop::default() });
        let near = |found: f64, printed: f64, digit: f64| (found - printed).abs() <= digit;
        assert_eq!(margins.stable, stable, "{mass}");
        let (value, at) = margins.phase.unwrap();
        // Of the unstable loop another of several crossings is printed.
        assert!(!stable || near(value.to_degrees(), phase, 1.0), "{mass}: {} for {phase}", value.to_degrees());
        // The first crossing is printed, the one that counts is that of the phase.
        assert!(!stable || near(at, crossover, 0.011), "{mass}: {at} for {crossover}");
        let (factor, _) = if stable { margins.gain } else { margins.reduction }.unwrap();
        assert!(near(20.0 * factor.log10(), decibels, 0.16), "{mass}: {} for {decibels}", 20.0 * factor.log10());
        assert!(
            near(margins.bandwidth.unwrap(), bandwidth, 0.004 * bandwidth.max(2.0)),
            "{mass}: {:?}",
            margins.bandwidth
        );
    }
}

/// `p (s + 1)³ (s + 10)³/s⁷` passes the negative real numbers twice, with more than 1 both times: the loop comes first to the factor nearer to 1.
/// Its phase is 3 φ − 630° with `tan φ = 11 ω/(10 − ω²)`: −540° at φ = 30° and −180° at φ = 150°.
#[test]
fn the_nearest_of_two_reductions_counts() {
    let mut a = vec![0.0; 49];
    for row in 0..6 {
        a[7 * row + row + 1] = 1.0;
    }
    let zeros = [1000.0, 3300.0, 3930.0, 1991.0, 393.0, 33.0, 1.0];
    let plant = plant(&a, &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], &zeros);
    let p = 60.0;
    let margins = found(&plant, &Loop { p, ..Loop::default() });
    let root = 3.0_f64.sqrt();
    let factors = [-1.0, 1.0].map(|sign: f64| {
        let omega = 0.5 * ((11.0 * root).hypot(40.0_f64.sqrt()) + sign * 11.0 * root);
        let size = p * (10.0 - omega * omega).hypot(11.0 * omega).powi(3) / omega.powi(7);
        (1.0 / size, omega)
    });
    assert!(factors[0].0 < 1e-6 && factors[1].0 > 0.1 && factors[1].0 < 1.0, "{factors:?}");
    let (factor, at) = margins.reduction.unwrap();
    assert_close("reduction", factor, factors[1].0);
    assert_close("at", at, factors[1].1);
    assert!(margins.stable && margins.gain.is_none(), "{margins:?}");
}

#[test]
fn what_has_no_margins() {
    let integrator = plant(&[0.0], &[1.0], &[1.0]);
    assert_eq!(margins(&integrator, &Loop::default()), Err(NoMargins::NoLoop));
    let d = Loop { d: 2.0, ..Loop::default() };
    assert_eq!(margins(&integrator, &d), Err(NoMargins::Improper));
}

/// Coefficients of the Padé approximation of order k of e^(−x): numerator with alternating signs, denominator.
fn pade(order: usize) -> Vec<f64> {
    let mut coefficients = vec![1.0];
    for j in 1..=order {
        let ratio = (order + 1 - j) as f64 / ((2 * order + 1 - j) as f64 * j as f64);
        coefficients.push(coefficients[j - 1] * ratio);
    }
    coefficients
}

/// Number of eigenvalues to the right of `beyond` of the closed loop with a proportional and an integral gain, a lag, and a dead time of eighth order.
fn by_pade(a: &DMatrix<f64>, b: &DVector<f64>, c: &DVector<f64>, of: &Loop, beyond: f64) -> usize {
    const ORDER: usize = 8;
    let n = a.nrows();
    let (plant, integral, lag, delay) = (0, n, n + 1, n + 2);
    let size = n + 2 + ORDER;
    let mut matrix = DMatrix::zeros(size, size);
    matrix.view_mut((plant, plant), (n, n)).copy_from(a);
    // The plant receives the output of the lag.
    for row in 0..n {
        matrix[(row, lag)] = b[row];
    }
    // ė = −y
    for column in 0..n {
        matrix[(integral, column)] = -c[column];
    }
    // Controllable form of the approximation, with the last derivative last.
    let factors = pade(ORDER);
    let powers: Vec<f64> = std::iter::successors(Some(1.0), |power| Some(power * of.delay)).take(ORDER + 1).collect();
    let scale = powers[ORDER] * factors[ORDER];
    let denominator: Vec<f64> = (0..ORDER).map(|j| factors[j] * powers[j] / scale).collect();
    let sign = |j: usize| if j.is_multiple_of(2) { 1.0 } else { -1.0 };
    let through = sign(ORDER);
    let numerator: Vec<f64> = (0..ORDER).map(|j| (sign(j) - through) * denominator[j]).collect();
    for j in 0..ORDER - 1 {
        matrix[(delay + j, delay + j + 1)] = 1.0;
    }
    for j in 0..ORDER {
        matrix[(delay + ORDER - 1, delay + j)] = -denominator[j];
        matrix[(lag, delay + j)] = numerator[j] / of.lag;
    }
    // u = −p y + i ∫(−y)
    let mut command = DVector::zeros(size);
    command.rows_mut(0, n).copy_from(&(c * -of.p));
    command[integral] = of.i;
    for column in 0..size {
        matrix[(delay + ORDER - 1, column)] += command[column];
        matrix[(lag, column)] += through * command[column] / of.lag;
    }
    matrix[(lag, lag)] -= 1.0 / of.lag;
    let found = eigenvalues(matrix).unwrap();
    found.iter().filter(|root| root.re > beyond).map(|root| if root.im > 1e-9 { 2 } else { 1 }).sum()
}

/// Numbers from 0 to 1.
fn random_numbers(mut seed: u64) -> impl FnMut() -> f64 {
    move || {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Chains of masses, some unstable, some with integrators, with random gains: Nyquist's count is the number of unstable eigenvalues.
#[test]
fn the_count_is_that_of_eigenvalues() {
    let mut random = random_numbers(0x2545_f491_4f6c_dd1d);
    let (mut counts, mut complex) = ([0; 2], 0);
    for case in 0..400 {
        let masses = 1 + case % 4;
        let n = 2 * masses;
        let mut a = DMatrix::zeros(n, n);
        for mass in 0..masses {
            a[(mass, masses + mass)] = 1.0;
            let stiffness = [0.0, 30.0 * random(), 900.0 * random(), -3.0 * random()][(case / 4 + mass) % 4];
            a[(masses + mass, mass)] -= stiffness;
            // Every fifth mass is driven by its rate, as by a drive of falling characteristic: its poles are complex and unstable.
            let driven = (case / 16 + mass) % 5 == 0;
            a[(masses + mass, masses + mass)] -= if driven { -2.0 } else { 0.3 } * random();
            if mass > 0 {
                let [spring, damper] = [200.0 * random(), 0.2 * random()];
                for (own, other) in [(mass, mass - 1), (mass - 1, mass)] {
                    a[(masses + own, own)] -= spring;
                    a[(masses + own, other)] += spring;
                    a[(masses + own, masses + own)] -= damper;
                    a[(masses + own, masses + other)] += damper;
                }
            }
        }
        let mut b = DVector::zeros(n);
        b[masses] = 1.0;
        let mut c = DVector::zeros(n);
        c[if case % 3 == 0 { masses - 1 } else { 0 }] = 1.0;
        c[masses] = random();
        let of = Loop {
            p: 20.0 * random(),
            i: 5.0 * random(),
            delay: 0.15 * random() + 1e-3,
            lag: 0.2 * random() + 1e-3,
            ..Loop::default()
        };
        let plant = Plant::new(&a, vec![Term { power: 0, b: b.clone(), d: 0.0 }], &c).unwrap();
        let [left, right] = [0.5e-4, 2e-4].map(|beyond| by_pade(&a, &b, &c, &of, beyond));
        if left != right {
            continue; // On the line of the count.
        }
        let margins = margins(&plant, &of).unwrap();
        assert_eq!(margins.unstable, left, "case {case}: {of:?}");
        counts[usize::from(margins.stable)] += 1;
        complex += usize::from(plant.poles().iter().any(|pole| pole.re > 1e-4 && pole.im > 0.0));
        if let Some(root) = margins.closed.unwrap_or_else(|why| panic!("case {case}: {why}: {of:?}")) {
            let loop_gain = of.response(root) * plant.response(root);
            assert!((loop_gain + 1.0).norm() < 1e-6, "case {case}: {root}");
            assert_eq!(margins.damping().unwrap() < 0.0, !margins.stable, "case {case}: {root}");
        }
    }
    // Both kinds are among them.
    assert!(counts[0] > 50 && counts[1] > 20 && complex > 50, "{counts:?}, {complex}");
}
