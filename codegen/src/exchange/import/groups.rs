//! A robot as a tree: groups of links that move together, each on a joint.

use std::collections::{BTreeMap, BTreeSet};

use super::mistakes::rule;
use super::robot::{Follows, Joint, Link, Motion, Robot};
use crate::chain::Frame;
use crate::diagnostic::{Mistake, Span, suggest};

/// Links that move together.
pub(super) struct Group<'r> {
    /// The index of the group that carries it; `None` for the fixed group.
    pub(super) carrier: Option<usize>,
    /// The joint that moves it, and the pose of its frame at zero in that of the group that carries it; `None` for the fixed group.
    pub(super) joint: Option<(&'r Joint, Frame)>,
    /// Its links, each in the frame of the first.
    pub(super) links: Vec<(&'r Link, Frame)>,
    /// Joints in it that are held on request, or follow one that is, and where, m or rad.
    pub(super) held: Vec<(&'r Joint, f64)>,
}

/// The groups of a robot with some of its joints held, `fixed` on request, each followed by all beyond it; the first group is fixed.
pub(super) fn groups<'r>(robot: &'r Robot, fixed: &[String], held: &Held<'r>) -> Result<Vec<Group<'r>>, Vec<Mistake>> {
    let mut mistakes = Vec::new();
    names(robot, fixed, &mut mistakes);
    let root = root(robot, &mut mistakes);
    let (Some(root), true) = (root, mistakes.is_empty()) else { return Err(mistakes) };

    let mut children: BTreeMap<&str, Vec<&Joint>> = BTreeMap::new();
    for joint in &robot.joints {
        children.entry(&joint.parent.name).or_default().push(joint);
    }
    let links: BTreeMap<&str, &Link> = robot.links.iter().map(|link| (link.name.as_str(), link)).collect();
    let link = |name: &str| links.get(name).copied();
    let mut groups = Vec::new();
    let by_name = by_name(robot);
    let mut next = vec![(None, None, root)];
    while let Some((carrier, joint, first)) = next.pop() {
        let mut group = Group { carrier, joint, links: Vec::new(), held: Vec::new() };
        let mut moving: Vec<(&Joint, Frame)> = Vec::new();
        let mut open = vec![(first, Frame::WORLD)];
        while let Some((member, frame)) = open.pop() {
            group.links.push((member, frame));
            for joint in children.get(member.name.as_str()).into_iter().flatten().rev() {
                let placed = frame.outer(&joint.placement);
                if let Some(position) = standing(&by_name, held, joint) {
                    let moved = placed.outer(&joint.moved_by(position));
                    open.extend(link(&joint.child.name).map(|link| (link, moved)));
                    group.held.extend((!matches!(joint.motion, Motion::Fixed)).then_some((*joint, position)));
                } else {
                    cannot_move(joint, &mut mistakes);
                    moving.push((joint, placed));
                }
            }
        }
        // In the order of the file; the first one continues before the others.
        moving.sort_by_key(|(joint, _)| std::cmp::Reverse(joint.span.start));
        let on_it = |(joint, frame): (&'r Joint, Frame)| {
            Some((Some(groups.len()), Some((joint, frame)), link(&joint.child.name)?))
        };
        next.extend(moving.into_iter().filter_map(on_it));
        groups.push(group);
    }
    if groups.len() == 1 && mistakes.is_empty() {
        let can_move = robot.joints.iter().any(|joint| !matches!(joint.motion, Motion::Fixed));
        let help =
            if can_move { "leave a joint out of `--fix`" } else { "give a joint the type `revolute` or `prismatic`" };
        mistakes.push(rule::nothing_moves(Span::START, help));
    }
    if mistakes.is_empty() { Ok(groups) } else { Err(mistakes) }
}

/// Checks that names are unique and known.
fn names(robot: &Robot, fixed: &[String], mistakes: &mut Vec<Mistake>) {
    let mut links = BTreeSet::new();
    for link in &robot.links {
        if !links.insert(link.name.as_str()) {
            mistakes.push(rule::duplicate(link.span, "link", &link.name));
        }
    }
    let mut joints = BTreeSet::new();
    let mut hangs: BTreeMap<&str, &str> = BTreeMap::new();
    for joint in &robot.joints {
        if !joints.insert(joint.name.as_str()) {
            mistakes.push(rule::duplicate(joint.span, "joint", &joint.name));
        }
        for end in [&joint.parent, &joint.child] {
            if !links.contains(end.name.as_str()) {
                let help = suggest(&end.name, links.iter().copied());
                mistakes.push(rule::unknown_link(end.span, &joint.name, &end.name, help));
            }
        }
        if let Some(other) = hangs.insert(&joint.child.name, &joint.name) {
            mistakes.push(rule::two_parents(joint.child.span, &joint.child.name, other));
        }
    }
    for name in fixed.iter().filter(|name| !joints.contains(name.as_str())) {
        mistakes.push(rule::unknown_joint(Span::START, name, suggest(name, joints.iter().copied())));
    }
    let by_name = by_name(robot);
    let circular = circular(robot, &by_name);
    for joint in &robot.joints {
        let Some(Follows { leader, .. }) = &joint.follows else { continue };
        if !joints.contains(leader.name.as_str()) {
            let others = joints.iter().copied().filter(|name| *name != joint.name);
            mistakes.push(rule::unknown_leader(leader.span, &joint.name, &leader.name, suggest(&leader.name, others)));
        } else if circular.contains(joint.name.as_str()) {
            mistakes.push(rule::own_leader(leader.span, &joint.name));
        }
    }
}

/// Joints by name; of several with one name, the first.
type ByName<'r> = BTreeMap<&'r str, &'r Joint>;

fn by_name(robot: &Robot) -> ByName<'_> {
    robot.joints.iter().rev().map(|joint| (joint.name.as_str(), joint)).collect()
}

/// The joint that a joint follows.
fn leader<'r>(by_name: &ByName<'r>, joint: &Joint) -> Option<&'r Joint> {
    by_name.get(joint.follows.as_ref()?.leader.name.as_str()).copied()
}

