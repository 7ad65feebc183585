//! What acts on random cranes: supports, drives, forces in joints, connectors, loads, cylinders.

use super::{Base, Writer};

impl Writer {
    pub(super) fn supports(&mut self, base: Base, seed: u64) {
        if base == Base::Fixed {
            return;
        }
        self.line("supports:");
        let damping = if self.driven { "damping: [40, 50, 90], " } else { "" };
        // Two supports of every other driven crane are one-sided; they stick, so that statics has a potential energy.
        let one_sided = if self.driven && seed % 2 == 1 { ", one_sided: true, sticks: true" } else { "" };
        let one_sided = ["", one_sided, one_sided];
        let kinds = [("left", "linear"), ("right", "exact"), ("rear", "linear")];
        for ((name, kinematics), one_sided) in kinds.into_iter().zip(one_sided) {
            let (at, play) = (self.vector(1.5), self.vector(0.02));
            self.line(&format!(
                "  - {{name: {name}, at: {at}, stiffness: [ground, 5.0e3, 9.0e3], {damping}free_play: {play}, \
                 kinematics: {kinematics}{one_sided}}}"
            ));
        }
    }

    pub(super) fn drives(&mut self, seed: u64) {
        self.line("drives:");
        let driven: Vec<_> = self.coordinates.iter().take(5).cloned().collect();
        let passive = self.coordinates[5..].to_vec();
        let first = self.rng.usize(0..8);
        for (k, (coordinate, rotation)) in driven.into_iter().enumerate() {
            let to = if rotation { "swing".into() } else { self.number(0.5) };
            let from = self.number(0.5);
            // A third of them is rigid, on joints that turn and that slide.
            let by_oil = seed % 8 == 7 && k == 1;
            let rigid = self.rng.u8(0..3) == 0 && !by_oil;
            // Only a flexible drive may jump to another speed during a run.
            let shape = ["", ", shape: spline", if rigid { "" } else { ", shape: linear" }][(seed % 3) as usize];
            let motion = [
                format!("{{quintic: {{from: {from}, to: {to}, begin: 0.2, duration: 1.5}}}}"),
                format!("{{cubic: {{from: {from}, to: {to}, duration: 2}}}}"),
                format!("{{cycloid: {{from: {from}, to: {to}, begin: 0.1, duration: 1.2}}}}"),
                format!("{{trapezoid: {{from: {from}, to: {to}, begin: 0.3, duration: 1.8, blend: 0.2}}}}"),
                format!("{{table: {{times: [0, 0.5, 1.2, 2], values: [0.1, {from}, -0.2, 0.4]{shape}}}}}"),
                format!("{{hold: {to}}}"),
                format!("{{speed: {{from: {from}, rate: {to}, begin: 0.4, ramp: 0.7}}}}"),
                format!("{{speed: {{rate: {to}{}}}}}", if rigid { "" } else { ", begin: 0.6" }),
            ][(first + k) % 8]
                .clone();
            let (stiffness, damping) = (self.positive(900.0), self.positive(30.0));
            // Every other drive has a rotor.
            let armature = self.positive(4.0);
            let rotor = if k % 2 == 0 { format!("armature: {armature}, ") } else { String::new() };
            // The second drive of every other crane has a limit that extreme states exceed.
            let limit = match (seed % 4, k) {
                (0, 1) => ", max_effort: 300, max_rate: 1.5, max_power: 120",
                (2, 1) => ", max_effort: 300",
                _ => "",
            };
            let spring = if rigid {
                "rigid: true".to_owned()
            } else {
                format!("stiffness: {stiffness}, damping: {damping}{limit}")
            };
            // Every third crane halts what moves, within the times at which its states are.
            let halt =
                if seed % 3 == 1 && !motion.starts_with("{hold") { ", halt: {at: 0.7, within: 0.6}" } else { "" };
            let offset = if seed % 4 == 2 && !rigid { ", offset: shift" } else { "" };
            self.line(&format!("  - {{coordinate: {coordinate}, {spring}, {rotor}motion: {motion}{halt}{offset}}}"));
        }
        if !passive.is_empty() {
            self.line("damping:");
            for (coordinate, _) in passive {
                let damping = self.positive(3.0);
                self.line(&format!("  {coordinate}: {damping}"));
            }
            let (coordinate, _) = &self.coordinates[5];
            let coordinate = coordinate.clone();
            let armature = self.positive(2.0);
            self.line(&format!("armature: {{{coordinate}: {armature}}}"));
        }
        if seed % 2 == 1 {
            self.joint_forces();
        }
    }

