//! Where contacts begin and end: a foot or another point meets the ground, a joint its stop, a rope becomes taut.

use crane_quantities::ColumnKind;

use crate::{Description, StateAt, Tension, Text, column::column_name, dyn_crane::Functions};

/// The contacts of a crane: one-sided supports, end stops, ropes and other points on the ground, in this order.
pub struct Contacts {
    feet: Vec<usize>,
    stops: Vec<usize>,
    ropes: Vec<usize>,
    gaps: Vec<[f64; 2]>,
    forces: Vec<f64>,
    tensions: Vec<Tension>,
}

impl Contacts {
    /// The contacts of a crane.
    pub fn new(crane: &dyn Functions) -> Self {
        let Description { supports, stops, connectors, .. } = crane.description();
        Self {
            feet: (0..supports.len()).filter(|foot| supports[*foot].one_sided).collect(),
            stops: stops.to_vec(),
            ropes: (0..connectors.len()).filter(|rope| connectors[*rope].indicator().is_some()).collect(),
            gaps: vec![[0.0; 2]; supports.len()],
            forces: vec![0.0; crane.size()],
            tensions: vec![Tension::ZERO; connectors.len()],
        }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.feet.len() + self.stops.len() + self.ropes.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Their names.
    pub fn names(description: &Description) -> Vec<String> {
        let feet = description.supports.iter().filter(|support| support.one_sided).map(|support| &support.name);
        let stops = description.stops.iter().map(|&stop| &description.coordinates[stop].name);
        let named = |kind| move |part: &Text| column_name(kind, part, false);
        let feet = feet.map(named(ColumnKind::FootIndicator));
        let of_connectors =
            description.connectors.iter().filter_map(|connector| Some(named(connector.indicator()?)(&connector.name)));
        feet.chain(stops.map(named(ColumnKind::StopIndicator))).chain(of_connectors).collect()
    }

    /// Gives `take` an indicator of each contact, in order: negative while the contact is closed, positive while it is open. That of a foot is
    /// its gap, m; the others are the negative force, N or N m, or 1 where there is none, so they jump when a contact begins.
    pub fn indicators(
        &mut self,
        crane: &dyn Functions,
        &StateAt { t, q, v, .. }: &StateAt<'_>,
        mut take: impl FnMut(f64),
    ) {
        let of_force = |force: f64| if force == 0.0 { 1.0 } else { -force.abs() };
        if !self.feet.is_empty() {
            crane.support_gaps(q, v, &mut self.gaps);
            self.feet.iter().for_each(|foot| take(self.gaps[*foot][0]));
        }
        if !self.stops.is_empty() {
            crane.stop_forces(q, v, &mut self.forces);
            self.stops.iter().for_each(|stop| take(of_force(self.forces[*stop])));
        }
        if !self.ropes.is_empty() {
            crane.connector_tensions(t, q, v, &mut self.tensions);
            self.ropes.iter().for_each(|rope| take(of_force(self.tensions[*rope].force.max(0.0))));
        }
    }
}
