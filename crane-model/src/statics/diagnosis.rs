//! Why statics found no stable equilibrium, and what to do about it.

use std::fmt;

use nalgebra::DVector;

use super::{
    Equilibrium, Problem, Status, equations::Equations, newton::rounding_hides, open_guess, overloaded::overloaded,
};
use crate::{
    CoordinateKind, CoordinateRole, Text,
    dyn_crane::DynCrane,
    feet::Feet,
    hydraulics::unassembled_at,
    loop_joints::{Gap, gap_at, prescribed_too_much},
    tipping::{LinkMoment, TippingLine, lines, moments},
};

/// Distance below which feet are in one place, m.
const ONE_PLACE: f64 = 1e-3;
/// Distance above the other feet from which one is in the wrong place, m.
const RAISED: f64 = 0.5;
/// Tangent stiffness beyond which rounding hides all other forces, N/m or N m/rad.
const TOO_STIFF: f64 = 1e15;

/// Why there is no stable equilibrium, as far as the crane shows it.
#[derive(Clone, Debug, PartialEq)]
pub enum Diagnosis {
    /// The linkage of a cylinder cannot be assembled at the guess.
    Unassembled {
        /// The cylinder.
        cylinder: Text,
    },
    /// A loop cannot be closed from the guess.
    OpenLoop {
        /// The joint that is open, where the search ended.
        gap: Gap,
        /// Coordinates in loops that rigid drives prescribe, if they prescribe more than the loops leave free.
        prescribed: Vec<String>,
    },
    /// Drives are at the limits of their efforts.
    Overloaded {
        /// Their coordinates.
        coordinates: Vec<Text>,
    },
    /// Weight and loads pull the crane off its feet.
    Floats {
        /// Their sum, upwards, N.
        upwards: f64,
    },
    /// Feet slide under a lateral force.
    Slides {
        /// The foot that is furthest beside its place.
        foot: Text,
        /// How far, m.
        distance: f64,
    },
    /// The feet form no polygon that the crane can stand on.
    NoPolygon {
        /// Whether they are all in one place, instead of on one line.
        one_place: bool,
    },
    /// The moments about a tipping line overturn the crane.
    Overturned {
        /// The feet of the line.
        feet: [Text; 2],
        /// Moments about the line, N m.
        line: TippingLine,
        /// The link that contributes most to the overturning moment, and the one that contributes most to the stabilising one.
        most: [Option<LinkMoment>; 2],
    },
    /// The crane would stand on rigid feet; its own yield until it falls.
    Yields {
        /// The tipping margin with rigid feet.
        margin: f64,
    },
    /// A foot is far above or below the others.
    RaisedFoot {
        /// The foot.
        foot: Text,
        /// How far it is above them, m; negative below.
        height: f64,
    },
    /// A spring is so stiff that rounding hides all other forces.
    TooStiff {
        /// The coordinate that it holds.
        coordinate: Text,
        /// The tangent stiffness along it, N/m or N m/rad.
        stiffness: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// Rounding hides the balance of forces.
    Rounding {
        /// The residual that is left, relative to the greatest forces.
        residual: f64,
    },
    /// Numbers overflow.
    Overflow,
    /// Nothing more is known.
    Unknown,
}

impl Diagnosis {
    /// Of an equilibrium that is not stable.
    pub fn new(crane: &dyn DynCrane, equilibrium: &Equilibrium) -> Self {
        let guess = open_guess(crane);
        if let Some(cylinder) = unassembled_at(crane, &guess) {
            return Self::Unassembled { cylinder };
        }
        if let Some(gap) = gap_at(crane, &equilibrium.q) {
            return Self::OpenLoop { gap, prescribed: prescribed_too_much(crane, &equilibrium.q) };
        }
        let coordinates = overloaded(crane, &equilibrium.q);
        if !coordinates.is_empty() {
            return Self::Overloaded { coordinates };
        }
        match &equilibrium.status {
            Status::Floats => Self::Floats { upwards: upwards(crane, 0.0, &guess).unwrap_or(f64::NAN) },
            Status::Slides { .. } => sliding(crane, &equilibrium.q),
            Status::Overflow => Self::Overflow,
            Status::TipsOver { .. } | Status::Singular { .. } | Status::Unstable { .. }
                if has_no_polygon(crane, &guess) =>
            {
                let feet = crane.support_positions_at(&guess);
                let one_place = feet.iter().all(|foot| (foot - feet[0]).xy().norm() < ONE_PLACE);
                Self::NoPolygon { one_place }
            }
            Status::TipsOver { feet } => tipping(crane, &Problem::new(crane).standing_from(&guess), feet),
            _ => raised_foot(crane, &guess)
                .or_else(|| too_stiff(crane, &guess))
                .or_else(|| rounding(crane, equilibrium))
                .unwrap_or(Self::Unknown),
        }
    }

