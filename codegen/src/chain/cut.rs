//! Cuts through a crane, at which one part exerts forces on the other.

use super::{BodyId, Chain, Section};

/// A cut through the chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cut {
    /// Between the crane and the world: world frame, about the world's origin.
    Ground,
    /// At the joint of the link that begins with this body: in the frame reached by the link's last coordinate, about its
    /// origin; for a link without a joint, in the body's frame.
    Joint(BodyId),
    /// Before a body, in its frame; for a beam's element, at the section where it begins.
    Body(BodyId),
    /// Within a beam's element, in its frame, about the centre of the section: indices of the beam and of its section. At a pad on which the
    /// beam slides, in that of the element on which the pad is.
    Inside(usize, usize),
}

impl Chain {
    /// All cuts: the ground, then from base to tip the joint of every link and the bodies of that link, each element of a beam followed by
    /// the sections within it, the last one also by those at the pads on which the beam slides.
    #[must_use]
    pub fn cuts(&self) -> Vec<Cut> {
        let mut cuts = vec![Cut::Ground];
        let within = |beam: usize, section: usize| (&self.beams[beam].sections[section], Cut::Inside(beam, section));
        let of_beam = |beam: usize| (0..self.beams[beam].sections.len()).map(move |section| within(beam, section));
        let mut inside =
            (0..self.beams.len()).flat_map(of_beam).filter(|(section, _)| !section.begins_element()).peekable();
        for (index, body) in self.bodies.iter().enumerate() {
            let begins_link = index.checked_sub(1).is_none_or(|before| self.bodies[before].link != body.link);
            cuts.extend(begins_link.then_some(Cut::Joint(BodyId(index))));
            cuts.push(Cut::Body(BodyId(index)));
            let here = |(section, _): &(&Section, Cut)| section.body == BodyId(index);
            cuts.extend(std::iter::from_fn(|| inside.next_if(here)).map(|(_, cut)| cut));
        }
        cuts
    }
}
