//! `crane fatigue`: cycles of stress of beams by manoeuvres that repeat, their damage, and the life that it leaves.

use std::{io::Write, path::Path};

use crane_model::{
    Description, DisplayUnit, SectionModuli,
    dyn_crane::DynCrane,
    dynamics::Method,
    fatigue::{self, Cycle, DamagePart, Detail, Fatigue, LEAST_LIKELY_CATEGORY, Manoeuvre},
    results::{Instant, Table, instants},
};
use crane_page::tables::{Case, Cell, Grid, Report, VALUE, add_events, caution_of_runs, verdicts};

use crate::{
    arguments::{self, Choice, spec_file},
    integration::record_checked,
    problem::{Outcome, Problem},
    quantity,
    screen::Console,
    selection::Registry,
    strength,
    variants::Edit,
};

/// The start of the run may differ from its end by this part of the largest range before it is said: with a slope of 3 it does a thousandth of the damage.
const CLOSED: f64 = 0.1;

/// The damage may change by this part if every second result is left out, before it is a caution.
const FINE: f64 = 0.05;

/// Prints the damage of every beam.
pub fn fatigue(options: &arguments::Fatigue, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let asked = Manoeuvres::read(options, registry)?;
    let cases = asked.cases();
    let mut report = Report::default();
    verdicts(&mut report, &cases);
    if let Some(unstable) = cases.into_iter().find(|case| !case.equilibrium.is_stable()) {
        options.analysis.format.print(&report, &registry.console, out)?;
        return Ok(unstable.stable()?);
    }
    add(&registry.console, &mut report, options, &asked)?;
    report.show_all(options.analysis.all);
    options.analysis.format.print(&report, &registry.console, out)
}

/// The same as a report without the verdicts of statics.
pub fn report(options: &arguments::Fatigue, registry: &Registry) -> Outcome<Report> {
    let asked = Manoeuvres::read(options, registry)?;
    for case in asked.cases() {
        case.stable()?;
    }
    let mut report = Report::default();
    add(&registry.console, &mut report, options, &asked)?;
    Ok(report)
}

/// A manoeuvre that was asked for.
struct Repeated {
    /// Its spec as written.
    word: String,
    crane: Box<dyn DynCrane>,
    repetitions: f64,
}

/// All manoeuvres; at least one.
struct Manoeuvres(Vec<Repeated>);

impl Manoeuvres {
    fn read(options: &arguments::Fatigue, registry: &Registry) -> Outcome<Self> {
        let choice = &options.analysis.crane;
        let first = Repeated {
            word: registry.word_for(&choice.name),
            crane: choice.open(registry)?,
            repetitions: options.cycles,
        };
        let mut all = vec![first];
        for text in &options.also {
            let other = Repeated::read(text, choice, registry)?;
            if all.iter().any(|known| known.word == other.word) {
                return Err(Problem::usage(
                    format!("{} is given twice", other.word),
                    "add its repetitions, or write two specs",
                ));
            }
            let [one, description] = [&all[0], &other].map(|repeated| repeated.crane.description());
            if one.sections != description.sections || one.beams() != description.beams() {
                return Err(Problem::usage(
                    format!("{} has other places along its beams than {}", other.word, all[0].word),
                    format!("write it as `extends: {}` with other motions, loads and parameters alone", all[0].word),
                ));
            }
            all.push(other);
        }
        Ok(Self(all))
    }

    /// What their columns are called; the only one needs no name.
    fn label<'a>(&self, repeated: &'a Repeated) -> &'a str {
        if self.0.len() == 1 { VALUE } else { &repeated.word }
    }

    fn cases(&self) -> Vec<Case<'_>> {
        self.0.iter().map(|repeated| Case::new(self.label(repeated), repeated.crane.as_ref())).collect()
    }
}

impl Repeated {
    /// `SPEC=NUMBER`, with the options that hold for all.
    fn read(given: &str, choice: &Choice, registry: &Registry) -> Outcome<Self> {
        let (word, text) = given.rsplit_once('=').ok_or_else(|| {
            Problem::usage(
                format!("`--also {given}` has no number of repetitions"),
                format!("write `--also {given}=1000`"),
            )
        })?;
        let repetitions = quantity::number("1", text, &format!("the number of repetitions of {word}"))?;
        if repetitions <= 0.0 {
            return Err(Problem::usage(
                format!("the number of repetitions of {word}, {text}, is not above 0"),
                "leave it out",
            ));
        }
        let mut choice = choice.clone();
        word.clone_into(&mut choice.name);
        let Some(file) = spec_file(word).map(Path::to_owned) else {
            return Ok(Self { word: word.to_owned(), crane: choice.open(registry)?, repetitions });
        };
        // Of its own: several specs may have one name.
        let mut own = registry.empty();
        let edit = choice.combination.as_deref().map(Edit::Combination);
        choice.name = own.add_file(&file, edit.as_slice(), choice.strict)?;
        Ok(Self { word: word.to_owned(), crane: choice.open(&own)?, repetitions })
    }
}

