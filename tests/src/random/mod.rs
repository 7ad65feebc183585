//! Random cranes, as specs, with fixed seeds: all kinds of joints, placements, drives and supports, two flexible links.

mod branches;
mod forces;

use std::fmt::Write;

use fastrand::Rng;

/// A random crane as YAML. The same seed gives the same text.
pub fn spec(seed: u64) -> String {
    Writer::new(seed, true).crane(seed)
}

/// The same with branches: links on links that have others on them, beside each other in the text and apart.
#[allow(dead_code)] // the build script compiles cranes without branches
pub fn with_branches(seed: u64) -> String {
    Writer { branches: true, ..Writer::new(seed, true) }.crane(seed)
}

/// The same without drives and dampers: its energy is conserved.
#[allow(dead_code)] // the build script compiles driven cranes only
pub fn conservative(seed: u64) -> String {
    Writer::new(seed, false).crane(seed)
}

struct Writer {
    rng: Rng,
    text: String,
    /// Coordinates of joints, and whether they are rotations.
    coordinates: Vec<(String, bool)>,
    /// Whether it has drives and dampers.
    driven: bool,
    /// Whether it has branches.
    branches: bool,
    /// What the next link is attached to, unless it is the previous one.
    on: Option<String>,
    /// Which flexible links have the section joint of the paper: the first, the second, both or none, depending on the seed.
    paper: [bool; 2],
}

/// Freedom of the base.
#[derive(Clone, Copy, PartialEq)]
enum Base {
    Fixed,
    Free,
    Subset,
}

impl Writer {
    fn new(seed: u64, driven: bool) -> Self {
        Writer {
            rng: Rng::with_seed(seed),
            text: String::new(),
            coordinates: Vec::new(),
            driven,
            branches: false,
            on: None,
            paper: [seed / 2 % 2 == 1, seed / 4 % 2 == 1],
        }
    }

    fn crane(mut self, seed: u64) -> String {
        let base = [Base::Free, Base::Subset, Base::Fixed][usize::try_from(seed % 3).unwrap_or(0)];
        self.line("format: 1");
        self.line(&format!("name: random_{seed}"));
        self.line(["loops: auto", "loops: always", "loops: never"][usize::try_from(seed % 3).unwrap_or(0)]);
        let gravity = self.vector(3.0);
        self.line(&format!("gravity: {gravity}"));
        let head = std::mem::take(&mut self.text);
        self.line("materials:");
        self.line("  soft: {E: modulus, G: 4.0e6, density: 1200, yield_stress: 3.0e6}");
        self.line("links:");
        self.base(base);
        // Every kind occurs at least once over the seeds: a fixed link, a prismatic one, both flexible ones, classic DH parameters.
        self.link("arm", "revolute", true);
        self.beam("first", false);
        self.link("plate", "fixed", false);
        self.link("slide", "prismatic", true);
        self.beam("second", seed % 2 == 1);
        self.massless("fork");
        self.tip("hand");
        if seed % 4 == 1 {
            let damping = if self.driven { ", damping: 0.2" } else { "" };
            let rope = format!("{{length: 0.9, links: 2, mass_per_length: 1.3{damping}}}");
            self.line(&format!(
                "  - {{name: cable, placement: {{transform: {{rotation: {{y: 50 deg}}}}}}, rope: {rope}}}"
            ));
        }
        if self.branches {
            self.branches();
        }
        self.supports(base, seed);
        if self.driven {
            self.drives(seed);
        }
        if self.driven && seed % 4 == 2 {
            self.loads();
        }
        if self.driven && seed % 4 == 3 {
            self.cylinders(seed);
        }
        if self.driven && seed % 4 >= 2 {
            self.connectors();
            self.couplings();
        }
        self.line("points:");
        for (name, link) in [("middle", "first"), ("end", "hand")] {
            let at = self.vector(0.5).replace("[-", "[");
            self.line(&format!("  - {{name: {name}, link: {link}, at: {at}}}"));
        }
        format!("{head}{}{}", self.parameters(), self.text)
    }

