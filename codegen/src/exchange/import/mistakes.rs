//! The rules for a file in URDF or MJCF that can be converted to a crane.

use crate::diagnostic::catalogue;

catalogue! {
    /// A file is XML.
    U001 not_xml(problem) "the file is not XML: {problem}", "reading stopped here", "check tags and quotes of this line";
    /// The root of the file is `<robot>` (URDF) or `<mujoco>` (MJCF), and macros are expanded.
    U002 not_a_robot(found) "the file does not describe a robot: found <{found}>", "an element of neither URDF nor MJCF",
        "give a URDF or MJCF file; convert a xacro file with `xacro robot.urdf.xacro > robot.urdf`";
    /// Links, bodies, joints and classes of defaults have what their language requires of them.
    U003 missing(owner, what) "{owner} lacks {what}", "{what} is missing here", "add {what}: URDF and MJCF require it";
    /// Numeric attributes have the right count of numbers.
    U004 wrong_numbers(subject, given, expected) "{subject} cannot be `{given}`", "not {expected}", "write {expected}, in SI units";
    /// Names of links, of joints and of classes of defaults are unique.
    U005 duplicate(kind, name) "two {kind}s are called `{name}`", "already used by another {kind}", "rename one of the two";
    /// Joints connect links that are in the file.
    U006 unknown_link(joint, name, help) "joint `{joint}` names link `{name}`, which is not in the file", "no such link", "{help}";
    /// A link is the child of one joint.
    U007 two_parents(link, other) "link `{link}` is the child of two joints", "also the child of joint `{other}`",
        "cut the loop at one of the two joints; a joint under `loop_joints:` of the spec then closes it";
    /// All links form one tree with one root.
    U008 not_a_tree(problem) "the links are not a tree: {problem}", "every link but the root is the child of one joint", "make every link but one the child of exactly one joint";
    /// Joints are of a kind that URDF or MJCF has.
    U009 unsupported(joint, kind) "joint `{joint}` has the unknown type `{kind}`",
        "URDF: revolute, continuous, prismatic, planar, floating, fixed; MJCF: hinge, slide, ball, free", "write one of these kinds";
    /// A joint follows a joint of the file.
    U010 unknown_leader(joint, leader, help) "joint `{joint}` follows joint `{leader}`, which is not in the file", "no such joint", "{help}";
    /// Something moves.
    U012 nothing_moves(help) "nothing in the robot can move", "no joint that rotates or slides", "{help}";
    /// A joint to be held is in the file.
    U013 unknown_joint(name, help) "there is no joint `{name}` to hold", "`--fix {name}`", "{help}";
    /// An axis has a direction.
    U014 no_direction(joint) "the axis of joint `{joint}` has no direction", "its length is zero", "write a direction, such as `0 0 1`";
    /// A mass is not negative.
    U015 negative_mass(link, given) "the mass of link `{link}` is {given} kg", "below zero", "write the mass of the link, in kg";
    /// A file in MJCF is complete: nothing in it is expanded or changed when MuJoCo loads it.
    U016 to_expand(what) "{what} is not read", "MuJoCo replaces this when it loads the file",
        "let MuJoCo write the complete file: `mujoco.mj_saveLastXML(\"complete.xml\", mujoco.MjModel.from_xml_path(\"robot.xml\"))`";
    /// Bodies have an inertial frame, or shapes whose masses are known.
    U017 unknown_mass(body, shape) "the mass of body `{body}` is not in the file", "only MuJoCo knows the mass of a {shape}",
        "add `<inertial>` to the body: `mujoco.mj_saveLastXML` writes it; or give the shape `mass=\"0\"`";
    /// Equalities hold joints or let them follow others.
    U018 closed_loop(found) "the equality {found} is not supported", "it closes a loop",
        "remove it, or write `active=\"false\"`; replace a cylinder with a drive of the joint that it moves";
    /// A joint follows another one in proportion.
    U019 not_linear(joint) "joint `{joint}` does not follow its leader in proportion", "powers of the leader's position are not supported",
        "write `polycoef` with two numbers other than 0: offset and ratio";
    /// An equality or a tendon names a joint that is in the file.
    U020 equality(joint, help) "an equality or a tendon names joint `{joint}`, which is not in the file", "no such joint", "{help}";
    /// Classes of defaults are in the file.
    U021 unknown_class(class, help) "there is no class `{class}` of defaults", "no <default> of this name", "{help}";
    /// An orientation is written in one way.
    U022 two_orientations(owner, both) "{owner} has {both}", "two orientations", "keep one of them";
    /// An orientation has directions of nonzero length that are not parallel.
    U023 no_orientation(owner, key) "`{key}` of {owner} gives no orientation", "a direction has no length, or two are parallel", "write other numbers";
    /// A joint follows another one.
    U024 own_leader(joint) "joint `{joint}` follows itself", "directly, or over joints that follow it", "name another joint, or remove `mimic` or the equality";
    /// A joint is held or follows another one in one way.
    U025 second_equality(joint) "two equalities hold joint `{joint}`", "it already follows another joint, or is held", "remove one of them, or let the other joint follow this one";
    /// Joints with several axes have neither springs nor dampers, friction or rotors of their own.
    U026 not_plain(joint, kind) "joint `{joint}` is {kind} and has a spring, a damper, friction or a rotor", "of a joint with several axes these are not supported",
        "set `stiffness`, `damping`, `frictionloss` and `armature` of this joint to 0, or hold it with `--fix {joint}`";
}