    /// Stops and friction of driven joints, including rigid drives, and of a passive one.
    fn joint_forces(&mut self) {
        let names: Vec<String> = self.coordinates.iter().map(|(name, _)| name.clone()).collect();
        let (Some(last), [_, second, third, ..]) = (names.last(), names.as_slice()) else { return };
        self.line("stops:");
        self.line(&format!("  {third}: {{min: -0.15, max: 0.2, stiffness: 2500, damping: 0.3}}"));
        self.line(&format!("  {last}: {{max: 0.1, stiffness: 700}}"));
        self.line("friction:");
        self.line(&format!("  {second}: {{coulomb: 6, breakaway: 9, stribeck: 0.6, width: 0.3, viscous: 1.5}}"));
        self.line(&format!("  {last}: {{coulomb: payload, width: 0.4}}"));
    }

    /// A spring across several joints, a gas spring across one, a rope from the world on a winch, a slack one, a rope over sheaves on three links
    /// with a winch and three falls, and one over a sheave in the world.
    pub(super) fn connectors(&mut self) {
        self.line("connectors:");
        for (name, from, to, law) in [
            (
                "tie",
                "{link: arm, at: [0.1, 1.5, 0.3]}",
                "{link: second, at: [0.3, 0.1, 0]}",
                "{spring: {stiffness: 300, damping: 8, length: 1.1}}",
            ),
            (
                "strut",
                "{link: hand, at: [0.2, 0.4, -0.7]}",
                "{link: plate, at: [0, 0.3, 0.9]}",
                "{gas_spring: {force: 40, length: 2, stiffness: 15, damping: 3}}",
            ),
            (
                "buffer",
                "{link: hand, at: [0.3, -0.2, 0.5]}",
                "{link: plate, at: [-0.4, 0.2, 0.6]}",
                "{progressive_spring: {stiffness: 12, progression: 7, length: 1.5, damping: 2}}",
            ),
            (
                "hoist",
                "{at: [1, 0.5, 9]}",
                "{link: second, at: [0.2, 0, 0]}",
                "{rope: {stiffness: 90, damping: 0.2, motion: {quintic: {from: 3, to: 2, begin: 0.1, duration: 1.5}}}}",
            ),
            (
                "slack",
                "{link: arm, at: [0, 0, 0.4]}",
                "{link: hand, at: [0, 0, 0]}",
                "{rope: {stiffness: 500, length: 90}}",
            ),
            (
                "reeving",
                "{link: second, at: [0.1, 0.2, -0.1]}, over: [{link: plate, at: [0.2, -0.3, 0.4]}, {link: arm, at: [0.2, 0.3, 0.5]}]",
                "{link: first, at: [0.5, 0, 0.2]}, falls: 3",
                "{rope: {axial_stiffness: 8, damping: 0.15, motion: {cubic: {from: 2, to: 1.4, begin: 0.2, duration: 1.1}}}}",
            ),
            (
                "mast",
                "{link: arm, at: [0.3, 0, 0.1]}, over: [{at: [-2, 1.5, 6]}, {link: plate, at: [0.1, 0.5, 0]}]",
                "{link: hand, at: [0, 0.3, 0.2]}",
                "{rope: {axial_stiffness: 10, damping: 0.1, length: 3}}",
            ),
        ] {
            self.line(&format!("  - {{name: {name}, from: {from}, to: {to}, law: {law}}}"));
        }
        if self.branches {
            let ends = "from: {link: claw, at: [0.2, 0.1, -0.3]}, to: {link: grip, at: [0.1, 0.4, 0]}";
            self.line(&format!(
                "  - {{name: cross, {ends}, law: {{spring: {{stiffness: 120, damping: 5, length: 1.3}}}}}}"
            ));
        }
    }

