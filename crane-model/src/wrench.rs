//! Wrenches between parts of a crane, and the cuts at which they are computed.

use nalgebra::Vector3;

/// A force and a moment about a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrench {
    /// Force, N.
    pub force: Vector3<f64>,
    /// Moment about the point, N m.
    pub moment: Vector3<f64>,
}

impl Wrench {
    /// No force and no moment.
    pub const ZERO: Wrench = Wrench { force: Vector3::new(0.0, 0.0, 0.0), moment: Vector3::new(0.0, 0.0, 0.0) };
}

/// Force with which a connector pulls its two points together, and how it depends on their distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tension {
    /// Force, N; negative where the connector pushes.
    pub force: f64,
    /// Its derivative with respect to the length, N/m.
    pub stiffness: f64,
    /// Its derivative with respect to the rate of the length, N s/m.
    pub damping: f64,
}

impl Tension {
    /// No force.
    pub const ZERO: Tension = Tension { force: 0.0, stiffness: 0.0, damping: 0.0 };

    /// Stiffness and damping for an implicit step, never negative.
    #[cfg(feature = "std")]
    pub(crate) fn stiffness_and_damping(&self) -> [f64; 2] {
        [self.stiffness.max(0.0), self.damping.max(0.0)]
    }
}

/// Where a crane is cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cut {
    /// Between the crane and the world: world frame, about the world's origin.
    Ground,
    /// At a link's joint, in the frame reached by the link's last coordinate, about its origin. That frame moves with the link; a rotation
    /// leaves its own axis, and thus that of the bearing, in place. For a link without a joint, in the link's frame.
    Joint {
        /// Index of the link's first body.
        body: usize,
    },
    /// Before a body, in its frame: for an element of a beam, the section where the element begins, with x along the beam.
    Body {
        /// Index of the body.
        body: usize,
        /// For an element of a beam, the index of the section among [`Description::sections`](crate::Description::sections).
        section: Option<usize>,
    },
    /// Within an element of a beam, in the element's frame, about the centre of the section.
    Inside {
        /// Index of the section among [`Description::sections`](crate::Description::sections).
        section: usize,
    },
}

impl Cut {
    /// Index of the section that is cut, if it is one of a beam or rope.
    pub const fn section(&self) -> Option<usize> {
        match *self {
            Cut::Body { section, .. } => section,
            Cut::Inside { section } => Some(section),
            Cut::Ground | Cut::Joint { .. } => None,
        }
    }
}

/// Adds `force` times some wrenches to others, one by one.
#[cfg(feature = "std")]
pub(crate) fn add(sums: &mut [Wrench], force: f64, wrenches: &[Wrench]) {
    // A cylinder that does not push may have a linkage that does not reach.
    if force == 0.0 {
        return;
    }
    for (sum, wrench) in sums.iter_mut().zip(wrenches) {
        sum.force += force * wrench.force;
        sum.moment += force * wrench.moment;
    }
}

#[cfg(feature = "std")]
impl crate::description::Description {
    /// Cuts of the crane, in the order of [`InternalForces::internal_forces`](crate::InternalForces::internal_forces): the
    /// ground, then from base to tip the joint of every link and the bodies of that link, each element of a beam followed by the sections
    /// within it.
    pub fn cuts(&self) -> Vec<Cut> {
        let mut cuts = vec![Cut::Ground];
        let mut link = None;
        let mut sections = self.sections.iter().enumerate().peekable();
        for (body, info) in self.bodies.iter().enumerate() {
            if link != Some(&info.link) {
                cuts.push(Cut::Joint { body });
                link = Some(&info.link);
            }
            let mut next = || sections.next_if(|(_, section)| section.body == body).map(|(index, _)| index);
            cuts.push(Cut::Body { body, section: next() });
            while let Some(section) = next() {
                cuts.push(Cut::Inside { section });
            }
        }
        cuts
    }
}
