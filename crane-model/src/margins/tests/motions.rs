//! Motions of closed loops against zeros that are found from a dense grid and counted by the argument principle.

use nalgebra::{Complex, DMatrix, DVector};

use super::{Loop, Margins, NoMotions, Plant, Term, found, random_numbers};

type Number = Complex<f64>;

/// A turntable on a drive, with the moment of inertia `inertia`, and an arm of 200 kg m² on a drive of 8e3 N m/rad and 20 N m s/rad about the
/// same axis; a loop moves the rate of the turntable's motion and measures its angle.
#[derive(Clone, Copy)]
struct Turntable {
    stiffness: f64,
    damping: f64,
    inertia: f64,
}

const ARM: [f64; 3] = [200.0, 20.0, 8e3];

impl Turntable {
    fn plant(self) -> Plant {
        let Self { stiffness: k, damping: d, inertia: j } = self;
        let [arm, arm_damping, arm_stiffness] = ARM;
        // Angles of the turntable and of the arm on it, and their rates.
        let [by_turntable, by_arm] = [[-k / j, -d / j], [arm_stiffness / j, arm_damping / j]];
        let a = DMatrix::from_row_slice(
            4,
            4,
            &[
                0.0,
                0.0,
                1.0,
                0.0,
                0.0,
                0.0,
                0.0,
                1.0,
                by_turntable[0],
                by_arm[0],
                by_turntable[1],
                by_arm[1],
                -by_turntable[0],
                -by_arm[0] - arm_stiffness / arm,
                -by_turntable[1],
                -by_arm[1] - arm_damping / arm,
            ],
        );
        let along = |by: f64| DVector::from_column_slice(&[0.0, 0.0, by, -by]);
        let terms = vec![Term { power: -1, b: along(k / j), d: 0.0 }, Term { power: 0, b: along(d / j), d: 0.0 }];
        Plant::new(&a, terms, &DVector::from_column_slice(&[1.0, 0.0, 0.0, 0.0])).unwrap()
    }

    /// Denominator and numerator of the open loop without its dead time, from the equations of motion.
    fn fraction(self, of: &Loop, s: Number) -> [Number; 2] {
        let [arm, arm_damping, arm_stiffness] = ARM;
        let holding = s * self.damping + self.stiffness;
        let [of_arm, drive] = [s * s * arm, s * arm_damping + arm_stiffness];
        let body = (s * s * self.inertia + holding) * (of_arm + drive) + of_arm * drive;
        let [above, below] = of.lead.map(|time| s * time + 1.0);
        let filter = s * of.filter + 1.0;
        let (gains, integral) = if of.i == 0.0 {
            (filter * of.p + s * of.d, Complex::from(1.0))
        } else {
            (filter * (s * of.p + of.i) + s * s * of.d, s)
        };
        [body * s * integral * filter * below * (s * of.lag + 1.0), gains * above * holding * (of_arm + drive)]
    }

    /// What is zero where 1 + L is, without poles.
    fn zero(self, of: &Loop, s: Number) -> Number {
        let [below, above] = self.fraction(of, s);
        below + above * (-s * of.delay).exp()
    }

    /// The highest frequency with |L| ≥ 0.1: L falls beyond its last resonance.
    fn highest(self, of: &Loop) -> f64 {
        let size = |omega: f64| {
            let [below, above] = self.fraction(of, Complex::new(0.0, omega));
            (above / below).norm()
        };
        let grid = (0..4000).rev().map(|k| 1e-2 * 1e6_f64.powf(f64::from(k) / 4000.0));
        let [mut within, mut beyond] = [grid.into_iter().find(|omega| size(*omega) >= 0.1).unwrap(), 1e4];
        for _ in 0..60 {
            let middle = 0.5 * (within + beyond);
            if size(middle) >= 0.1 { within = middle } else { beyond = middle }
        }
        within
    }

