//! `crane fatigue`: cycles of stress of beams by a manoeuvre that repeats, their damage, and the life that it leaves.

use std::io::Write;

use crane_model::{
    Description, DisplayUnit, SectionModuli,
    fatigue::{self, Cycle, Detail, Fatigue},
    results::{Instant, Table},
};
use crane_page::tables::{Case, Cell, Grid, Report, VALUE, verdicts};

use crate::{
    arguments, files,
    problem::{Outcome, Problem},
    quantity,
    selection::Registry,
    strength::{self, words},
};

/// Categories below this, Pa, are most likely meant in megapascals.
const LEAST_LIKELY_CATEGORY: f64 = 1e5;

/// The start of the run may differ from its end by this part of the largest range before it is said: with a slope of 3 it does a thousandth of the damage.
const CLOSED: f64 = 0.1;

/// The damage may change by this part if every second result is left out, before it is a caution.
const FINE: f64 = 0.05;

/// Prints the damage of every beam.
pub fn fatigue(options: &arguments::Fatigue, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let crane = options.analysis.crane.open(registry)?;
    let crane = crane.as_ref();
    let categories = Categories::read(options, crane.description())?;
    let case = Case::new(VALUE, crane);
    let mut report = Report::default();
    verdicts(&mut report, std::slice::from_ref(&case));
    if !case.equilibrium.is_stable() {
        options.analysis.format.print(&report, out)?;
        return Ok(case.stable()?);
    }
    let timing = (&options.timing, options.analysis.crane.limits);
    let history = strength::history(timing, crane, &mut report)?;
    let moduli = crane.section_moduli_at();
    let found = categories.of(crane.description(), &moduli, history.iter());
    if found.is_empty() {
        return Err(Problem::failed(
            "no beam has a section whose stresses are known",
            "give the beam a `section` such as `box`, with its sizes, in place of its second moments",
        ));
    }
    let subject = Subject { description: crane.description(), history: &history, options, categories: &categories };
    if let Some(worst) = greatest(&found) {
        subject.verdict(&mut report, worst);
        let every_second = categories.of(crane.description(), &moduli, history.iter().step_by(2));
        accuracy(&mut report, worst, greatest(&every_second));
        closing(&mut report, worst);
        report.grid(subject.places(&found));
        report.grid(subject.cycles(worst));
    }
    if let Some(file) = &options.results {
        files::write_csv(file, &subject.stresses(&found))?;
    }
    report.show_all(options.analysis.all);
    options.analysis.format.print(&report, out)
}

/// The place that suffers most.
fn greatest(found: &[Fatigue]) -> Option<&Fatigue> {
    found.iter().max_by(|a, b| a.damage.total_cmp(&b.damage))
}

/// Details by beams.
struct Categories {
    /// Of beams without their own, Pa.
    others: f64,
    own: Vec<(String, f64)>,
    slope: f64,
}

impl Categories {
    fn read(options: &arguments::Fatigue, description: &Description) -> Outcome<Self> {
        let beams = description.beams();
        let (mut others, mut own) = (None, Vec::<(String, f64)>::new());
        for given in &options.categories {
            let (beam, text) = given.split_once('=').map_or((None, given.as_str()), |(beam, text)| (Some(beam), text));
            let category = quantity::number("Pa", text, "the detail category")?;
            if category <= 0.0 {
                return Err(Problem::usage(
                    format!("the detail category {text} is not above 0"),
                    "write for example 71MPa",
                ));
            }
            if category < LEAST_LIKELY_CATEGORY {
                return Err(Problem::usage(
                    format!("the detail category {text} is {category} Pa"),
                    format!("a number without a unit is in Pa: write {text}MPa, if it is meant in MPa"),
                ));
            }
            let strength = category / options.safety_factor;
            let is_twice = match beam {
                Some(name) if !beams.contains(&name) => {
                    let names = beams.join(", ");
                    return Err(Problem::usage(format!("`{name}` is not a beam"), format!("beams are {names}")));
                }
                Some(name) if own.iter().any(|(other, _)| other == name) => true,
                Some(name) => {
                    own.push((name.to_owned(), strength));
                    false
                }
                None => others.replace(strength).is_some(),
            };
            if is_twice {
                let of = beam.unwrap_or("all beams");
                return Err(Problem::usage(format!("the detail category of {of} is given twice"), "leave one out"));
            }
        }
        let without: Vec<&str> =
            beams.iter().copied().filter(|beam| !own.iter().any(|(name, _)| name == beam)).collect();
        match others {
            Some(others) => Ok(Categories { others, own, slope: options.slope }),
            None if without.is_empty() => Ok(Categories { others: f64::INFINITY, own, slope: options.slope }),
            None => Err(Problem::usage(
                format!("no detail category for {}", without.join(", ")),
                "add `--category` with a stress alone, which is that of all other beams",
            )),
        }
    }

    fn detail(&self, beam: &str) -> Detail {
        let own = self.own.iter().find(|(name, _)| name == beam);
        Detail { category: own.map_or(self.others, |(_, category)| *category), slope: self.slope }
    }

    fn of<'a>(
        &self,
        description: &Description,
        moduli: &[SectionModuli],
        instants: impl Iterator<Item = &'a Instant>,
    ) -> Vec<Fatigue> {
        let states = instants.map(|instant| (instant.x.as_slice(), instant.wrenches.as_slice()));
        fatigue::of_history(description, moduli, states, |beam| self.detail(beam))
    }
}

/// What is reported about.
struct Subject<'a> {
    description: &'a Description,
    history: &'a [Instant],
    options: &'a arguments::Fatigue,
    categories: &'a Categories,
}

