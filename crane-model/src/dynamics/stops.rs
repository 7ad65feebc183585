//! Times at which steps end: between them the motions of drives and winches and the scales of loads are smooth.

use crate::{Description, dyn_crane::Functions};

/// The next time after t at which a motion of a drive or a winch or the scale of a load is not smooth, s.
pub fn next_stop(crane: &dyn Functions, t: f64) -> Option<f64> {
    Some(Stops::between([crane], t, f64::INFINITY).after(t)).filter(|stop| stop.is_finite())
}

/// Times within a run, in order.
#[derive(Clone, Debug, Default)]
pub(super) struct Stops(Vec<f64>);

impl Stops {
    /// Times closer than this, relative to the run, are merged: no step is that short.
    const NEAR: f64 = 1e-9;

    /// Beginnings and ends of the smooth intervals of the motions, loads and winches of some cranes, within a run from `begin` to `end`,
    /// s; if `end` is infinite, the run is as long as the motions.
    pub fn between<'a>(cranes: impl IntoIterator<Item = &'a dyn Functions>, begin: f64, end: f64) -> Self {
        let mut times = Vec::new();
        for crane in cranes {
            let Description { drives, loads, connectors, .. } = crane.description();
            let of_drives = drives.iter().map(|drive| drive.pieces).sum();
            let of_loads = loads.iter().map(|load| load.pieces).sum();
            let of_winches: usize = connectors.iter().map(|connector| connector.pieces).sum();
            let mut pieces = vec![[f64::NAN; 2]; of_drives + of_loads + of_winches];
            let (motions, rest) = pieces.split_at_mut(of_drives);
            let (scales, winches) = rest.split_at_mut(of_loads);
            crane.drive_pieces(motions);
            crane.load_pieces(scales);
            crane.winch_pieces(winches);
            times.extend(pieces.into_iter().flatten().filter(|time| time.is_finite()));
        }
        let last = times.iter().copied().fold(begin, f64::max);
        let near = Self::NEAR * (if end.is_finite() { end } else { last } - begin);
        times.retain(|time| *time > begin + near && *time < end - near);
        times.sort_by(f64::total_cmp);
        times.dedup_by(|later, earlier| *later - *earlier < near);
        Self(times)
    }

    /// The first one after a time, s; infinite if there is none.
    pub fn after(&self, t: f64) -> f64 {
        self.0.get(self.0.partition_point(|stop| *stop <= t)).copied().unwrap_or(f64::INFINITY)
    }
}
