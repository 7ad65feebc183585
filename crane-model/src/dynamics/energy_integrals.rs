//! Work of drives and loads and dissipated energy, integrated along a motion that a method has computed.
//!
//! Powers are less smooth than the motion: they have kinks where a drive saturates, and they change although a prescribed motion has no
//! error at all. So the steps of the motion do not suit them, and each step is divided until Gauss's rule with 3 nodes and Kronrod's with 7
//! agree; where already the midpoint agrees with Gauss's rule, that is enough. A. S. Kronrod, Nodes and Weights of Quadrature Formulas,
//! Consultants Bureau 1965.

use crate::memory::{Visit, visit_numbers};
use crate::{
    StateAt,
    dyn_crane::Functions,
    force_states::{ForceStates, loops_on_rigid_drives},
};

/// Integrals along an audited motion: work of the drives and winches, energy that the dampers dissipated, work of the loads.
pub(super) const INTEGRALS: usize = 3;

/// Nodes in an interval from −1 to 1 that are not negative, with the weights of the three rules: of the midpoint, of Gauss and of Kronrod.
/// The first two rules need only the first two nodes.
const NODES: [(f64, [f64; RULES]); 4] = [
    (0.0, [2.0, 8.0 / 9.0, 0.450_916_538_658_474_14]),
    (0.774_596_669_241_483_4, [0.0, 5.0 / 9.0, 0.268_488_089_868_333_44]),
    (0.960_491_268_708_020_3, [0.0, 0.0, 0.104_656_226_026_467_27]),
    (0.434_243_749_346_802_56, [0.0, 0.0, 0.401_397_414_775_962_2]),
];
const RULES: usize = 3;
/// Maximum number of times that an interval is halved: a kink that remains is in 1/64 of the step.
const HALVINGS: u32 = 6;
/// Powers below this fraction of the largest one so far do not matter: at rest they are rounding.
const NEGLIGIBLE: f64 = 1e-3;

/// Gives the motion at a time within the last step.
pub(super) type At<'a> = &'a mut dyn FnMut(f64, &mut [f64]);

/// The integrals since the beginning of a motion.
pub(super) struct EnergyIntegrals<'a> {
    crane: &'a dyn Functions,
    force_states: ForceStates,
    /// Rates of their states, which are not needed.
    rates: Vec<f64>,
    motion: Vec<f64>,
    /// Allowed error of an integral over an interval, relative to the largest power in it.
    accuracy: f64,
    /// The largest power so far, W.
    peak: f64,
    /// Time up to which they are integrated, s.
    t: f64,
    /// J
    pub values: [f64; INTEGRALS],
}

impl<'a> EnergyIntegrals<'a> {
    /// Zero at time `t`, s.
    pub fn new(crane: &'a dyn Functions, t: f64, accuracy: f64) -> Self {
        let force_states = ForceStates::new(crane.description());
        let states = force_states.len();
        let motion = vec![0.0; 2 * crane.size() + states];
        Self { crane, force_states, rates: vec![0.0; states], motion, accuracy, peak: 0.0, t, values: [0.0; INTEGRALS] }
    }

    /// Visits what further integrals depend on.
    pub fn visit(&mut self, visit: Visit<'_>) {
        [&mut self.peak, &mut self.t].into_iter().for_each(&mut *visit);
        visit_numbers(&mut self.values, visit);
    }

    /// Integrates up to a time in the last step.
    pub fn advance(&mut self, to: f64, at: At<'_>) {
        if to > self.t {
            self.add([self.t, to], HALVINGS, at);
            self.t = to;
        }
    }

    /// Adds the integrals over an interval.
    fn add(&mut self, [begin, end]: [f64; 2], halvings: u32, at: At<'_>) {
        let (middle, half) = (0.5 * (begin + end), 0.5 * (end - begin));
        let (mut sums, mut greatest) = ([[0.0; INTEGRALS]; RULES], 0.0_f64);
        for (nodes, rule) in [(0..2, 1), (2..4, 2)] {
            for (node, weights) in &NODES[nodes] {
                for side in if *node > 0.0 { [-1.0, 1.0].as_slice() } else { &[0.0] } {
                    let powers = self.powers(middle + side * node * half, at);
                    for (sums, weight) in sums.iter_mut().zip(weights) {
                        sums.iter_mut().zip(powers).for_each(|(sum, power)| *sum += weight * half * power);
                    }
                    greatest = powers.iter().fold(greatest, |greatest, power| greatest.max(power.abs()));
                }
            }
            self.peak = self.peak.max(greatest);
            let allowed = self.accuracy * greatest.max(NEGLIGIBLE * self.peak) * (end - begin);
            let differences = sums[rule].iter().zip(&sums[rule - 1]).map(|(fine, coarse)| (fine - coarse).abs());
            let last = rule + 1 == RULES && halvings == 0;
            if last || differences.fold(0.0, f64::max) <= allowed {
                self.values.iter_mut().zip(sums[rule]).for_each(|(value, increment)| *value += increment);
                return;
            }
        }
        self.add([begin, middle], halvings - 1, at);
        self.add([middle, end], halvings - 1, at);
    }

    /// Powers at a time, W: of the drives and winches, of the dampers, and of the loads.
    fn powers(&mut self, t: f64, at: At<'_>) -> [f64; INTEGRALS] {
        let Self { crane, force_states, rates, motion, .. } = self;
        at(t, motion);
        let (q, rest) = motion.split_at(crane.size());
        let (v, x) = rest.split_at(q.len());
        let work = crane.drive_power(t, q, v) + crane.winch_power(t, q, v);
        let of_loops = loops_on_rigid_drives(*crane, &StateAt { t, q, v, x });
        let work = work + of_loops.iter().map(|(j, effort)| effort * v[*j]).sum::<f64>();
        let mut powers = [work, crane.dissipation(t, q, v), crane.load_power(t, q, v)];
        if !force_states.is_empty() {
            force_states.evaluate(*crane, &StateAt { t, q, v, x }, rates, None);
            let [put_in, taken_out] = force_states.powers();
            powers[0] += put_in;
            powers[1] += taken_out;
            powers[0] += force_states.on_rigid_drives(*crane, q).map(|(j, effort)| effort * v[j]).sum::<f64>();
        }
        powers
    }
}