    /// What to do about it.
    pub fn advice(&self) -> String {
        match self {
            Self::Unassembled { .. } => {
                "lengthen its `rocker` or `link`, check the positions of its pins, or start from a pose where they reach each other".to_owned()
            }
            Self::OpenLoop { prescribed, .. } if !prescribed.is_empty() => format!(
                "rigid drives prescribe {}, of which the loop determines a part: give one of these drives a `stiffness`, or leave its joint passive",
                prescribed.join(" and ")
            ),
            Self::OpenLoop { gap, .. } if gap.unit == "rad" => format!(
                "write `to_axis`, the axis of {} in the frame of its link `to`, which may be turned against that of `from`, or a `guess:` near a pose \
                 in which both point the same way",
                gap.joint
            ),
            Self::OpenLoop { .. } => {
                "check the points, axes and lengths of the loop's joints, and write a `guess:` near a pose in which they meet".to_owned()
            }
            Self::Overloaded { .. } => {
                "raise `max_effort` of these drives, or change `guess:` and the motions to a pose that they can hold".to_owned()
            }
            Self::Floats { .. } => {
                "z points upwards: write `gravity: [0, 0, -9.81]`, and check the loads that pull upwards".to_owned()
            }
            Self::Slides { foot, .. } => format!(
                "check the slope, the ropes and loads that pull sideways, and whether enough weight is on {foot}; `friction_coefficient` of its \
                 support, 0.6 by default, says how much it holds"
            ),
            Self::NoPolygon { .. } => {
                "give each foot its own place, `at: [x, y, z]` in m, so that they form a polygon around the crane".to_owned()
            }
            Self::Overturned { line, most, .. } => {
                let names: Vec<String> =
                    most.iter().flatten().map(|of_link| format!("`{}`", of_link.link)).collect();
                let check = match names.as_slice() {
                    [] => String::new(),
                    names => format!("; check the masses, in kg, and positions, in m, of {}", names.join(" and ")),
                };
                let newtons = most[0].as_ref().filter(|worst| is_weight(worst, line)).map_or_else(String::new, |worst| {
                    format!("; if the mass of `{}` is a weight in N, divide it by 9.81", worst.link)
                });
                format!("use a smaller load, a shorter reach, a wider stance or more ballast{check}{newtons}")
            }
            Self::Yields { .. } => {
                "check `stiffness`, in N/m, and `free_play`, in m, of the supports, and start from a `guess:` near the pose at rest".to_owned()
            }
            Self::RaisedFoot { foot, .. } => {
                format!("check the third number of `at` of {foot}, in m: the feet of a crane at rest are on one level")
            }
            Self::TooStiff { coordinate, .. } => {
                format!("check the stiffnesses of what holds {coordinate}, in N/m and N m/rad; with 1e10 a spring is as good as rigid")
            }
            Self::Rounding { .. } => {
                "check the places and lengths, in m, and the stiffnesses: one of them is far larger than all others".to_owned()
            }
            Self::Overflow => {
                "check the exponents and units of masses, stiffnesses and positions; `crane check` warns about unusual ones".to_owned()
            }
            Self::Unknown => {
                "change `guess:` in its spec to a pose near a stable equilibrium, or add a drive or spring to the coordinates named".to_owned()
            }
        }
    }
}

/// Whether a crane that is far from standing would stand if the mass of this link were a weight, in N instead of kg.
fn is_weight(worst: &LinkMoment, line: &TippingLine) -> bool {
    /// Beyond this ratio of moments, an ordinary overload is unlikely.
    const FAR: f64 = 2.5;
    let less = worst.moment.abs() * (1.0 - 1.0 / 9.81);
    line.overturning > FAR * line.stabilising && line.overturning - less < line.stabilising
}

/// Sum of weight and loads along z, N, if the crane can move that way.
pub(super) fn upwards(crane: &dyn DynCrane, t: f64, q: &[f64]) -> Option<f64> {
    Some(crane.weight_at(q)[2]? + crane.applied_force_at(t, q)[2]?)
}

/// Whether a base that can rotate about both horizontal axes has feet that form no polygon.
fn has_no_polygon(crane: &dyn DynCrane, q: &[f64]) -> bool {
    let description = crane.description();
    let tilts = description.coordinates.iter().filter(|info| {
        (info.role, info.kind) == (CoordinateRole::Base, CoordinateKind::Rotation) && !info.name.ends_with("_psi")
    });
    let rest = vec![0.0; q.len()];
    !description.supports.is_empty() && tilts.count() == 2 && lines(crane, 0.0, q, &rest, &rest).is_empty()
}

/// The foot that has slid furthest.
fn sliding(crane: &dyn DynCrane, q: &[f64]) -> Diagnosis {
    let feet = Feet::at_rest(crane, q);
    let most = feet.distances().max_by(|a, b| a.1.total_cmp(&b.1));
    most.map_or(Diagnosis::Unknown, |(foot, distance)| Diagnosis::Slides {
        foot: crane.description().supports[foot].name.clone(),
        distance,
    })
}

/// The foot that is furthest above or below the others, if it is too far.
fn raised_foot(crane: &dyn DynCrane, q: &[f64]) -> Option<Diagnosis> {
    let feet = crane.support_positions_at(q);
    let above_others = |foot: usize| {
        let mut others: Vec<f64> =
            feet.iter().enumerate().filter(|(other, _)| *other != foot).map(|(_, at)| at.z).collect();
        others.sort_by(f64::total_cmp);
        Some(feet[foot].z - others.get(others.len() / 2)?)
    };
    let heights = (0..feet.len()).filter_map(|foot| Some((foot, above_others(foot)?)));
    let (foot, height) = heights.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    let name = &crane.description().supports[foot].name;
    (height.abs() > RAISED).then(|| Diagnosis::RaisedFoot { foot: name.clone(), height })
}

/// The coordinate that is held most stiffly, if that is too stiff.
fn too_stiff(crane: &dyn DynCrane, q: &[f64]) -> Option<Diagnosis> {
    let coordinates = &crane.description().coordinates;
    let n = coordinates.len();
    let mut tangent = vec![0.0; n * n];
    crane.tangent_stiffness(0.0, q, &crane.drive_positions_at(0.0), &mut tangent);
    let held = coordinates.iter().enumerate().map(|(j, info)| (info, tangent[j * n + j]));
    let (info, stiffness) = held.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let unit = if info.kind == CoordinateKind::Rotation { "N m/rad" } else { "N/m" };
    (stiffness > TOO_STIFF).then(|| Diagnosis::TooStiff { coordinate: info.name.clone(), stiffness, unit })
}

/// Whether the search ended in rounding errors.
fn rounding(crane: &dyn DynCrane, equilibrium: &Equilibrium) -> Option<Diagnosis> {
    let q = DVector::from_column_slice(&equilibrium.q);
    let hides = equilibrium.status == Status::NotConverged && rounding_hides(&Equations::at(crane, 0.0), &q);
    hides.then(|| Diagnosis::Rounding { residual: equilibrium.residual() })
}

/// Why a crane tips over the line between two feet.
fn tipping(crane: &dyn DynCrane, q: &[f64], feet: &[Text]) -> Diagnosis {
    let description = crane.description();
    let rest = vec![0.0; q.len()];
    let name = |foot: usize| &description.supports[foot].name;
    let lines = lines(crane, 0.0, q, &rest, &rest);
    let Some(line) = lines.into_iter().find(|line| feet.iter().eq(line.feet.iter().map(|&foot| name(foot)))) else {
        return Diagnosis::Unknown;
    };
    if line.margin() > 0.0 {
        return Diagnosis::Yields { margin: line.margin() };
    }
    let links = moments(crane, 0.0, [q, &rest, &rest], line.feet);
    let greatest = |sign: f64| {
        let all = links.iter().filter(|of_link| sign * of_link.moment > 0.0);
        all.max_by(|a, b| (sign * a.moment).total_cmp(&(sign * b.moment))).cloned()
    };
    Diagnosis::Overturned {
        feet: line.feet.map(|foot| name(foot).clone()),
        line,
        most: [greatest(-1.0), greatest(1.0)],
    }
}

impl fmt::Display for Diagnosis {
    /// What is known beyond the status, as the end of a sentence; may be empty.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unassembled { cylinder } => {
                write!(
                    f,
                    "; the linkage of {cylinder} cannot be assembled at the guess: its rocker and link do not reach each other"
                )
            }
            Self::OpenLoop { gap, .. } => write!(f, "; a loop cannot be closed from the guess: {gap}"),
            Self::Overloaded { coordinates } => match coordinates.as_slice() {
                [one] => write!(f, "; the drive of {one} is at its limit"),
                several => write!(f, "; the drives of {} are at their limits", several.join(", ")),
            },
            Self::Floats { upwards } => {
                write!(f, "; together they pull upwards with {:.2} kN", upwards / 1e3)
            }
            Self::Slides { foot, distance } => write!(f, "; there {foot} is {:.0} mm beside its place", 1e3 * distance),
            Self::NoPolygon { one_place: true } => f.write_str("; seen from above, all its feet are in one place"),
            Self::NoPolygon { one_place: false } => f.write_str("; seen from above, all its feet are on one line"),
            Self::Overturned { feet: [from, to], line, most: [worst, best] } => {
                // Digits that tell them apart.
                let moments = |digits: usize| {
                    [line.overturning, line.stabilising].map(|moment| format!("{:.digits$}", moment / 1e3))
                };
                let [overturning, stabilising] =
                    (1..4).map(moments).find(|[one, other]| one != other).unwrap_or_else(|| moments(4));
                write!(
                    f,
                    "; about the line {from} – {to} the overturning moment is {overturning} kN m, the stabilising one {stabilising} kN m"
                )?;
                for (of_link, does, side) in [(worst, "overturns", "outside"), (best, "holds", "inside")] {
                    if let Some(LinkMoment { link, weight, moment }) = of_link {
                        let (newton, lever) = (weight / 1e3, (moment / weight).abs());
                        write!(f, "; {link} {does} it most, with {newton:.2} kN {lever:.2} m {side} the line")?;
                    }
                }
                Ok(())
            }
            Self::Yields { margin } => {
                write!(f, "; its feet yield until it falls: on rigid feet the tipping margin would be {margin:.4}")
            }
            Self::RaisedFoot { foot, height } => {
                let (size, side) = (height.abs(), if *height > 0.0 { "above" } else { "below" });
                write!(f, "; {foot} is {size:.2} m {side} the other feet")
            }
            Self::TooStiff { coordinate, stiffness, unit } => {
                write!(
                    f,
                    "; {coordinate} is held with {stiffness:.1e} {unit}, beside which rounding hides all other forces"
                )
            }
            Self::Rounding { residual } => {
                write!(f, "; rounding hides the balance of forces, of which {residual:.1e} of the largest is left")
            }
            Self::Overflow | Self::Unknown => Ok(()),
        }
    }
}
