//! Slack ropes, and points that touch the ground unseen.

use crane_quantities::ColumnKind;

use super::{Extremes, Table, column_name, connector_force};
use crate::{ConnectorInfo, Description, dyn_crane::DynCrane};

/// Ropes that are slack at a pose at rest.
pub(super) fn of_pose(crane: &dyn DynCrane, q: &[f64]) -> Vec<String> {
    let connectors = crane.description().connectors.iter().zip(crane.tensions_at_rest(0.0, q));
    let what = |(connector, tension): (&ConnectorInfo, f64)| {
        let is_slack = connector.is_rope && tension == 0.0;
        let slack = is_slack.then(|| format!("rope {} is slack", connector.name));
        slack.or_else(|| pulls_too_hard(connector, tension, ""))
    };
    connectors.filter_map(what).collect()
}

/// Ropes that are slack at times in a run, and contacts between two results.
pub(super) fn of_run(description: &Description, table: &Table) -> Vec<String> {
    let connectors = description.connectors.iter();
    let what = |connector| [goes_slack(connector, table), bounces(connector, table), overloads(connector, table)];
    connectors.flat_map(what).flatten().collect()
}

/// Reports a rope that is pulled by more than its largest tension in a run.
fn overloads(connector: &ConnectorInfo, table: &Table) -> Option<String> {
    connector.max_tension?;
    let Extremes { maximum, time_of_maximum, .. } = Extremes::of_column(table, &connector_force(connector));
    pulls_too_hard(connector, maximum, &format!(", at {time_of_maximum:.2} s"))
}

/// What to say of a rope with a tension beyond its largest; `when`: the end of the sentence.
fn pulls_too_hard(connector: &ConnectorInfo, tension: f64, when: &str) -> Option<String> {
    let allowed = connector.max_tension.filter(|allowed| tension > *allowed)?;
    let name = &connector.name;
    Some(format!("rope {name} pulls with {tension:.1} N, more than its max_tension of {allowed} N{when}"))
}

/// Reports a point that touches the ground between two results, where its force is not recorded: it sinks at the first, fast enough to reach the ground,
/// and rises at the second.
fn bounces(connector: &ConnectorInfo, table: &Table) -> Option<String> {
    if !connector.is_contact {
        return None;
    }
    let named = |kind| table.values(&column_name(kind, &connector.name, false)).map(Iterator::collect::<Vec<_>>);
    let [depth, rate, force] =
        [ColumnKind::Strain(connector.strain()), ColumnKind::StrainRate(connector.strain()), connector.effort()]
            .map(named);
    let (depth, rate, force) = (depth?, rate?, force?);
    let touches = |k: &usize| {
        let [here, next] = [*k, k + 1];
        let free = force[here] == 0.0 && force[next] == 0.0;
        let interval = table.rows[next][0] - table.rows[here][0];
        free && rate[here] > 0.0 && rate[next] < 0.0 && depth[here] + rate[here].max(-rate[next]) * interval > 0.0
    };
    let first = (0..depth.len().saturating_sub(1)).find(touches)?;
    let [begin, end] = [first, first + 1].map(|row| table.rows[row][0]);
    Some(format!(
        "contact {} touches the ground between two results, from {begin:.4} to {end:.4} s, where its force is missed; write a smaller `output`",
        connector.name
    ))
}

/// Reports when a rope is first slack in a run, for how long in total, and its largest force.
fn goes_slack(connector: &ConnectorInfo, table: &Table) -> Option<String> {
    let column = connector_force(connector);
    let Extremes { minimum, time_of_minimum, maximum, time_of_maximum } = Extremes::of_column(table, &column);
    let samples = table.values(&column)?.filter(|force| *force == 0.0).count();
    let slack = table.time_of(samples);
    (connector.is_rope && minimum == 0.0).then(|| {
        format!(
            "rope {} is slack for {slack:.2} s, first at {time_of_minimum:.2} s; it pulls with up to {maximum:.1} N, at \
             {time_of_maximum:.2} s",
            connector.name
        )
    })
}