    /// The zeros with Im s ≥ 0 in a rectangle about the real axis.
    fn zeros(self, of: &Loop, [left, right, high]: [f64; 3]) -> Vec<Number> {
        const GRID: i32 = 24;
        let mut all: Vec<Number> = Vec::new();
        for (row, column) in (0..=GRID).flat_map(|row| (0..=GRID).map(move |column| (row, column))) {
            let part = |k: i32| f64::from(k) / f64::from(GRID);
            let mut s = Complex::new(left + part(column) * (right - left), part(row) * high);
            let mut found = false;
            for _ in 0..60 {
                let h = 1e-6 * s.norm().max(1e-3);
                let slope = (self.zero(of, s + h) - self.zero(of, s - h)) / (2.0 * h);
                let step = self.zero(of, s) / slope;
                s -= step;
                found = step.norm() < 1e-9 * s.norm();
                if !s.is_finite() || step.norm() < 1e-13 * s.norm() {
                    break;
                }
            }
            let s = Complex::new(s.re, if s.im.abs() < 1e-9 * s.norm() { 0.0 } else { s.im.abs() });
            let inside = found && s.re > left && s.re < right && s.im <= high;
            if inside && all.iter().all(|known| (known - s).norm() > 1e-7 * s.norm()) {
                all.push(s);
            }
        }
        all
    }

    /// How many zeros the rectangle has: the turns of the function along its edge.
    fn count(self, of: &Loop, [left, right, high]: [f64; 3]) -> f64 {
        const STEPS: i32 = 4000;
        let corners = [(left, -high), (right, -high), (right, high), (left, high), (left, -high)]
            .map(|(x, y)| Complex::new(x, y));
        let mut turned = 0.0;
        for pair in corners.windows(2) {
            let at = |k: i32| self.zero(of, pair[0] + (pair[1] - pair[0]) * (f64::from(k) / f64::from(STEPS)));
            turned += (0..STEPS).map(|k| (at(k + 1) / at(k)).arg()).sum::<f64>();
        }
        turned / std::f64::consts::TAU
    }
}

fn damping(root: Number) -> f64 {
    -root.re / root.norm()
}

/// An unstable loop in which the fastest growth is far from the axis, one with two motions, and a stable one that amplifies disturbances by 1.7:
/// zeros by Newton's method on 1 + L in another program, with residuals below 2e-16, printed with four digits.
#[test]
fn the_least_damped_motion_may_be_far_from_the_axis() {
    let of = |p: f64, delay: f64, lag: f64| Loop { p, delay, lag, ..Loop::default() };
    for (numbers, of, stable, zeta, root) in [
        ([8730.0, 126.0, 2106.0], of(8.803, 0.0213, 0.086), false, -0.4528, [1.453, 2.861]),
        ([4e4, 600.0, 1000.0], of(6.0, 0.06, 0.05), false, -0.239, [1.397, 5.681]),
        ([4648.0, 9281.0, 395.0], of(3.096, 0.0743, 0.0757), true, 0.147, [-0.920, 6.213]),
    ] {
        let [stiffness, damping, inertia] = numbers;
        let margins = found(&Turntable { stiffness, damping, inertia }.plant(), &of);
        assert_eq!(margins.stable, stable);
        let closed = margins.closed.unwrap().unwrap();
        assert!((margins.damping().unwrap() - zeta).abs() < 6e-4, "{closed}");
        assert!((closed - Complex::new(root[0], root[1])).norm() < 1e-3, "{closed}");
    }
}