/// Runs all manoeuvres, and adds what they do.
fn add(console: &Console, report: &mut Report, options: &arguments::Fatigue, asked: &Manoeuvres) -> Outcome<()> {
    let description = asked.0[0].crane.description();
    let categories = Categories::read(options, description)?;
    let mut runs = Vec::new();
    for Repeated { crane, .. } in &asked.0 {
        let start = options.timing.start(console, crane.as_ref(), false)?;
        let settings = options.timing.settings(crane.as_ref(), &start, Method::RECOMMENDED)?;
        let bar = console.progress(settings.duration);
        let checks = (!options.timing.no_verify, options.analysis.crane.limits);
        runs.push(record_checked(crane.as_ref(), &start, &settings, checks, (console, &bar))?);
        bar.finish_and_clear();
    }
    caution_of_runs(report, asked.0.iter().map(|repeated| asked.label(repeated)).zip(&runs));
    let labelled = asked.0.iter().zip(&runs);
    let cranes: Vec<_> =
        labelled.map(|(repeated, run)| (asked.label(repeated), repeated.crane.as_ref(), &run.table)).collect();
    add_events(report, &cranes);
    let histories: Vec<Vec<Instant>> = asked
        .0
        .iter()
        .zip(&runs)
        .map(|(repeated, run)| instants(repeated.crane.as_ref(), run.table.rows.iter()))
        .collect();
    let moduli: Vec<Vec<SectionModuli>> = asked.0.iter().map(|repeated| repeated.crane.section_moduli_at()).collect();
    let subject =
        FatigueSubject { description, asked, histories: &histories, moduli: &moduli, options, categories: &categories };
    let found = subject.of_every(1);
    let Some(worst) = greatest(&found) else {
        return Err(Problem::failed(
            "no beam has a section whose stresses are known",
            "give the beam a `section` such as `box`, with its sizes, in place of its second moments",
        ));
    };
    subject.verdict(report, worst);
    accuracy(report, worst, greatest(&subject.of_every(2)));
    subject.closing(report, worst);
    changes(report, worst);
    let manoeuvres = subject.manoeuvres(worst);
    if asked.0.len() > 1 {
        report.grid(manoeuvres);
    } else {
        report.data(manoeuvres);
    }
    report.grid(subject.places(&found));
    report.grid(subject.cycles(worst));
    if let Some(file) = &options.results {
        console.write_csv(file, &subject.stresses(&found))?;
    }
    Ok(())
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
}

/// What is reported about.
struct FatigueSubject<'a> {
    description: &'a Description,
    asked: &'a Manoeuvres,
    /// By manoeuvre.
    histories: &'a [Vec<Instant>],
    /// By manoeuvre.
    moduli: &'a [Vec<SectionModuli>],
    options: &'a arguments::Fatigue,
    categories: &'a Categories,
}

