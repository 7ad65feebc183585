//! Slack ropes.

use super::{Extremes, Table, connector_force};
use crate::{ConnectorInfo, Description, dyn_crane::DynCrane};

/// Ropes that are slack at a pose at rest.
pub(super) fn of_pose(crane: &dyn DynCrane, q: &[f64]) -> Vec<String> {
    let tensions = crane.connector_tensions_at(0.0, q, &vec![0.0; q.len()]);
    let connectors = crane.description().connectors.iter().zip(tensions);
    let slack = connectors.filter(|(connector, tension)| connector.is_rope && tension.force == 0.0);
    slack.map(|(rope, _)| format!("rope {} is slack", rope.name)).collect()
}

/// Ropes that are slack at times in a run.
pub(super) fn of_run(description: &Description, table: &Table) -> Vec<String> {
    description.connectors.iter().filter_map(|connector| goes_slack(connector, table)).collect()
}

/// Reports when a rope is first slack in a run, for how long in total, and its largest force.
fn goes_slack(connector: &ConnectorInfo, table: &Table) -> Option<String> {
    let column = connector_force(connector);
    let Extremes { minimum, time_of_minimum, maximum, time_of_maximum } = Extremes::of(table, &column);
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