    /// The live parameters that the crane uses.
    fn parameters(&self) -> String {
        let rows = [
            ("payload", "{value: 7.5}"),
            ("reach", "{value: 0.6, unit: m}"),
            ("modulus", "{value: 1.1e7, unit: Pa}"),
            ("ground", "{value: 4.0e3, unit: N/m}"),
            ("swing", "{value: 0.8, unit: rad}"),
        ];
        let used = rows.into_iter().filter(|(name, _)| self.text.contains(name));
        used.fold("parameters:\n".into(), |text, (name, value)| format!("{text}  {name}: {value}\n"))
    }

    fn base(&mut self, base: Base) {
        self.line("  - name: foot");
        match base {
            Base::Fixed => self.line("    joint: fixed"),
            Base::Free => self.line("    joint: free"),
            Base::Subset => self.line("    joint: {free: [x, z, psi, phi]}"),
        }
        let at = self.vector(1.0);
        self.line(&format!("    placement: {{transform: {{translation: {at}}}}}"));
        self.body(40.0);
    }

    /// A link with its own mass.
    fn link(&mut self, name: &str, joint: &str, may_turn_axis: bool) {
        self.begin(name);
        self.placement_and_joint(name, joint, may_turn_axis);
        self.body(9.0);
    }

    /// Begins a link, on another one than the previous if so decided.
    fn begin(&mut self, name: &str) {
        self.line(&format!("  - name: {name}"));
        if let Some(on) = self.on.take() {
            self.line(&format!("    on: {on}"));
        }
    }

    fn placement_and_joint(&mut self, name: &str, joint: &str, may_turn_axis: bool) {
        let (a, d) = (self.number(0.8), self.number(0.8));
        let (alpha, theta) = (self.angle(), self.angle());
        let kind = self.rng.u8(0..3);
        let mut axis = "z";
        match kind {
            0 => self
                .line(&format!("    placement: {{modified_dh: {{a: {a}, alpha: {alpha}, d: {d}, theta: {theta}}}}}")),
            1 => {
                self.line(&format!(
                    "    placement: {{classic_dh: {{a: reach, alpha: {alpha}, d: {d}, theta: {theta}}}}}"
                ));
            }
            _ => {
                let by = self.vector(0.9);
                self.line(&format!(
                    "    placement: {{transform: {{translation: {by}, rotation: [{{y: {alpha}}}, {{x: {theta}}}]}}}}"
                ));
                if may_turn_axis {
                    axis = ["x", "y", "z"][self.rng.usize(0..3)];
                }
            }
        }
        if joint == "fixed" {
            self.line("    joint: fixed");
            return;
        }
        self.line(&format!("    joint: {{{joint}: {{axis: {axis}}}}}"));
        let rotation = joint == "revolute";
        let symbol = match (rotation, axis) {
            (true, "x") => "phi",
            (true, "y") => "theta",
            (true, _) => "psi",
            (false, axis) => axis,
        };
        self.coordinates.push((format!("{name}_{symbol}"), rotation));
    }

    /// A flexible link, by its section or element by element.
    fn beam(&mut self, name: &str, one_by_one: bool) {
        self.begin(name);
        self.placement_and_joint(name, "revolute", false);
        self.line("    beam:");
        self.line("      length: 1.2");
        if self.paper[usize::from(name == "second")] {
            self.line("      section_joint: paper");
        }
        if one_by_one {
            self.line("      elements:");
            for length in [0.5, 0.7] {
                let (mass, com) = (self.positive(2.0), self.vector(0.2));
                let inertia = self.inertia(0.3);
                self.line(&format!("        - {{length: {length}, mass: {mass}, com: {com}, inertia: {inertia}}}"));
            }
            self.line("      springs:");
            let damping = if self.driven { ", damping: {psi: 0.4, theta: 0.3, phi: 0.2}" } else { "" };
            self.line(&format!("        - {{stiffness: {{psi: 310, theta: 250, phi: 180}}{damping}}}"));
            return;
        }
        let section = [
            "{box: {height: 0.09, width: 0.07, thickness: 0.004}}",
            "{welded_box: {height: 0.09, width: 0.07, flange: 0.006, web: 0.003}}",
            "{tube: {diameter: 0.08, thickness: 0.005}}",
            "{solid: {height: 0.05, width: 0.03}}",
            "{circle: {diameter: 0.06}}",
            "{numbers: {area: 1.1e-3, Jy: 8.0e-7, Jz: 1.2e-6, Jo: 1.5e-6}}",
        ][self.rng.usize(0..6)];
        self.line("      sections: 2");
        self.line("      material: soft");
        self.line(&format!("      section: {section}"));
        self.line("      extra_mass: 0.8");
        let damping = ["{beta: 2.0e-3}", "{beta: {psi: 1.0e-3, theta: 2.0e-3, phi: 3.0e-3}}"][self.rng.usize(0..2)];
        if self.driven {
            self.line(&format!("      damping: {damping}"));
        }
    }

