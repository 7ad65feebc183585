//! Equalities and fixed tendons: linear equations `Σ a (q − ref) = c` and springs between joints.

use super::File;
use crate::diagnostic::{Span, suggest};
use crate::exchange::import::document::Element;
use crate::exchange::import::mistakes::rule;
use crate::exchange::import::robot::{Coupling, Follows, Joint, Named, Spring};

/// A fixed tendon: its length is the sum of positions of joints with coefficients.
pub(super) struct FixedTendon {
    name: String,
    /// Joints by their index, each once.
    terms: Vec<(usize, f64)>,
}

/// Combines terms of one joint.
fn collected(terms: impl IntoIterator<Item = (usize, f64)>) -> Vec<(usize, f64)> {
    let mut sum: Vec<(usize, f64)> = Vec::new();
    for (joint, share) in terms {
        match sum.iter_mut().find(|(other, _)| *other == joint) {
            Some((_, total)) => *total += share,
            None => sum.push((joint, share)),
        }
    }
    sum.retain(|(_, share)| *share != 0.0);
    sum
}

impl<'a, 'i> File<'a, 'i> {
    /// The fixed tendons; those with springs act on joints. Others are left out.
    pub(super) fn tendons(&mut self, root: Element<'a, 'i>) -> Vec<FixedTendon> {
        let mut tendons = Vec::new();
        let equalities = || root.elements().filter(|section| section.is("equality")).flat_map(Element::elements);
        for node in root.named("tendon").flat_map(Element::elements) {
            if node.is("fixed") {
                let held = |name: &str| equalities().flat_map(Element::values).any(|value| value == name);
                let acts = |key: &str| self.classes.text(node, None, key).is_some_and(|text| text.parse() != Ok(0.0));
                if acts("stiffness") || acts("damping") || node.text("name").is_some_and(held) {
                    let _ = node.read();
                } else {
                    node.leave_out("tendons that exert no force");
                }
                tendons.extend(self.fixed_tendon(node));
            } else {
                node.leave_out("tendons over sites");
            }
        }
        tendons
    }

    fn fixed_tendon(&mut self, node: Element<'a, 'i>) -> Option<FixedTendon> {
        let name = node.text("name").unwrap_or("tendon").to_owned();
        let owner = format!("tendon `{name}`");
        let mut terms = Vec::new();
        for wrapped in node.named("joint") {
            let joint = self.reader.required(wrapped, "joint", &format!("<joint> of {owner}"))?;
            let [share] = self.reader.numbers(wrapped, "coef", &owner)?;
            terms.push((self.index_of(&joint)?, share));
        }
        let tendon = FixedTendon { name, terms: collected(terms) };
        let mut number = |key| self.number(node, None, key, &owner).unwrap_or(0.0);
        let [stiffness, damping] = ["stiffness", "damping"].map(&mut number);
        let rest = self.classes.find(node, None, "springlength");
        let rest =
            rest.and_then(|attribute| self.reader.some_numbers(attribute, &format!("`springlength` of {owner}")));
        let lost = ["frictionloss", "armature"]
            .into_iter()
            .filter(|key| self.classes.text(node, None, key).is_some_and(|text| text.parse() != Ok(0.0)));
        let lost: Vec<String> = lost.map(|key| format!("`{key}`")).collect();
        if !lost.is_empty() {
            self.robot.left_out.push(format!("Left out of {owner}: {}.", lost.join(" and ")));
        }
        node.leave_out_rest("limits and looks of tendons");
        if stiffness != 0.0 || damping != 0.0 {
            self.spring(&tendon, [stiffness, damping], rest.as_deref().unwrap_or_default());
        }
        Some(tendon)
    }

    /// A spring and a damper along a tendon: `−k (L − L₀) − d L̇`. Without a rest length, or where it is −1, L₀ is that where all joints
    /// are relaxed.
    fn spring(&mut self, tendon: &FixedTendon, [stiffness, damping]: [f64; 2], rest: &[f64]) {
        let relaxed = || tendon.terms.iter().map(|(joint, share)| share * self.robot.joints[*joint].relaxed).sum();
        let rest = match rest {
            [] | [-1.0] | [-1.0, -1.0] => Some(relaxed()),
            [one] => Some(*one),
            [low, high] if low == high => Some(*low),
            _ => None,
        };
        match (tendon.terms.as_slice(), rest) {
            (&[(joint, share)], Some(rest)) if self.robot.joints[joint].oscillation.is_none() => {
                let joint = &mut self.robot.joints[joint];
                joint.damping += damping * share * share;
                let (own, at) = joint.spring.as_ref().map_or((0.0, 0.0), |spring| (spring.stiffness, spring.rest));
                // Two springs side by side.
                let [added, sum] = [stiffness * share * share, own + stiffness * share * share];
                let both = Spring { stiffness: sum, rest: (own * at + added * rest / share) / sum };
                joint.spring = (sum != 0.0).then_some(both);
            }
            (&[(follower, one), (leader, other)], Some(rest)) => {
                let name_of = |joint: usize| self.robot.joints[joint].name.clone();
                self.robot.couplings.push(Coupling {
                    name: tendon.name.clone(),
                    follower: name_of(follower),
                    leader: name_of(leader),
                    ratio: -other / one,
                    offset: rest / one,
                    stiffness: stiffness * one * one,
                    damping: damping * one * one,
                });
            }
            _ => {
                let why = match (rest, tendon.terms.len()) {
                    (None, _) => "it is slack over a range",
                    (_, 0) => "it acts on no joint",
                    (_, 1) => "the inertia determines another spring of its joint",
                    _ => "it acts on more than two joints",
                };
                self.robot.left_out.push(format!("The spring of tendon `{}` is left out: {why}.", tendon.name));
            }
        }
    }