    /// A coordinate that follows another one on the other side of several joints, and one that follows its neighbour.
    pub(super) fn couplings(&mut self) {
        let names: Vec<String> = self.coordinates.iter().map(|(name, _)| name.clone()).collect();
        let ([first, second, ..], Some(last)) = (names.as_slice(), names.last()) else { return };
        self.line("couplings:");
        for (name, coordinate, follows) in [("gear", last, second), ("stage", first, second)] {
            let (ratio, offset) = (self.number(2.0), self.number(0.3));
            let law = format!("coordinate: {coordinate}, follows: {follows}, ratio: {ratio}, offset: {offset}");
            self.line(&format!("  - {{name: {name}, {law}, stiffness: 70, damping: 4}}"));
        }
    }

    /// A force of the world, a wrench that turns with its link and grows with time, and loads that follow inputs.
    pub(super) fn loads(&mut self) {
        self.line("inputs:");
        self.line("  pull: {motion: {cubic: {from: 1, to: 3, begin: 0.2, duration: 1}}, unit: N}");
        self.line("  shift: {value: 0.05, unit: rad}");
        self.line("loads:");
        self.line("  - {name: wind, link: first, at: [0.7, 0.1, 0], force: [3, -5, 2]}");
        if self.branches {
            self.line("  - {name: draught, link: claw, at: [0.2, 0.3, 0], force: [-1, 2, 3], axes: link}");
        }
        self.line("  - {name: steered, link: second, force: [0, 1, 2], scale: {input: pull}}");
        self.line("  - {name: trimmed, link: second, moment: [0, 30, 0], scale: {input: shift}}");
        self.line("  - name: push");
        self.line("    link: hand");
        self.line("    at: [0.1, 0.2, -0.1]");
        self.line("    force: [4, 1, payload]");
        self.line("    moment: [0.5, -0.7, 0.9]");
        self.line("    axes: link");
        self.line("    scale: {quintic: {from: 0.5, to: 1.5, begin: 0.1, duration: 2}}");
    }

    /// Cylinders of a joint that turns and of one that slides, which has its foot on the link that moves; and in every other crane one with
    /// a valve, which bends the beam that it turns.
    pub(super) fn cylinders(&mut self, seed: u64) {
        let [turns, slides] = [0, 2].map(|index: usize| self.coordinates[index].0.clone());
        let pins = [("foot", "arm"), ("slide", "plate")];
        self.line("cylinders:");
        for ((name, coordinate), (foot, head)) in [("turning", turns), ("sliding", slides)].into_iter().zip(pins) {
            let (at, to) = (self.vector(1.0), self.vector(1.0));
            self.line(&format!(
                "  - {{name: {name}, coordinate: {coordinate}, bore: 0.1, rod: 0.05, retracted: 1, stroke: 1,"
            ));
            self.line(&format!("     foot: {{link: {foot}, at: {at}}}, head: {{link: {head}, at: {to}}}}}"));
        }
        if seed % 8 != 7 {
            return;
        }
        let bends = self.coordinates[1].0.clone();
        let valve = "flow: 1.0e-3, pressure_drop: 1.0e6, lag: 0.03, gain: 4";
        let oil = "max_pressure: 2.0e7, bulk_modulus: 1.0e9, hose_volumes: [1.0e-3, 1.0e-3]";
        self.line(&format!("  - {{name: bending, coordinate: {bends}, bore: 0.1, rod: 0.05, retracted: 1, stroke: 1,"));
        // A shelf is on the arm, but not between the arm and the beam.
        let foot = if self.branches { "shelf" } else { "arm" };
        self.line(&format!(
            "     foot: {{link: {foot}, at: [0.4, -0.7, 0.5]}}, head: {{link: first, at: [1.1, 0.2, 0.3]}},"
        ));
        self.line(&format!("     {oil}, valve: {{{valve}}}}}"));
        self.line("pump: {max_flow: 1.0e-3, pressure: 1.5e7}");
    }
}
