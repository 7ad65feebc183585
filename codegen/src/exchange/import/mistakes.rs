//! What a URDF file may not be, for a crane to be made of it.

use crate::diagnostic::catalogue;

catalogue! {
    /// A file is XML.
    U001 not_xml(problem) "the file is not XML: {problem}", "the reader stopped here", "check tags and quotes of this line";
    /// The root of the file is `<robot>`, and macros are expanded.
    U002 not_a_robot(found) "the file describes no robot: here is <{found}>", "not an element of URDF",
        "give a URDF file; a xacro file becomes one by `xacro robot.urdf.xacro > robot.urdf`";
    /// Links and joints have what URDF requires of them.
    U003 missing(owner, what) "{owner} lacks {what}", "{what} is missing here", "add {what}, as URDF requires";
    /// Attributes that are numbers hold as many as they should.
    U004 wrong_numbers(place, given, expected) "{place} cannot be `{given}`", "not {expected}", "write {expected}, in SI units";
    /// Names of links and of joints are unique.
    U005 duplicate(kind, name) "two {kind}s are called `{name}`", "taken by another {kind}", "rename one of the two";
    /// Joints connect links of the file.
    U006 unknown_link(joint, name, help) "joint `{joint}` names link `{name}`, which is not in the file", "no such link", "{help}";
    /// A link hangs on one joint.
    U007 two_parents(link, other) "link `{link}` hangs on two joints", "and on joint `{other}`",
        "a crane is an open chain: cut the loop at one of the two joints";
    /// All links hang together, on one that hangs on none.
    U008 not_a_tree(problem) "the links are not a tree: {problem}", "all links but one hang on a joint, in the end on that one", "let every link but one be the child of one joint";
    /// Joints turn about an axis, slide along it, or stand still.
    U009 unsupported(joint, kind) "joint `{joint}` is {kind}, which no joint of a crane is", "revolute, continuous, prismatic or fixed",
        "hold it at zero by `--fix {joint}`, or describe it by joints of one axis each; a base that is free is `joint: free` in the spec";
    /// A joint does not follow another one.
    U010 mimic(joint, leader) "joint `{joint}` follows joint `{leader}`", "each coordinate of a crane moves by itself",
        "hold it at zero by `--fix {joint}`";
    /// Moving joints follow each other in a chain.
    U011 branches(link, first, second) "the chain branches after link `{link}`: joints `{first}` and `{second}` both move on it", "the second branch",
        "hold one of them, and what moves on it, at zero: `--fix {second}`, or `--fix {first}`";
    /// Something moves.
    U012 nothing_moves() "nothing in the robot can move", "no revolute, continuous or prismatic joint", "leave a joint out of `--fix`";
    /// A joint that is to be held is in the file.
    U013 unknown_joint(name, help) "there is no joint `{name}` to hold", "`--fix {name}`", "{help}";
    /// An axis has a direction.
    U014 no_direction(joint) "the axis of joint `{joint}` has no direction", "its length is zero", "write a direction, such as `0 0 1`";
    /// A mass is not below zero.
    U015 negative_mass(link, given) "the mass of link `{link}` is {given} kg", "below zero", "write the mass of the link, in kg";
}
