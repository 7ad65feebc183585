//! The model's own error: the same crane with other numbers of sections.

use indicatif::ProgressBar;
use nalgebra::Vector3;

use crane_model::{
    dyn_crane::DynCrane,
    dynamics::{Method, Settings},
    modes::{NoModes, damped, undamped},
    runs::{SAFE, Start},
    stability::limit,
};

use crane_cli::toolbox::{Cell, Grid, Outcome, Problem};

use super::{
    methods::{Setting, TARGETS, with},
    trace::{Timed, Trace, timed},
};

/// Tolerance of a run whose only significant error is the model's.
const TIGHT: f64 = 1e-7;
/// Tolerances to choose from.
const TOLERANCES: [f64; 7] = [1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5];
/// Tolerances for the explicit pair, whose step is limited by stability, not by accuracy.
const EXPLICIT: [f64; 1] = [1e-4];
/// Runs that would take longer than this are not tried, s: others are cheaper.
const LONG: f64 = 3.0;
/// Frequencies that are compared.
const FREQUENCIES: usize = 8;

/// A crane with some number of sections.
pub struct Variant {
    /// Sections of each flexible link.
    pub sections: usize,
    coordinates: usize,
    /// Points in the pose at rest, m.
    rest: Vec<Vector3<f64>>,
    /// Maximum distance of these points from their positions before loads deform the crane, m.
    deflection: f64,
    /// Lowest frequencies, Hz.
    frequencies: Vec<f64>,
    /// A practically exact run.
    motion: Trace,
    runs: Vec<Candidate>,
}

/// A run that a user may choose.
pub struct Candidate {
    method: Method,
    setting: Setting,
    /// Wall time, s.
    wall: f64,
    trace: Trace,
}

/// Statics, modes and runs of a crane. A run need not start where the crane rests.
pub fn variant(
    crane: &dyn DynCrane,
    start: &Start,
    base: &Settings,
    sections: usize,
    repeats: usize,
) -> Outcome<Variant> {
    let equilibrium = Start::new(crane)?;
    let small = crane.small_motions_at(&equilibrium.q);
    let modes = undamped(&small).map_err(|error: NoModes| Problem::from(error))?;
    let frequencies = modes.iter().filter_map(crane_model::modes::Mode::frequency).take(FREQUENCIES).collect();
    let rest = Trace::points(crane, &equilibrium.q);
    let guess = Trace::points(crane, &crane.guess());
    let deflection = rest.iter().zip(&guess).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);

    let tight = timed(crane, &start.q, &with(base, Method::RECOMMENDED, Setting::Tolerance(TIGHT)), 1)?;
    let evaluation = tight.wall / tight.run.statistics.evaluations as f64;
    let damped = damped(&crane.small_motions_at(&start.q))?;
    let mut runs = Vec::new();
    for method in Method::ALL {
        let limit = limit(&damped, &method.stability()).map_or(base.output, |limit| limit.step);
        let settings: Vec<Setting> = match method {
            Method::Rk4 => vec![Setting::Step(SAFE * limit)],
            Method::DormandPrince => EXPLICIT.map(Setting::Tolerance).to_vec(),
            Method::Rosenbrock | Method::Bdf => TOLERANCES.map(Setting::Tolerance).to_vec(),
        };
        // Stability determines the number of steps of an explicit method; each takes at most six evaluations.
        let estimate = base.duration / limit * evaluation * 6.0;
        if method.is_explicit() && estimate > LONG {
            continue;
        }
        for setting in settings {
            // If no step meets a tolerance, the other runs remain.
            if let Ok(Timed { wall, trace, .. }) = timed(crane, &start.q, &with(base, method, setting), repeats) {
                runs.push(Candidate { method, setting, wall, trace });
            }
        }
    }
    let coordinates = start.q.len();
    Ok(Variant { sections, coordinates, rest, deflection, frequencies, motion: tight.trace, runs })
}

/// The limit of many sections, extrapolated from the two finest variants: the error of rigid elements is proportional to 1/n².
pub struct Limit {
    rest: Vec<Vector3<f64>>,
    deflection: f64,
    frequencies: Vec<f64>,
    motion: Trace,
    peaks: Vec<f64>,
}

