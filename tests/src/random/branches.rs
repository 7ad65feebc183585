//! Branches of random cranes.

use super::Writer;

impl Writer {
    /// Links on the middle of a beam, on its start, beside its tip, on rigid links; a flexible branch with two links on its tip; links of one
    /// branch that others separate in the text.
    pub(super) fn branches(&mut self) {
        let (y, z) = (self.number(0.1), self.number(0.1));
        let x = self.positive(0.5);
        self.link_on(&format!("{{link: first, at: [{x}, {y}, {z}]}}"), "side", "revolute");
        self.on = Some("arm".into());
        self.beam("third", true);
        self.link("grip", "revolute", true);
        self.link_on("{link: second, at: start}", "twig", "prismatic");
        self.link_on("side", "claw", "revolute");
        self.link_on("{link: third, at: tip}", "lid", "fixed");
        self.link_on(&format!("{{link: first, at: [1.2, {y}, {z}]}}"), "spur", "revolute");
        self.link_on(&format!("{{link: third, at: [reach, {z}, {y}]}}"), "hook", "prismatic");
        self.link_on("{link: arm, at: [0.2, -0.1, 0.3]}", "shelf", "fixed");
        self.telescope();
    }

    /// A beam that slides in the first one, with something on its tip.
    fn telescope(&mut self) {
        self.line("  - name: sleeve");
        self.line("    joint: {prismatic: {axis: x}}");
        self.line("    beam:");
        self.line("      length: 0.9");
        self.line("      sections: 2");
        self.line("      material: soft");
        self.line("      section: {tube: {diameter: 0.05, thickness: 0.006}}");
        self.line("      damping: {beta: 1.0e-3}");
        let front = "{stiffness: [400, ground, 20], damping: [3, 2, 0.1], clearance: [0.01, 0, 0.02]}";
        let rear = "{stiffness: [350, 450, 0], damping: [1, 2, 0]}";
        self.line(&format!("      slides_in: {{beam: first, overlap: reach, pads: {{front: {front}, rear: {rear}}}}}"));
        self.line("  - {name: knob, mass: 1.1, com: [0.1, 0.05, 0], inertia: {gyration: [0.1, 0.1, 0.1]}}");
    }

    fn link_on(&mut self, on: &str, name: &str, joint: &str) {
        self.on = Some(on.into());
        self.link(name, joint, true);
    }
}