/// Random loops: the least damping is that of all zeros up to the highest frequency with |L| ≥ 0.1, which the argument principle counts. None is left
/// out: a loop without a damping fails. `CRANE_THOROUGH=1` tries 400, `CRANE_SEED=7` others.
#[test]
fn the_least_damping_is_that_of_all_motions() {
    let loops = if std::env::var_os("CRANE_THOROUGH").is_some() { 400 } else { 36 };
    let seed = std::env::var("CRANE_SEED").ok().and_then(|seed| seed.parse().ok());
    let mut random = random_numbers(seed.unwrap_or(0x9e37_79b9_7f4a_7c15));
    let mut kinds = [0; 2];
    for case in 0..loops {
        let mut between = |low: f64, high: f64| low * (high / low).powf(random());
        let table =
            Turntable { stiffness: between(4e3, 4e4), damping: between(100.0, 1e4), inertia: between(300.0, 3000.0) };
        let p = between(0.5, 10.0);
        let (delay, lag) = (between(0.01, 0.1), between(0.01, 0.1));
        let mut of = Loop { p, delay, lag, ..Loop::default() };
        match case % 4 {
            1 => of.i = p * between(0.05, 2.0),
            2 => (of.d, of.filter) = (p * between(0.01, 0.3), between(0.005, 0.05)),
            3 => of.lead = [between(0.02, 0.5), between(0.005, 0.1)],
            _ => {}
        }
        let highest = table.highest(&of);
        let inside = [-1.1 * highest, 2.0 * highest, highest];
        let zeros = table.zeros(&of, inside);
        let number: f64 = zeros.iter().map(|zero| if zero.im > 0.0 { 2.0 } else { 1.0 }).sum();
        // The integral of the rate has a pole at 0 and not a zero.
        let counted = table.count(&of, inside);
        assert!((counted - number).abs() < 1e-6, "case {case}: {counted} of {number}: {of:?}");
        let least = zeros.iter().map(|zero| damping(*zero)).fold(f64::INFINITY, f64::min);
        let margins = found(&table.plant(), &of);
        let growing: usize =
            zeros.iter().filter(|zero| zero.re > 1e-4).map(|zero| if zero.im > 0.0 { 2 } else { 1 }).sum();
        assert_eq!(margins.unstable, growing, "case {case}: {of:?}");
        // Both end at rounding, and the own difference quotient does not move the zero. Zeros to the left of the rectangle have more damping.
        let beyond = 1.1 / 1.1_f64.hypot(1.0);
        let [ours, least] = [margins.damping().unwrap(), least].map(|damping| damping.min(beyond));
        assert!((ours - least).abs() < 1e-9, "case {case}: {ours} for {least}: {of:?}");
        kinds[usize::from(margins.stable)] += 1;
    }
    println!("{} loops compared, {} unstable, {} stable", kinds[0] + kinds[1], kinds[0], kinds[1]);
    assert!(kinds[0] > loops / 5 && kinds[1] > loops / 5, "both kinds are among them: {kinds:?}");
}

/// `k e^(−Ts)/s` grows if k T > π/2, however long the dead time is: as many pairs as there are frequencies (2 n + 1/2) π/T below k. Its
/// motions are listed up to k T = 30.
#[test]
fn a_long_dead_time_is_unstable() {
    let integrator = super::plant(&[0.0], &[1.0], &[1.0]);
    for (k, delay) in
        [(13.0_f64, 2.0), (13.0, 3.0), (13.0, 1e2), (13.0, 1.33e4), (13.0, 4.2e4), (13.0, 1e6), (0.7, 1e6)]
    {
        let margins: Margins = found(&integrator, &Loop { p: k, delay, ..Loop::default() });
        let pairs = ((k * delay / std::f64::consts::PI - 0.5) / 2.0).floor() + 1.0;
        assert_eq!((margins.stable, margins.unstable as f64), (false, 2.0 * pairs), "{k} {delay}");
        assert_eq!(margins.closed.is_err(), k * delay > 30.0);
        let phase = margins.phase.unwrap();
        let turned = (std::f64::consts::FRAC_PI_2 - k * delay).rem_euclid(std::f64::consts::TAU);
        let off = (phase.0 - turned).rem_euclid(std::f64::consts::TAU);
        // T times the rounding of the crossover.
        assert!(off.min(std::f64::consts::TAU - off) < 1e-14 * k * delay + 1e-9, "{k} {delay}: {phase:?} for {turned}");
        if let Err(NoMotions::DeadTime(turn)) = margins.closed {
            assert!((turn / (k * delay) - 1.0).abs() < 1e-9);
        }
    }
}