impl Subject<'_> {
    fn parameter(&self, of: &Fatigue) -> f64 {
        fatigue::history_parameter(&of.cycles, self.categories.slope, self.options.cycles)
    }

    fn verdict(&self, report: &mut Report, worst: &Fatigue) {
        let damage = worst.damage * self.options.cycles;
        report.fact("greatest damage", damage, "");
        report.fact_as("place_of_the_greatest_damage", "place of it", worst.place.location(self.description), "");
        report.fact_as("life", "life, in repetitions of the manoeuvre", worst.life(), "");
        if let Some(largest) = worst.largest() {
            let mut ends = largest.ends;
            ends.sort_by(|a, b| worst.history[*a].total_cmp(&worst.history[*b]));
            let [low, high] = ends.map(|index| self.history[index].t);
            report.fact_as(
                "greatest_range",
                "its largest range of stress",
                Cell::Shown(largest.range, DisplayUnit::Megapascal),
                "MPa",
            );
            report.fact_as("time_of_the_valley", "time of the valley of this range", low, "s");
            report.fact_as("time_of_the_peak", "time of its peak", high, "s");
        }
        let parameter = self.parameter(worst);
        let name = format!("stress history parameter s, m = {}", self.categories.slope);
        report.fact_as("history_parameter", name, parameter, "");
        report.fact_as("class", "class of it", class(parameter), "");
        if let Some(life) = worst.life().filter(|_| damage >= 1.0) {
            let place = worst.place.location(self.description);
            report.caution(Some(format!(
                "the life of {place} ends after {:.3e} of {:.3e} repetitions",
                life, self.options.cycles
            )));
        }
    }

    /// The times of both ends of a cycle, s.
    fn times(&self, cycle: &Cycle) -> [f64; 2] {
        cycle.ends.map(|index| self.history[index].t)
    }

    /// One row per place.
    fn places(&self, found: &[Fatigue]) -> Grid {
        let title = format!(
            "Fatigue of beams by {} repetitions: normal stress at the point of each place's contour that suffers most, cycles counted by rainflow",
            self.options.cycles
        );
        let headers = [
            "beam",
            "x [m]",
            "place",
            "category [MPa]",
            "largest range [MPa]",
            "cycles",
            "s",
            "class",
            "damage",
            "life",
        ];
        let mut grid = Grid::new("fatigue", title, &headers);
        for of in found {
            let parameter = self.parameter(of);
            let Detail { category, .. } = self.categories.detail(of.place.beam(self.description));
            let range = of.largest().map_or(0.0, |cycle| cycle.range);
            let numbers = [
                Cell::Shown(category, DisplayUnit::Megapascal),
                Cell::Shown(range, DisplayUnit::Megapascal),
                Cell::Count(of.cycles.len()),
                parameter.into(),
                class(parameter).into(),
                (of.damage * self.options.cycles).into(),
                of.life().into(),
            ];
            grid.row(words(&of.place, self.description).into_iter().chain(numbers).collect::<Vec<_>>());
        }
        grid
    }

    /// The cycles where the damage is greatest.
    fn cycles(&self, worst: &Fatigue) -> Grid {
        let title = "Cycles of one repetition where the damage is greatest, and their parts of it";
        let headers = ["range [MPa]", "mean [MPa]", "count", "from [s]", "to [s]", "part of the damage [%]"];
        let mut grid = Grid::new("cycles", title, &headers);
        let detail = self.categories.detail(worst.place.beam(self.description));
        let mut cycles = worst.cycles.clone();
        cycles.sort_by(|a, b| b.range.total_cmp(&a.range));
        for cycle in cycles {
            let [from, to] = self.times(&cycle);
            let part = detail.damage(&[cycle]) / worst.damage;
            grid.row([
                Cell::Shown(cycle.range, DisplayUnit::Megapascal),
                Cell::Shown(cycle.mean, DisplayUnit::Megapascal),
                cycle.count.into(),
                from.into(),
                to.into(),
                Cell::Shown(part, DisplayUnit::Percent),
            ]);
        }
        grid
    }

    /// The histories in columns.
    fn stresses(&self, found: &[Fatigue]) -> Table {
        let mut table = Table::default();
        table.add("t", "s");
        for of in found {
            table.add(strength::column(self.description, of.place.cut, "normal_stress"), "Pa");
        }
        let row = |(index, instant): (usize, &Instant)| {
            [instant.t].into_iter().chain(found.iter().map(|of| of.history[index])).collect()
        };
        table.rows = self.history.iter().enumerate().map(row).collect();
        table
    }
}

/// How much the interval of results matters.
fn accuracy(report: &mut Report, worst: &Fatigue, coarse: Option<&Fatigue>) {
    let Some(coarse) = coarse.filter(|_| worst.damage > 0.0) else { return };
    let change = coarse.damage / worst.damage - 1.0;
    report.fact_as(
        "change_with_half_of_the_results",
        "change of the damage with half of the results",
        Cell::Change(change),
        "%",
    );
    if change.abs() > FINE {
        report.caution(Some(format!(
            "with half of the results the damage changes by {:.0} %: peaks lie between results; take a shorter `--interval`",
            100.0 * change
        )));
    }
}

/// Whether the manoeuvre ends as it begins.
fn closing(report: &mut Report, worst: &Fatigue) {
    let (Some(first), Some(last), Some(largest)) = (worst.history.first(), worst.history.last(), worst.largest())
    else {
        return;
    };
    let jump = (last - first).abs();
    if jump > CLOSED * largest.range {
        report.caution(Some(format!(
            "the manoeuvre does not end as it begins: where the damage is greatest, the stress differs by {:.1} MPa; this change is counted as part of \
             each repetition",
            jump / 1e6
        )));
    }
}

fn class(parameter: f64) -> String {
    fatigue::class(parameter).map_or_else(|| "above S9".to_owned(), |class| format!("S{class}"))
}