    /// The joint of an equality or a tendon; `None` with a mistake if it is not in the file.
    fn index_of(&mut self, joint: &Named) -> Option<usize> {
        let found = self.robot.joints.iter().position(|other| other.name == joint.name);
        if found.is_none() {
            let help = suggest(&joint.name, self.robot.joints.iter().map(|joint| joint.name.as_str()));
            self.reader.mistakes.push(rule::equality(joint.span, &joint.name, help));
        }
        found
    }

    /// Reads an equality that holds a joint or a fixed tendon, or lets one follow another; no other kind is supported.
    pub(super) fn equality(&mut self, node: Element<'a, 'i>, tendons: &[FixedTendon]) {
        if self.classes.text(node, None, "active") == Some("false") {
            return node.leave_out("equalities that are not active");
        }
        let kind = node.read().name();
        if !["joint", "tendon"].contains(&kind) {
            return self.reader.mistakes.push(rule::closed_loop(node.tag(), format!("<{kind}>")));
        }
        let owner = format!("<{kind}> of <equality>");
        let Some(follower) = self.reader.required(node, &format!("{kind}1"), &owner) else { return };
        let leader_key = format!("{kind}2");
        let leader = if node.has(&leader_key) { self.reader.required(node, &leader_key, &owner) } else { None };
        let power = |exponent: usize| if exponent == 1 { 1.0 } else { 0.0 };
        let given = self.classes.find(node, None, "polycoef");
        let given = given.and_then(|attribute| self.reader.some_numbers(attribute, "`polycoef`")).unwrap_or_default();
        let [zeroth, first, higher @ ..] =
            [0, 1, 2, 3, 4].map(|exponent| given.get(exponent).copied().unwrap_or_else(|| power(exponent)));
        if leader.is_some() && higher != [0.0; 3] {
            return self.reader.mistakes.push(rule::not_linear(node.tag(), &follower.name));
        }
        node.leave_out_rest("softness of equalities");
        let mut terms_of = |named: &Named| {
            if kind == "joint" {
                return Some(vec![(self.index_of(named)?, 1.0)]);
            }
            let found = tendons.iter().find(|tendon| tendon.name == named.name);
            if found.is_none() {
                self.reader.mistakes.push(rule::closed_loop(named.span, format!("of tendon `{}`", named.name)));
            }
            found.map(|tendon| tendon.terms.clone())
        };
        // L₁ − c₁ L₂ = c₀, each L from that at `ref`.
        let Some(own) = terms_of(&follower) else { return };
        let Some(other) = leader.as_ref().map_or(Some(Vec::new()), terms_of) else { return };
        let terms = collected(own.into_iter().chain(other.into_iter().map(|(joint, share)| (joint, -first * share))));
        self.hold(follower.span, &follower.name, &terms, zeroth);
    }

    /// Holds the equation `Σ a (q − ref) = c`: of two joints the first follows the second, unless only the second is free.
    fn hold(&mut self, span: Span, name: &str, terms: &[(usize, f64)], sum: f64) {
        let joints = &mut self.robot.joints;
        let taken = |joint: &Joint| joint.follows.is_some() || joint.held.is_some();
        match *terms {
            [(joint, share)] if !taken(&joints[joint]) => {
                joints[joint].held = Some(joints[joint].reference + sum / share);
            }
            [one, other] => {
                let free = [one, other].into_iter().find(|(joint, _)| !taken(&joints[*joint]));
                let Some((follower, share)) = free else {
                    return self.reader.mistakes.push(rule::second_equality(span, name));
                };
                let (leader, of_leader) = if follower == one.0 { other } else { one };
                let multiplier = -of_leader / share;
                let offset = joints[follower].reference + sum / share - multiplier * joints[leader].reference;
                let leader = Named { name: joints[leader].name.clone(), span };
                joints[follower].follows = Some(Follows { leader, multiplier, offset });
            }
            [_] => self.reader.mistakes.push(rule::second_equality(span, name)),
            _ => {
                let what = format!("of {} joints", terms.len());
                self.reader.mistakes.push(rule::closed_loop(span, what));
            }
        }
    }
}
