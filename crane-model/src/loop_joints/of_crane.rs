//! The equations of the loop joints of one crane, of those of a fleet.

use super::{independence::Independence, profile::Profile};

/// The loops of a crane.
pub(super) struct OfCrane {
    /// Its index.
    pub crane: usize,
    /// Which equations are independent.
    pub independence: Independence,
    /// The place of each of them among the rows of all cranes.
    pub places: Vec<usize>,
    /// S of the independent equations, then its Cholesky factor.
    profile: Profile,
    schur: Vec<f64>,
    /// Numbers of the independent equations.
    shares: Vec<f64>,
}

impl OfCrane {
    /// Of the crane with an index.
    pub fn new(crane: usize, independence: Independence) -> Self {
        let count = independence.len();
        Self {
            crane,
            independence,
            places: Vec::with_capacity(count),
            profile: Profile::new(count),
            schur: vec![0.0; count * (count + 1) / 2],
            shares: vec![0.0; count],
        }
    }

    /// Factorises S, given the products `J M⁻¹ Jᵀ` of all cranes.
    pub fn factorise(&mut self, coupled: &Profile, products: &[f64], cranes: usize) {
        let Self { crane, places, profile, schur, .. } = self;
        profile.clear();
        for (i, &one) in places.iter().enumerate() {
            let first = places[..i].partition_point(|other| *other < coupled.first(one));
            profile.add(first);
            for (j, &other) in places[..=i].iter().enumerate().skip(first) {
                schur[profile.place(i, j)] = products[coupled.place(one, other) * cranes + *crane];
            }
        }
        profile.factorise(schur);
    }

    /// `−S⁻¹` times its numbers among those of all cranes, in place; 0 for its dependent equations among some rows.
    pub fn solve(&mut self, rows: &[usize], cranes: usize, all: &mut [f64]) {
        let Self { crane, places, profile, schur, shares, .. } = self;
        let place = |row: &usize| row * cranes + *crane;
        shares.iter_mut().zip(&*places).for_each(|(share, own)| *share = all[place(&rows[*own])]);
        profile.solve(schur, shares);
        for row in rows {
            all[place(row)] = 0.0;
        }
        shares.iter().zip(&*places).for_each(|(share, own)| all[place(&rows[*own])] = -share);
    }
}
