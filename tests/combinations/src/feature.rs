//! The features that random cranes combine, and which of them the language excludes together.

use std::collections::BTreeSet;

macro_rules! features {
    ($($name:ident: $what:literal,)*) => {
        /// A feature of the spec language.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
        pub enum Feature { $(#[doc = $what] $name,)* }

        impl Feature {
            /// All of them.
            pub const ALL: &[Feature] = &[$(Feature::$name),*];

            /// What it is, in a few words.
            #[must_use]
            pub fn words(self) -> &'static str {
                match self { $(Feature::$name => $what,)* }
            }
        }
    };
}

features! {
    FreeBase: "base on four supports",
    ExactSupports: "supports with exact kinematics",
    OneSidedFeet: "feet that lift",
    FlexibleBoom: "boom of rigid elements",
    FlexibleArm: "arm of rigid elements",
    Taper: "tapered and stepped boom",
    Bend: "curved boom",
    PaperJoint: "boom with the paper's section joint",
    OneByOne: "arm given element by element",
    ExtraMass: "boom with distributed extra mass",
    Telescope: "stage that slides on the arm",
    Pads: "stages that are beams on pads in the arm and in each other",
    ExactPads: "pads that do not give way",
    Coupling: "second stage that follows the first",
    Rope: "rope of rigid links to the hook",
    Swing: "hook that swings on a universal joint",
    RigidDrive: "slewing prescribed by a rigid drive",
    LimitedDrive: "drive with a maximum effort",
    Effort: "drive with an effort besides spring and damper",
    Motion: "drives that move",
    Rotor: "rotors in drives",
    Stop: "end stop in contact",
    Friction: "joint friction",
    Bristles: "joint that sticks on bristles",
    WorldForce: "load along fixed axes",
    LinkMoment: "load that turns with its link",
    TimedLoad: "load that changes over time",
    Input: "inputs",
    Spring: "spring between two links",
    GasSpring: "gas spring between two links",
    Guy: "rope to the world",
    Winch: "winch",
    Sheaves: "rope over sheaves on several links, with falls",
    Cylinder: "cylinder between its pins",
    Linkage: "cylinder with rocker and link",
    Valve: "cylinders with valves",
    Parameters: "live parameters",
    DenavitHartenberg: "D-H rows",
    SecondArm: "branches: a second arm, and a lamp on the boom",
    Loop: "closed loop: a lever on the column, moved by the boom through a rod or a bar",
}

/// A set of features.
pub type Features = BTreeSet<Feature>;

impl Feature {
    /// Features without which it means nothing.
    #[must_use]
    pub fn needs(self) -> &'static [Feature] {
        use Feature as F;
        match self {
            F::ExactSupports | F::OneSidedFeet => &[F::FreeBase],
            F::Taper | F::Bend | F::PaperJoint | F::ExtraMass => &[F::FlexibleBoom],
            F::OneByOne => &[F::FlexibleArm],
            F::Pads => &[F::Telescope, F::FlexibleArm],
            F::ExactPads => &[F::Pads],
            F::Coupling => &[F::Telescope],
            F::Winch => &[F::Guy],
            F::Valve => &[F::Cylinder],
            F::TimedLoad => &[F::WorldForce],
            _ => &[],
        }
    }

    /// Features that the language, or sense, excludes beside it, each with the reason.
    #[must_use]
    pub fn excludes(self) -> &'static [(Feature, &'static str)] {
        use Feature as F;
        match self {
            F::Rope => &[(F::Swing, "the hook hangs from one of them")],
            F::Pads => &[(F::OneByOne, "pads are on beams that are divided into sections")],
            F::RigidDrive => &[(F::Bristles, "a prescribed joint does not stick, and both are on the slewing joint")],
            _ => &[],
        }
    }
}

/// The feature with those that it needs.
#[must_use]
pub fn with_needs(feature: Feature) -> Features {
    let mut all: Features = feature.needs().iter().flat_map(|needed| with_needs(*needed)).collect();
    all.insert(feature);
    all
}

/// Why two features cannot meet; `None` if they can.
#[must_use]
pub fn excluded(a: Feature, b: Feature) -> Option<&'static str> {
    let (first, second) = (with_needs(a), with_needs(b));
    let pairs = first.iter().flat_map(|x| second.iter().map(move |y| (*x, *y)));
    pairs.into_iter().find_map(|(x, y)| {
        let by = |x: Feature, y: Feature| x.excludes().iter().find(|(other, _)| *other == y).map(|(_, why)| *why);
        by(x, y).or_else(|| by(y, x))
    })
}

/// All pairs of features that can meet.
#[must_use]
pub fn pairs() -> Vec<(Feature, Feature)> {
    let all = Feature::ALL;
    let of = |(k, a): (usize, &Feature)| all[k + 1..].iter().map(|b| (*a, *b)).collect::<Vec<_>>();
    all.iter().enumerate().flat_map(of).filter(|(a, b)| excluded(*a, *b).is_none()).collect()
}