    /// Half of a universal joint.
    fn massless(&mut self, name: &str) {
        self.line(&format!("  - name: {name}"));
        self.placement_and_joint(name, "revolute", false);
    }

    /// Two bodies in one link, one of them with a live mass.
    fn tip(&mut self, name: &str) {
        self.line(&format!("  - name: {name}"));
        // Its axis is not parallel to that of the fork; otherwise nothing would resist one of the two rotations.
        let by = self.vector(0.3);
        self.line(&format!("    placement: {{transform: {{translation: {by}, rotation: {{x: 70 deg}}}}}}"));
        self.line("    joint: revolute");
        self.coordinates.push((format!("{name}_psi"), true));
        let (claw, load) = (self.vector(0.3), self.vector(0.4));
        let inertia = self.inertia(1.5);
        self.line("    bodies:");
        self.line(&format!("      - {{name: claw, mass: 4.2, com: {claw}, inertia: {inertia}}}"));
        self.line(&format!(
            "      - {{name: load, mass: payload, com: {load}, inertia: {{gyration: [0.2, 0.3, 0.25]}}}}"
        ));
    }

    fn body(&mut self, scale: f64) {
        let (mass, com, inertia) = (self.positive(scale), self.vector(0.4), self.inertia(scale));
        self.line(&format!("    mass: {mass}"));
        self.line(&format!("    com: {com}"));
        self.line(&format!("    inertia: {inertia}"));
    }

    /// The inertia of six random particles: arbitrary numbers would not be those of a body.
    fn inertia(&mut self, scale: f64) -> String {
        let mut second = [[0.0; 3]; 3];
        for _ in 0..6 {
            let r = [0; 3].map(|_| self.rng.f64() - 0.5);
            let mass = scale * (0.1 + self.rng.f64());
            for (i, row) in second.iter_mut().enumerate() {
                for (j, entry) in row.iter_mut().enumerate() {
                    *entry += mass * r[i] * r[j];
                }
            }
        }
        let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = second;
        format!(
            "{{Ixx: {:?}, Iyy: {:?}, Izz: {:?}, Ixy: {:?}, Ixz: {:?}, Iyz: {:?}}}",
            yy + zz,
            xx + zz,
            xx + yy,
            -xy,
            -xz,
            -yz
        )
    }

    fn line(&mut self, line: &str) {
        let _ = writeln!(self.text, "{line}");
    }

    /// A number in ±scale, as text that reads back exactly.
    fn number(&mut self, scale: f64) -> String {
        format!("{:?}", scale * (2.0 * self.rng.f64() - 1.0))
    }

    fn positive(&mut self, scale: f64) -> String {
        format!("{:?}", scale * (0.2 + self.rng.f64()))
    }

    fn vector(&mut self, scale: f64) -> String {
        let [x, y, z] = [0; 3].map(|_| self.number(scale));
        format!("[{x}, {y}, {z}]")
    }

    /// An angle in one of the notations of the language.
    fn angle(&mut self) -> String {
        let degrees = self.rng.i32(-11..12) * 15;
        match self.rng.u8(0..4) {
            0 => format!("{degrees} deg"),
            1 => format!("{}/12 pi", degrees / 15),
            2 => "90 deg".into(),
            _ => self.number(3.0),
        }
    }
}