impl Limit {
    /// `x∞ = x_n + (x_n − x_m)/((n/m)² − 1)` of the finest, n, and the next coarser, m.
    pub fn new(variants: &[Variant]) -> Option<Self> {
        let [.., before, finest] = variants else { return None };
        let weight = ((finest.sections as f64 / before.sections as f64).powi(2) - 1.0).recip();
        let number = |(a, b): (&f64, &f64)| a + weight * (a - b);
        let peaks = [finest.motion.peaks(), before.motion.peaks()];
        Some(Self {
            rest: finest.rest.iter().zip(&before.rest).map(|(a, b)| a + (a - b) * weight).collect(),
            deflection: number((&finest.deflection, &before.deflection)),
            frequencies: finest.frequencies.iter().zip(&before.frequencies).map(number).collect(),
            motion: finest.motion.beyond(&before.motion, weight),
            peaks: peaks[0].iter().zip(&peaks[1]).map(number).collect(),
        })
    }

    /// Errors of a variant: static deflection, frequencies, peak torques, load path.
    pub fn errors(&self, variant: &Variant) -> [f64; 4] {
        let worst = |values: &[f64], limits: &[f64]| {
            let relative =
                values.iter().zip(limits).filter(|(_, limit)| **limit != 0.0).map(|(a, b)| (a / b - 1.0).abs());
            relative.fold(0.0, f64::max)
        };
        let rest = self.rest.iter().zip(&variant.rest).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
        [
            rest / self.deflection,
            worst(&variant.frequencies, &self.frequencies),
            worst(&variant.motion.peaks(), &self.peaks),
            self.motion.errors(&variant.motion).path,
        ]
    }

    /// Errors of all variants as a table.
    pub fn table(&self, variants: &[Variant]) -> Grid {
        let headers = ["sections", "coordinates", "static deflection", "frequencies", "peak torques", "load path"];
        let title =
            format!("Errors of the model over the number of sections, relative; frequencies: the first {FREQUENCIES}");
        let mut grid = Grid::new("sections", title, &headers);
        for variant in variants {
            // A crane that does not settle, or without statics, has no deflection to compare.
            let errors =
                self.errors(variant).map(|error| if error.is_finite() { Cell::Error(error) } else { Cell::Empty });
            grid.row([vec![variant.sections.into(), variant.coordinates.into()], errors.to_vec()].concat());
        }
        grid
    }

    /// All runs: errors of model and method together, and times.
    pub fn runs(&self, variants: &[Variant]) -> Grid {
        let headers = ["sections", "method", "step s", "tolerance", "load path", "wall ms"];
        let mut grid = Grid::new("runs", "Errors of the load path of model and method together", &headers);
        for (variant, run) in all(variants) {
            grid.row([
                variant.sections.into(),
                run.method.name().into(),
                run.setting.step().into(),
                run.setting.tolerance().map_or(Cell::Empty, Cell::Error),
                Cell::Error(self.motion.errors(&run.trace).path),
                (1e3 * run.wall).into(),
            ]);
        }
        grid
    }

    /// Points of wall time, ms, and error of the load path of one variant's runs by a method.
    pub fn curve(&self, variant: &Variant, method: Method) -> Vec<(f64, f64)> {
        let runs = variant.runs.iter().filter(|run| run.method == method);
        runs.map(|run| (1e3 * run.wall, self.motion.errors(&run.trace).path)).collect()
    }

    /// What is cheapest for each error that users ask for.
    pub fn advice(&self, variants: &[Variant], duration: f64) -> Grid {
        let headers = ["load path", "sections", "method", "option", "error", "wall ms", "times real time"];
        let title = "Shortest time for an error of the load path, of model and method together";
        let mut grid = Grid::new("advice", title, &headers);
        for target in TARGETS {
            let errors = all(variants).map(|(variant, run)| (variant, run, self.motion.errors(&run.trace).path));
            let best = errors.filter(|(.., error)| *error <= target).min_by(|a, b| a.1.wall.total_cmp(&b.1.wall));
            if let Some((variant, run, error)) = best {
                grid.row([
                    Cell::Error(target),
                    variant.sections.into(),
                    run.method.name().into(),
                    run.setting.option().into(),
                    Cell::Error(error),
                    (1e3 * run.wall).into(),
                    (duration / run.wall).into(),
                ]);
            } else {
                let more = format!("more than {}", variants.last().map_or(0, |variant| variant.sections));
                let [method, option, error, wall, ratio] = [const { Cell::Empty }; 5];
                grid.row([Cell::Error(target), more.into(), method, option, error, wall, ratio]);
            }
        }
        grid
    }
}

fn all(variants: &[Variant]) -> impl Iterator<Item = (&Variant, &Candidate)> {
    variants.iter().flat_map(|variant| variant.runs.iter().map(move |run| (variant, run)))
}

/// Shows the progress to the next variant.
pub fn announce(bar: &ProgressBar, sections: usize) {
    bar.set_message(format!("{sections} sections"));
    bar.tick();
}
