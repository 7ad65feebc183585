//! The load that lifts the first foot, and the load that tips the crane.

use super::{
    Limit, Limits, PartLimit, range_of_loads,
    rating::{LoadSearch, Posed},
    search::{FAST, Range, Trial},
    sweep::mass_with,
};
use crate::{
    dyn_crane::DynCrane,
    statics::{Diagnosis, RestSearch, Status},
};

/// Relative accuracy of a critical load.
const ACCURACY: f64 = 1e-8;
/// Part of a load by which another one is a little larger.
const A_LITTLE: f64 = 1e-6;
/// Powers of two by which the mass of the crane is multiplied to find a load with which it stands, if it does not stand without one.
const SEARCHED: std::ops::RangeInclusive<i32> = -8..=3;
/// How many times the way to the least load is halved: to 1e-6 of the first with which the crane stands.
const HALVINGS: u32 = 20;

/// What a load may do to a crane on feet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Critical {
    /// A foot carries nothing.
    FirstFoot,
    /// The crane tips.
    Tipping,
}

/// A critical load: with less the crane stands, with more it does not.
#[derive(Clone, Debug, PartialEq)]
pub struct CriticalLoad {
    /// The load, in the unit of its parameter.
    pub load: f64,
    /// The foot that lifts, or the feet about which the crane tips.
    pub location: String,
    /// The least load with which it stands, if it does not stand without one.
    pub at_least: Option<f64>,
}

/// Why there is no critical load.
#[derive(Clone, Debug, PartialEq)]
pub enum NoCriticalLoad {
    /// The crane has no supports.
    NoSupports,
    /// With none of the loads tried does every foot carry something, or is the crane in balance.
    Never {
        /// What it is that never holds.
        critical: Critical,
    },
    /// It is not reached up to a load.
    Beyond {
        /// The largest load considered.
        load: f64,
    },
    /// Something else ends the equilibrium first.
    Otherwise {
        /// The largest load with which the crane rests.
        load: f64,
        /// How statics ends with a little more.
        status: Status,
        /// And why.
        diagnosis: Box<Diagnosis>,
    },
}

impl NoCriticalLoad {
    /// The reason in words; loads are in `unit`.
    pub fn reason(&self, unit: &str) -> String {
        match self {
            Self::NoSupports => "the crane has no supports".to_owned(),
            Self::Never { critical: Critical::FirstFoot } => {
                "no load was found with which every foot carries something".to_owned()
            }
            Self::Never { critical: Critical::Tipping } => "no load was found with which the crane stands".to_owned(),
            Self::Beyond { load } => format!("not with up to {load} {unit}"),
            Self::Otherwise { load, status: Status::Converged, .. } => {
                format!("with more than {load:.1} {unit} the crane gives way, and rests elsewhere")
            }
            Self::Otherwise { load, status, diagnosis } => {
                format!(
                    "with more than {load:.1} {unit} the crane does not rest, for another reason: {status}{diagnosis}"
                )
            }
        }
    }
}

/// A critical load of a crane, with its drives at the beginning of their motions: the largest with which the crane stands, and with every
/// smaller one down to the smallest load with which it does, up to [gaps](super). The load does not depend on the present value of the parameter, which is
/// left at another one.
///
/// # Errors
/// There is none.
pub fn critical_load(
    crane: &mut dyn DynCrane,
    parameter: usize,
    critical: Critical,
) -> Result<CriticalLoad, NoCriticalLoad> {
    let description = crane.description().clone();
    if description.supports.is_empty() {
        return Err(NoCriticalLoad::NoSupports);
    }
    let spec_load = crane.parameter(parameter);
    let [least, _] = range_of_loads(crane, parameter, None);
    let mass = mass_with(crane, parameter, least);
    let [_, greatest] = range_of_loads(crane, parameter, None);
    let limits = match critical {
        Critical::FirstFoot => Limits { of_parts: vec![PartLimit::LiftOff], ..Limits::none(&description) },
        Critical::Tipping => Limits { tipping: Some(0.0), ..Limits::none(&description) },
    };
    let positions = crane.drive_targets_at(0.0);
    let range = Range { greatest, guess: 0.0, scale: mass.max(f64::MIN_POSITIVE), accuracy: ACCURACY, growth: FAST };
    let search = LoadSearch { limits: &limits, factor: 1.0, range, points: &[] };
    let mut posed = Posed { crane, load: parameter, positions: &positions };
    let multiples = SEARCHED.map(|power| mass * 2.0_f64.powi(power));
    let loads = [least].into_iter().chain(multiples).chain([spec_load]).filter(|load| *load <= greatest);
    let mut stands = |load: f64| {
        let at = posed.find(load, None)?;
        Some(posed.trial(load, at, &search)).filter(Trial::is_within)
    };
    let loads: Vec<f64> = loads.collect();
    let first = loads.iter().find_map(|load| stands(*load)).ok_or(NoCriticalLoad::Never { critical })?;
    let at_least = (first.load > least).then(|| {
        let [mut falls, mut holds] = [least, first.load];
        for _ in 0..HALVINGS {
            let half = 0.5 * (falls + holds);
            if stands(half).is_some() { holds = half } else { falls = half }
        }
        holds
    });
    let (best, governing) = posed.find_largest(first, &search);
    let load = best.ok_or(NoCriticalLoad::Never { critical })?.load;
    match governing {
        None => Err(NoCriticalLoad::Beyond { load }),
        Some(Limit::Equilibrium) => match beyond(&mut posed, load) {
            (Status::TipsOver { feet }, _) if critical == Critical::Tipping => {
                Ok(CriticalLoad { load, location: feet.join(" – "), at_least })
            }
            (status, diagnosis) => Err(NoCriticalLoad::Otherwise { load, status, diagnosis: Box::new(diagnosis) }),
        },
        Some(limit) => Ok(CriticalLoad { load, location: limit.location(crane), at_least }),
    }
}

/// How statics ends with a little more than a load, and why.
fn beyond(posed: &mut Posed<'_>, load: f64) -> (Status, Diagnosis) {
    match posed.crane.set_parameter(posed.load, load * (1.0 + A_LITTLE)) {
        Ok(()) => {
            let equilibrium = RestSearch { crane: posed.crane, positions: posed.positions }.find_from_guess();
            let diagnosis = Diagnosis::new(posed.crane, &equilibrium);
            (equilibrium.status, diagnosis)
        }
        Err(_) => (Status::NotConverged, Diagnosis::Unknown),
    }
}
