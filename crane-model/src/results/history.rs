//! Internal forces and tipping lines over a run.

use crate::{
    Description, SectionModuli, StateAt, Wrench,
    dyn_crane::DynCrane,
    dynamics::Phases,
    force_states,
    results::quantities,
    sections::{self, Place, StressedSection},
    tipping::{TippingLine, lines},
};

/// What a crane carries at an instant.
#[derive(Clone, Debug)]
pub struct Instant {
    /// Time, s.
    pub t: f64,
    /// Tipping lines.
    pub lines: Vec<TippingLine>,
    /// Where the sections of beams are, m from the beginnings of their beams.
    pub x: Vec<f64>,
    /// Internal forces at every cut.
    pub wrenches: Vec<Wrench>,
}

impl Instant {
    /// At rest, with the drives and loads of t = 0.
    pub fn at_rest(crane: &dyn DynCrane, q: &[f64]) -> Self {
        Self::at_rest_with(crane, 0.0, q)
    }

    /// At rest, with the drives and loads of a time, s.
    pub fn at_rest_with(crane: &dyn DynCrane, t: f64, q: &[f64]) -> Self {
        let rest = vec![0.0; q.len()];
        Self {
            t,
            lines: lines(crane, t, q, &rest, &rest),
            x: crane.section_places_at(q),
            wrenches: crane.internal_forces_at(t, q, &rest, &rest),
        }
    }

    /// In motion.
    fn moving(crane: &dyn DynCrane, moment: &StateAt<'_>) -> Self {
        let &StateAt { t, q, v, .. } = moment;
        let (a, _) = force_states::accelerations(crane, moment);
        Self {
            t,
            lines: lines(crane, t, q, v, &a),
            x: crane.section_places_at(q),
            wrenches: crane.internal_forces_of(moment, &a),
        }
    }

    /// Where sections are, and what cuts carry, as [`fatigue`](crate::fatigue) takes them.
    pub fn state(&self) -> (&[f64], &[Wrench]) {
        (&self.x, &self.wrenches)
    }

    /// All places of beams and what they carry.
    pub fn places(&self, description: &Description) -> Vec<Place> {
        sections::places(description, &self.x, &self.wrenches)
    }

    /// Those whose stresses are known; `moduli` one per section.
    pub fn stressed_sections(&self, description: &Description, moduli: &[SectionModuli]) -> Vec<StressedSection> {
        sections::stressed_sections(description, moduli, &self.x, &self.wrenches)
    }
}

/// The stresses of all sections at some instants, with their times, s; `moduli` one per section.
pub fn stressed_over(
    instants: &[Instant],
    description: &Description,
    moduli: &[SectionModuli],
) -> Vec<(f64, StressedSection)> {
    let at = |instant: &Instant| {
        let t = instant.t;
        instant.stressed_sections(description, moduli).into_iter().map(move |section| (t, section))
    };
    instants.iter().flat_map(at).collect()
}

/// At results of a run, rows of a recorded table.
pub fn instants<'a>(crane: &dyn DynCrane, rows: impl Iterator<Item = &'a Vec<f64>>) -> Vec<Instant> {
    let n = crane.size();
    // Time, coordinates and rates come first.
    let columns = quantities(crane.description(), crane.loop_joints());
    let index_of = |name: String| columns.iter().position(|column| column.name == name);
    let oil: Vec<usize> = force_states::columns(crane.description()).into_iter().filter_map(index_of).collect();
    let mut phases = Phases::new(crane);
    rows.map(|row| {
        let x: Vec<f64> = oil.iter().map(|&index_of| row[index_of]).collect();
        Instant::moving(phases.at_row(row), &StateAt { t: row[0], q: &row[1..=n], v: &row[n + 1..=2 * n], x: &x })
    })
    .collect()
}