/// The names of joints that follow themselves, directly or over others. Each joint is visited once, since what follows a joint that was
/// visited from an earlier start adds no circle.
fn circular<'r>(robot: &'r Robot, by_name: &ByName<'r>) -> BTreeSet<&'r str> {
    let mut visited: BTreeMap<&str, usize> = BTreeMap::new();
    let mut circular = BTreeSet::new();
    for (start, joint) in robot.joints.iter().enumerate() {
        let mut next = Some(joint);
        let mut way: Vec<&str> = Vec::new();
        while let Some(joint) = next {
            let name = joint.name.as_str();
            if let Some(from) = visited.get(name) {
                let entered = way.iter().position(|passed| *passed == name).filter(|_| *from == start);
                circular.extend(entered.into_iter().flat_map(|entered| &way[entered..]).copied());
                break;
            }
            visited.insert(name, start);
            way.push(name);
            next = leader(by_name, joint);
        }
    }
    circular
}

/// Positions of joints that are held, by name, m or rad.
pub(super) type Held<'r> = BTreeMap<&'r str, f64>;

/// Where joints are that are held on request: where the file holds them, else at zero. The joint that one of them follows is held where that puts it,
/// unless it is to be held itself, or its position does not matter.
pub(super) fn held<'r>(robot: &'r Robot, fixed: &[String]) -> Held<'r> {
    let by_name = by_name(robot);
    let asked = |joint: &&Joint| fixed.contains(&joint.name) && !matches!(joint.motion, Motion::Fixed);
    let mut held: Held =
        robot.joints.iter().filter(asked).map(|joint| (&*joint.name, joint.held.unwrap_or(0.0))).collect();
    for start in robot.joints.iter().filter(asked) {
        let mut joint = start;
        // It ends at the latest after all joints, also if they follow each other in a circle, which is a mistake.
        for _ in &robot.joints {
            let (Some(follows), Some(leader)) = (&joint.follows, leader(&by_name, joint)) else { break };
            let movable = follows.multiplier != 0.0 && !matches!(leader.motion, Motion::Fixed);
            if !movable || held.contains_key(&*leader.name) {
                break;
            }
            held.insert(&leader.name, (held[&*joint.name] - follows.offset) / follows.multiplier);
            joint = leader;
        }
    }
    held
}

/// Where a joint stands that does not move, m or rad: at zero if it is fixed, where it is held, or where it follows one that does not move.
fn standing(by_name: &ByName, held: &Held, joint: &Joint) -> Option<f64> {
    let on_its_own = |joint: &Joint| match joint.motion {
        Motion::Fixed => Some(0.0),
        _ => held.get(&*joint.name).copied(),
    };
    if matches!(joint.motion, Motion::Fixed) {
        return Some(0.0);
    }
    // It ends, because no joint follows itself.
    let chain: Vec<&Joint> = std::iter::successors(Some(joint), |joint| leader(by_name, joint)).collect();
    // The furthest leader that stands holds all between it and the joint.
    let last = chain.iter().rposition(|joint| on_its_own(joint).is_some())?;
    let followers = chain[..last].iter().rev().filter_map(|joint| joint.follows.as_ref());
    Some(
        followers.fold(on_its_own(chain[last])?, |position, Follows { multiplier, offset, .. }| {
            multiplier * position + offset
        }),
    )
}

/// The root link, if all others are connected to it.
fn root<'r>(robot: &'r Robot, mistakes: &mut Vec<Mistake>) -> Option<&'r Link> {
    let children: BTreeSet<&str> = robot.joints.iter().map(|joint| joint.child.name.as_str()).collect();
    let roots: Vec<&Link> = robot.links.iter().filter(|link| !children.contains(link.name.as_str())).collect();
    let problem = match roots.as_slice() {
        [root] => match unreachable(robot, root) {
            None => return Some(root),
            Some(link) => (link.span, format!("`{}` is not connected to `{}`", link.name, root.name)),
        },
        [] => (Span::START, if robot.links.is_empty() { "there are none" } else { "they form a closed loop" }.into()),
        [first, other, ..] => (other.span, format!("neither `{}` nor `{}` has a parent", first.name, other.name)),
    };
    // A wrong name disconnects the tree, but has already been reported.
    if mistakes.is_empty() {
        mistakes.push(rule::not_a_tree(problem.0, problem.1));
    }
    None
}

/// A link that is not connected to the root: part of a closed loop.
fn unreachable<'r>(robot: &'r Robot, root: &'r Link) -> Option<&'r Link> {
    let mut children: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for joint in &robot.joints {
        children.entry(&joint.parent.name).or_default().push(&joint.child.name);
    }
    let mut reached = BTreeSet::new();
    let mut open = vec![root.name.as_str()];
    while let Some(link) = open.pop() {
        if reached.insert(link) {
            open.extend(children.get(link).into_iter().flatten());
        }
    }
    robot.links.iter().find(|link| !reached.contains(link.name.as_str()))
}

/// Reports a joint with a motion that cranes do not support.
fn cannot_move(joint: &Joint, mistakes: &mut Vec<Mistake>) {
    if let Motion::Other(kind) = &joint.motion {
        mistakes.push(rule::unsupported(kind.span, &joint.name, &kind.name));
    }
}
