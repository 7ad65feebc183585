//! `crane modes`: small vibrations about the static pose.

use std::{io::Write, num::NonZeroUsize};

use crane_model::{dynamics::Method, modes::damped, results::cautions, runs::limiting_modes, stability::limit};
use crane_page::tables::{Case, Cell, Report, damped_modes, undamped_modes};

use crate::{arguments::Modes, linearisation, problem::Outcome, refinement, selection::Registry};

/// Number of lowest modes that are printed by default.
const LOWEST: usize = 10;

/// Prints undamped and damped modes and the largest stable step.
pub fn modes(options: &Modes, registry: &Registry, out: &mut dyn Write) -> Outcome<()> {
    let Modes { analysis: options, count, matrices, .. } = options;
    let lowest = count.map_or(LOWEST, NonZeroUsize::get);
    let crane = options.crane.open(registry)?;
    let description = crane.description();
    let case = Case::new(&description.name, crane.as_ref());
    case.stable()?;
    let motions = crane.small_motions_at(&case.equilibrium.q);
    let modes = damped(&motions)?;
    if let Some(file) = matrices {
        linearisation::write_linearisation(&registry.console, file, description, &case.equilibrium.q, &motions)?;
    }
    let mut report = Report::default();
    report.fact("crane", description.name.as_str(), "");
    let limiting = limiting_modes(crane.as_ref(), 0.0, &case.equilibrium.q, &modes);
    let step = limit(&limiting, &Method::Rk4.stability()).map(|limit| limit.step);
    report.value("stable", true);
    if modes.is_empty() {
        report.line("vibrations", "none: rigid drives hold all joints", "");
    }
    report.fact("largest stable step", Cell::from(step), "s");
    for caution in cautions::of_servos(crane.as_ref(), 0.0, &case.equilibrium.q) {
        report.caution(Some(caution));
    }
    let changes = refinement::changes(&case, registry)?;
    report.caution(changes.as_deref().and_then(refinement::caution).as_deref());
    for caution in cautions::of_telescopes(crane.as_ref(), &case.equilibrium.q) {
        report.caution(Some(caution));
    }
    report.excerpt(undamped_modes(&case, changes.as_deref())?, lowest);
    report.excerpt(damped_modes(description, &modes), 0);
    report.show_all(options.all);
    options.format.print(&report, &registry.console, out)
}