impl FatigueSubject<'_> {
    /// What every n-th of the results says.
    fn of_every(&self, n: usize) -> Vec<Fatigue> {
        let all = self.asked.0.iter().zip(self.histories).zip(self.moduli);
        let manoeuvres: Vec<Manoeuvre<'_>> = all
            .map(|((repeated, history), moduli)| Manoeuvre {
                moduli,
                states: history.iter().step_by(n).map(Instant::state).collect(),
                repetitions: repeated.repetitions,
            })
            .collect();
        fatigue::of_manoeuvres(self.description, &manoeuvres, |beam| self.categories.detail(beam))
    }

    /// How often the first manoeuvre may be repeated, with the others in proportion.
    fn life(&self, of: &Fatigue) -> Option<f64> {
        of.life().map(|life| self.options.cycles * life)
    }

    fn verdict(&self, report: &mut Report, worst: &Fatigue) {
        let several = self.asked.0.len() > 1;
        let place = worst.location(self.description);
        report.fact("greatest damage", worst.damage, "");
        report.fact_as("place_of_the_greatest_damage", "place of it", place.as_str(), "");
        let of = if several {
            "life, in repetitions of the first manoeuvre, the others in proportion"
        } else {
            "life, in repetitions of the manoeuvre"
        };
        report.fact_as("life", of, self.life(worst), "");
        if let Some((manoeuvre, largest)) = worst.largest() {
            let history = &worst.parts[manoeuvre].history;
            let mut ends = largest.ends;
            ends.sort_by(|a, b| history[*a].total_cmp(&history[*b]));
            let [low, high] = ends.map(|index| self.histories[manoeuvre][index].t);
            report.fact_as(
                "greatest_range",
                "its largest range of stress",
                Cell::Shown(largest.range, DisplayUnit::Megapascal),
                "MPa",
            );
            if several {
                report.line("manoeuvre of this range", self.asked.0[manoeuvre].word.as_str(), "");
            }
            report.fact_as("time_of_the_valley", "time of the valley of this range", low, "s");
            report.fact_as("time_of_the_peak", "time of its peak", high, "s");
        }
        let parameter = worst.history_parameter(self.categories.slope);
        let name = format!("stress history parameter s, m = {}", self.categories.slope);
        report.fact_as("history_parameter", name, parameter, "");
        report.fact_as("class", "class of it", class(parameter), "");
        if let Some(life) = self.life(worst).filter(|_| worst.damage >= 1.0) {
            report.caution(Some(format!(
                "the life of {place} ends after {life:.3e} of {:.3e} repetitions",
                self.options.cycles
            )));
        }
    }

    /// The times of both ends of a cycle, s.
    fn times(&self, manoeuvre: usize, cycle: &Cycle) -> [f64; 2] {
        cycle.ends.map(|index| self.histories[manoeuvre][index].t)
    }

    /// What each manoeuvre does where the damage is greatest.
    fn manoeuvres(&self, worst: &Fatigue) -> Grid {
        let title = "Manoeuvres: what each does where the damage is greatest";
        let headers = [
            "manoeuvre",
            "repetitions",
            "largest range [MPa]",
            "least stress [MPa]",
            "greatest stress [MPa]",
            "damage",
            "part of the damage [%]",
        ];
        let mut grid = Grid::new("manoeuvres", title, &headers);
        for (repeated, part) in self.asked.0.iter().zip(&worst.parts) {
            let range = part.cycles.iter().map(|cycle| cycle.range).fold(0.0, f64::max);
            let [least, greatest] = ends(&part.history);
            let share = if worst.damage > 0.0 { part.damage / worst.damage } else { 0.0 };
            grid.row([
                repeated.word.as_str().into(),
                part.repetitions.into(),
                Cell::Shown(range, DisplayUnit::Megapascal),
                Cell::Shown(least, DisplayUnit::Megapascal),
                Cell::Shown(greatest, DisplayUnit::Megapascal),
                part.damage.into(),
                Cell::Shown(share, DisplayUnit::Percent),
            ]);
        }
        grid
    }

    /// One row per place.
    fn places(&self, found: &[Fatigue]) -> Grid {
        let (repetitions, manoeuvres) = (self.options.cycles, self.asked.0.len());
        let by = if manoeuvres > 1 {
            format!("all repetitions of {manoeuvres} manoeuvres")
        } else {
            format!("{repetitions} repetitions")
        };
        let title = format!(
            "Fatigue of beams by {by}: normal stress at the point of each place's contour that suffers most, cycles counted by rainflow"
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
            let parameter = of.history_parameter(self.categories.slope);
            let Detail { category, .. } = self.categories.detail(of.place.beam(self.description));
            let range = of.largest().map_or(0.0, |(_, cycle)| cycle.range);
            let numbers = [
                Cell::Shown(category, DisplayUnit::Megapascal),
                Cell::Shown(range, DisplayUnit::Megapascal),
                Cell::Count(of.cycles().count()),
                parameter.into(),
                class(parameter).into(),
                of.damage.into(),
                self.life(of).into(),
            ];
            let what = of.what(self.description);
            let place = [of.place.beam(self.description).into(), of.place.x.into(), what.into()];
            grid.row(place.into_iter().chain(numbers).collect::<Vec<_>>());
        }
        grid
    }

    /// The cycles where the damage is greatest, those that do most of it first.
    fn cycles(&self, worst: &Fatigue) -> Grid {
        let several = self.asked.0.len() > 1;
        let title = "Cycles of one repetition where the damage is greatest, and their parts of it";
        let headers =
            ["manoeuvre", "range [MPa]", "mean [MPa]", "count", "from [s]", "to [s]", "part of the damage [%]"];
        let headers: Vec<&str> = headers.into_iter().filter(|header| several || *header != "manoeuvre").collect();
        let mut grid = Grid::new("cycles", title, &headers);
        let detail = self.categories.detail(worst.place.beam(self.description));
        let damage = |(manoeuvre, cycle): &(usize, &Cycle)| {
            worst.parts[*manoeuvre].repetitions * detail.damage(&[**cycle]) / worst.damage
        };
        let mut cycles: Vec<(usize, &Cycle)> = worst.cycles().collect();
        cycles.sort_by(|a, b| damage(b).total_cmp(&damage(a)));
        for found in cycles {
            let (manoeuvre, cycle) = found;
            let [from, to] = self.times(manoeuvre, cycle);
            let word = several.then(|| Cell::from(self.asked.0[manoeuvre].word.as_str()));
            let numbers = [
                Cell::Shown(cycle.range, DisplayUnit::Megapascal),
                Cell::Shown(cycle.mean, DisplayUnit::Megapascal),
                cycle.count.into(),
                from.into(),
                to.into(),
                Cell::Shown(damage(&found), DisplayUnit::Percent),
            ];
            grid.row(word.into_iter().chain(numbers).collect::<Vec<_>>());
        }
        grid
    }

    /// Whether each manoeuvre ends as it begins.
    fn closing(&self, report: &mut Report, worst: &Fatigue) {
        for (repeated, part) in self.asked.0.iter().zip(&worst.parts) {
            let (Some(first), Some(last)) = (part.history.first(), part.history.last()) else { continue };
            let jump = (last - first).abs();
            let largest = part.cycles.iter().map(|cycle| cycle.range).fold(0.0, f64::max);
            if jump > CLOSED * largest {
                let of = if self.asked.0.len() > 1 { &repeated.word } else { "the manoeuvre" };
                report.caution(Some(format!(
                    "{of} does not end as it begins: where the damage is greatest, the stress differs by {:.1} MPa; this change is counted as part of \
                     each repetition",
                    jump / 1e6
                )));
            }
        }
    }

    /// The histories in columns, of the only manoeuvre. Places that pads sweep are numbered along the beam, and `x` is where they are.
    fn stresses(&self, found: &[Fatigue]) -> Table {
        let mut table = Table::default();
        table.add("t", "s");
        let pads = |of: &Fatigue| {
            let info = of.place.info(self.description);
            info.slides.then(|| format!("{}_swept_by_{}", of.place.beam(self.description), info.at.replace(' ', "_")))
        };
        for (index, of) in found.iter().enumerate() {
            let Some(pads_here) = pads(of) else {
                table.add(strength::column(self.description, of.place.cut, "normal_stress"), "Pa");
                continue;
            };
            let number = found[..=index].iter().filter(|other| pads(other).as_ref() == Some(&pads_here)).count();
            table.add(format!("{pads_here}_{number}_x"), "m");
            table.add(format!("{pads_here}_{number}_normal_stress"), "Pa");
        }
        let row = |(index, instant): (usize, &Instant)| {
            let numbers = found.iter().flat_map(|of| {
                let x = of.place.info(self.description).slides.then_some(of.place.x);
                x.into_iter().chain(of.parts.first().and_then(|part| part.history.get(index).copied()))
            });
            [instant.t].into_iter().chain(numbers).collect()
        };
        table.rows = self.histories[0].iter().enumerate().map(row).collect();
        table
    }
}

/// The least and the greatest of a history.
fn ends(history: &[f64]) -> [f64; 2] {
    history
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[least, greatest], value| [least.min(*value), greatest.max(*value)])
}

/// Whether the stress changes more from one manoeuvre to another than within them.
fn changes(report: &mut Report, worst: &Fatigue) {
    let all = worst.parts.iter().map(|part: &DamagePart| ends(&part.history));
    let [least, greatest] = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, greatest], [low, high]| {
        [least.min(low), greatest.max(high)]
    });
    let within = worst.largest().map_or(0.0, |(_, cycle)| cycle.range);
    if greatest - least > (1.0 + CLOSED) * within {
        report.caution(Some(format!(
            "from one manoeuvre to another the stress changes by up to {:.1} MPa where the damage is greatest, and within each by {:.1} MPa: such changes \
             are not counted; write a manoeuvre that contains them, as by `events` that take the load and leave it",
            (greatest - least) / 1e6,
            within / 1e6
        )));
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

fn class(parameter: f64) -> String {
    fatigue::class(parameter).map_or_else(|| "above S9".to_owned(), |class| format!("S{class}"))
}
