//! Where a crane is cut, and the sections of its beams.

#[cfg(feature = "std")]
use super::Description;

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
        /// For an element of a beam, the index of the section among [`Description::sections`](super::Description::sections).
        section: Option<usize>,
    },
    /// Within an element of a beam, in the element's frame, about the centre of the section.
    Inside {
        /// Index of the section among [`Description::sections`](super::Description::sections).
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

#[cfg(feature = "std")]
impl Description {
    /// Cuts of the crane, in the order of `CraneModel::internal_forces`: the
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

    /// Names of the links that are beams or ropes, in the order of their sections.
    pub fn beams(&self) -> Vec<&str> {
        let beams = self.sections_of_beams();
        beams.into_iter().map(|beam| self.bodies[self.sections[beam.start].body].link.as_str()).collect()
    }

    /// Indices of the sections of each beam.
    pub fn sections_of_beams(&self) -> Vec<std::ops::Range<usize>> {
        let link = |section: usize| &self.bodies[self.sections[section].body].link;
        let mut beams: Vec<std::ops::Range<usize>> = Vec::new();
        for section in 0..self.sections.len() {
            match beams.last_mut().filter(|beam| link(beam.start) == link(section)) {
                Some(beam) => beam.end = section + 1,
                None => beams.push(section..section + 1),
            }
        }
        beams
    }
}
