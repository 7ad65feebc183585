//! The rules of the spec language: each has a code, a title, a label and a remedy. Codes with E are mistakes, those with W warnings.

use super::definition::catalogue;

catalogue! {
    // The file.
    /// A file has at most 4 MiB.
    E001 too_large(size, limit) "the file is too large for a crane: {size} bytes", "a spec is at most {limit} bytes",
        "check that this is the right file; a typical spec has a few thousand bytes";
    /// A file is UTF-8 text.
    E002 not_utf8(at) "the file is not text", "byte {at} is not UTF-8", "save the file as UTF-8 text";
    /// A file is not empty.
    E003 empty() "the file is empty", "expected a crane here",
        "start with `format: 1`, `name:` and `links:`; `crane example` prints commented ones";
    /// A file is one YAML document.
    E004 not_yaml(problem, help) "the file is not YAML: {problem}", "reading stopped here", "{help}";
    /// The top level is a mapping of keys to values.
    E005 not_a_mapping(found) "the file does not describe a crane: its top level is {found}", "expected keys here",
        "write `key: value` lines, starting with `format: 1`";
    /// `format` names a version of the language that this compiler reads.
    E006 wrong_format(given) "format {given} is not supported", "this compiler reads format 1", "write `format: 1`";
    /// A file has at most 131072 values; values that an alias repeats count each time.
    E007 too_many_values(most) "the file has more than {most} values", "the limit is exceeded here",
        "an alias (`*name`) repeats everything its anchor contains: write out only what differs, and give beams `sections` instead of `elements`";
    /// `extends` names a spec that can be read: a file, relative to this one, or a shipped crane.
    E008 no_base(base, problem) "`extends: {base}` cannot be read: {problem}", "the spec to start from",
        "give a YAML file, relative to this one, or a shipped crane such as eight_link_flexible";
    /// An extending spec removes only existing entries.
    E009 nothing_to_remove(name, help) "there is no `{name}` to remove", "the extended spec does not have it", "{help}";

    // Keys and shapes.
    /// Every key belongs to the language.
    E010 unknown_key(key, help) "unknown key `{key}`", "not a key here", "{help}";
    /// A key occurs once in its mapping.
    E011 duplicate_key(key) "key `{key}` is given twice", "already given above", "keep one of the two";
    /// Keys without a default are given.
    E012 missing_key(key, subject) "{subject} lacks `{key}`", "`{key}` is missing here", "add `{key}:`; docs/SPEC.md gives its meaning and unit";
    /// A value has the form that its key requires.
    E013 wrong_value(subject, found, kind, expected) "{subject} cannot be {found}", "this is {kind}", "write {expected}";
    /// A choice is one of those available.
    E014 unknown_choice(subject, given, help) "{subject} cannot be `{given}`", "not one of the choices", "{help}";
    /// Of several alternatives, exactly one is given.
    E015 not_one_choice(subject, count, choices) "{subject} needs exactly one choice, but {count} are given", "one of {choices}",
        "write exactly one of {choices}";
    /// A list has as many items as its key requires.
    E016 wrong_length(subject, expected, found, help) "{subject} has {found} items instead of {expected}",
        "expected {expected} items", "{help}";
    /// Text is one line without control characters.
    E017 not_one_line(subject) "{subject} is not one line of plain text", "contains a line break or a character that cannot be printed",
        "write it on one line; `>-` folds a long text into one";
    /// An entry that changes one of the extended spec has the name of that entry.
    E018 misspelt_entry(name, known) "the extended spec has no `{name}`", "so this is a new entry, which is incomplete",
        "did you mean `{known}`? A new entry needs all keys without a default";
    /// An entry of an extending spec comes after an existing one.
    E019 nothing_before(name, help) "there is no `{name}` to come after", "no entry of this list", "{help}";

    // Names.
    /// Names are `snake_case` identifiers of at most 64 characters: they become names in Rust.
    E020 not_an_identifier(name, why) "`{name}` is not a valid name", "{why}",
        "use up to 64 lower-case letters, digits and `_`, starting with a letter, such as `outer_boom`";
    /// Names are not `crate`, `self` or `super`; a crane's name is not a keyword of Rust, nor that of a crate that its program uses.
    E021 keyword(name, why) "`{name}` is not a valid name", "{why}", "choose another word, such as `{name}_1`";
    /// Names are unique within their kind, including those of rigid elements and coordinates.
    E022 duplicate_name(kinds, name, other) "two {kinds} are called `{name}`", "already used by {other}", "rename one of the two";
    /// A parameter that is referred to exists.
    E023 unknown_parameter(name, help) "there is no parameter `{name}`", "neither a number nor a parameter", "{help}";
    /// A material that is referred to exists.
    E024 unknown_material(name, help) "there is no material `{name}`", "not listed under `materials:`", "{help}";
    /// A link that is referred to exists.
    E025 unknown_link(name, help) "there is no link `{name}`", "not listed under `links:`", "{help}";
    /// A coordinate that is referred to exists.
    E026 unknown_coordinate(name, help) "there is no coordinate `{name}`", "no joint has this coordinate", "{help}";
    /// A parameter is used somewhere.
    E027 unused_parameter(name) "parameter `{name}` is never used", "nothing refers to it",
        "use `{name}` in place of a number, or remove it";
    /// No two columns of results and no two variables of a unit for co-simulation have the same name: `<point>_x`, `<coordinate>_rate`, parameters.
    E028 shared_column(one, other, column) "{one} and {other} would share a name", "in results, both are called `{column}`",
        "choose another name for one of the two";
    /// Every entry of a list begins with `-`.
    E029 missing_dash(key, list) "a `-` is missing before `{key}`", "a new entry of `{list}` begins here",
        "write `- {key}:`, with the `-` below those of the other entries; or remove the second `{key}`";

    // Numbers.
    /// Numbers are finite.
    E030 not_finite(subject, given) "{subject} is {given}", "not a finite number", "write a finite number, in SI units";
    /// Masses, lengths, sections, moduli and durations are above zero.
    E031 not_positive(subject, given, of_unit, in_unit) "{subject} must be above zero, not {given}", "{given}{of_unit}",
        "write a number above 0{in_unit}";
    /// Stiffness, damping and other numbers that may be zero are not negative.
    E032 negative(subject, given, of_unit, in_unit) "{subject} must not be negative, but is {given}", "{given}{of_unit}",
        "write 0 or a positive number{in_unit}";
    /// Numbers are 0 or have a magnitude from 1e-30 to 1e18.
    E033 out_of_range(subject, given) "{subject} is outside the allowed range: {given}", "allowed: 0, or a magnitude from 1e-30 to 1e18",
        "check the exponent; every number is in SI units";
    /// A number with a unit has the dimension of its key.
    E034 wrong_dimension(subject, problem, help) "{subject} {problem}", "another dimension", "{help}";
    /// Units are those of the table.
    E035 unknown_unit(subject, written, symbol, help) "{subject} cannot be `{written}`: there is no unit `{symbol}`", "not a unit", "{help}";
    /// Parameters and inputs are in SI units, unless their unit is a word of its own.
    E036 not_si(subject, unit, si) "{subject} is in {unit}, which is not an SI unit", "values are kept in SI units",
        "write `unit: {si}`, and the value in {si} or with its unit";

    // Links.
    /// A crane has at least one link.
    E040 no_links() "the crane has no links", "empty", "add a link: `- {{name: boom, joint: revolute, ...}}`";
    /// Only the base is free.
    E041 free_inside(link) "link `{link}` is free, but attached to another link", "only the first link may be free",
        "use `fixed`, `revolute` or `prismatic`";
    /// A free base has at least one coordinate, each once.
    E042 base_coordinates(link, problem) "the coordinates of base `{link}` are {problem}", "{problem}",
        "list some of x, y, z, psi, theta, phi, each once; or write `free` for all six, `fixed` for none";
    /// The joint of a D-H row rotates about z or slides along it.
    E043 dh_axis(link) "the joint of link `{link}` is not about z", "the joint axis of a D-H row is z",
        "leave `axis` out, or place the link by `transform`";
    /// Mass, bodies, beam and rope exclude one another.
    E044 two_masses(link, first, second) "link `{link}` has both `{first}` and `{second}`", "`{first}` is given too",
        "give only one of `mass`, `bodies`, `beam` and `rope`";
    /// A centre of mass and an inertia require a mass.
    E045 without_mass(link, key) "link `{link}` has `{key}` but no mass", "`{key}` requires `mass`", "add `mass:`, or remove `{key}`";
    /// Every joint moves a mass of its own; otherwise the mass matrix is singular.
    E046 moves_nothing(coordinate) "coordinate `{coordinate}` moves no mass of its own", "the mass matrix is singular",
        "give the links after this joint mass and inertia, or fix the joint";
    /// A crane has at most 3000 coordinates.
    E047 too_many(what, count, most, help) "with {what} the crane has {count} coordinates", "the limit is {most}", "{help}";
    /// A crane has a joint that moves, or a beam with sections.
    E048 nothing_moves() "nothing in the crane can move", "no link has a joint that moves or a beam with sections",
        "write `joint: revolute`, `prismatic` or, in the first link, `free`; or give a beam `sections`";
    /// The elements of a beam are not too light for what the beam carries; otherwise the mass matrix is numerically singular.
    E049 too_light(link, mass) "beam `{link}` is too light for what it carries", "{mass} kg; the mass matrix is numerically singular",
        "check `density` and the section, in kg/m³ and m; or write `sections: rigid`";

    // Inertias.
    /// No principal moment of what moves together is below zero.
    E050 not_positive_definite(subject, smallest, help) "{subject} has a principal moment below zero",
        "smallest principal moment about the centre of mass: {smallest} kg m²", "{help}";
    /// Principal moments of what moves together satisfy the triangle inequality: none exceeds the sum of the other two by more than 25 %.
    E051 triangle(subject, largest, others, help) "{subject} is not possible for a rigid body", "{largest} kg m² exceeds {others} kg m², the sum of the other two principal moments",
        "{help}";
    /// An inertia is given by its tensor or by radii of gyration.
    E052 two_inertias(subject) "{subject} is given in two ways", "`gyration` is given too",
        "give `gyration` alone, or `Ixx`, `Iyy`, `Izz`";

    // Ropes.
    /// A rope has 1 to 1000 links.
    E053 rope_links(given) "a rope cannot have {given} links", "expected an integer from 1 to 1000",
        "write an integer; 3 to 10 links are typical";

    // Beams.
    /// A beam has 1 to 1000 sections, or is rigid.
    E060 sections(given) "a beam cannot have {given} sections", "expected an integer from 1 to 1000, or `rigid`",
        "write an integer such as 4, or `rigid`";
    /// A beam is given by sections or by elements.
    E061 two_beams(key) "the beam is given in two ways: `{key}` and `elements`", "for a beam that is divided into sections",
        "give either `sections`, `material` and `section`, or `elements` and `springs`";
    /// Between n + 1 elements there are n springs, at least one.
    E062 springs(elements, springs) "{elements} elements cannot have {springs} springs", "expected one spring between neighbouring elements",
        "give one spring fewer than elements, and at least one";
    /// Walls fit into their section.
    E063 wall(thickness, size) "the wall of the section is too thick", "two walls of {thickness} m do not fit into {size} m",
        "make the wall thinner than half of that side, in m, or use `solid` or `circle`";
    /// The elements of a beam add up to its length.
    E064 beam_length(sum, length) "the elements do not add up to the beam", "{sum} m in all, the beam is {length} m long",
        "make the lengths of the elements add up to `length`, in m";
    /// The sides of a solid rectangle are constants, since its torsion constant is a series.
    E065 live_side(subject) "{subject} cannot be a parameter", "the torsion constant of a solid rectangle needs constant sides",
        "write a number, or give `numbers: {{area, Jy, Jz, Jo}}` with parameters";
    /// The parts of a beam add up to its length.
    E066 parts_length(sum, length) "the parts do not add up to the beam", "{sum} m in all, the beam is {length} m long",
        "make the lengths of the parts add up to `length`, in m";
    /// The lengths of a beam with parts, and of its parts, are constants: they decide which parts an element consists of.
    E067 live_part(subject) "{subject} cannot be a parameter", "it decides which part of the beam an element belongs to",
        "write a number, in m; dimensions of sections may be parameters";
    /// The sections at both ends of a tapered part are dimensions of the same shape.
    E068 taper(from, to) "a part cannot taper from a `{from}` to a `{to}`", "its beginning is a `{from}`",
        "give both ends the same shape, `box`, `tube`, `solid` or `circle`, or make parts without `to`";
    /// A beam has one section or parts.
    E069 section_and_parts() "the beam is given in two ways: `section` and `parts`", "`parts` is given, too",
        "give one `section`, or `parts` with a section each";

    // Supports.
    /// Supports carry a base that can move.
    E070 base_fixed(base) "the crane has supports, but its base `{base}` is not free", "nothing to support",
        "write `joint: free` in the first link, or remove `supports`";
    /// Linear supports belong to a base that is placed without rotation and moves about the origin of its own frame.
    E071 linear_placed(support, how) "support `{support}` is linear, but the base is placed {how}",
        "linear kinematics need the world's axes, and rotations about the base's origin",
        "write `kinematics: exact`, or place the base by `transform` without `rotation`";
    /// Supports carry a base that is rigid.
    E072 supports_on_beam(base) "the crane has supports, but its base `{base}` is a flexible beam",
        "they would hold only its first element", "put a rigid link with `joint: free` under the beam";
    /// A one-sided support presses with its vertical spring.
    E073 nothing_to_press(support) "one-sided support `{support}` has nothing to press with", "its vertical stiffness is 0 N/m",
        "give `stiffness` a third number above zero, in N/m, or remove `one_sided`";
    /// Only a one-sided support has friction on the ground.
    E074 friction_of_two_sided(key, support) "`{key}` of support `{support}` has no effect", "the support pulls as well as presses, and never slides",
        "add `one_sided: true`, or remove `{key}`";
    /// A support that sticks has no coefficient of friction.
    E075 friction_of_stuck(support) "support `{support}` sticks and has a coefficient of friction", "a support that sticks never slides",
        "keep `sticks: true` or `friction_coefficient`, and remove the other one";

    // Drives, damping, profiles.
    /// A coordinate has at most one drive and one passive damping.
    E080 driven_twice(coordinate) "coordinate `{coordinate}` is driven twice", "already has a drive", "keep one of the two";
    /// Drives act on joints, not on a free base or inside a beam.
    E081 cannot_drive(coordinate, owner) "coordinate `{coordinate}` cannot be driven", "it belongs to {owner}",
        "drive the coordinate of a revolute or prismatic joint";
    /// A table has as many values as times, at least two.
    E082 table_length(times, values) "the table has {times} times and {values} values", "expected one value per time, at least two",
        "give as many `values` as `times`";
    /// The times of a table increase.
    E083 table_order(before, after) "the times of the table do not increase: {before} s, then {after} s", "not later than {before} s",
        "write `times` in strictly increasing order, in s";
    /// The blend of a trapezoid is above 0 and at most 0.5.
    E084 blend(given) "a trapezoid cannot have a blend of {given}", "must be above 0 and at most 0.5", "write the fraction of the duration spent accelerating, such as 0.25";
    /// Passive damping belongs to joints that are neither driven nor inside a beam.
    E085 not_passive(coordinate, owner) "coordinate `{coordinate}` is not passive", "it belongs to {owner}",
        "give the damping there";
    /// Rotors turn with joints; the rotor of a driven joint belongs to its drive.
    E086 no_rotor(coordinate, owner, help) "coordinate `{coordinate}` has no rotor", "it belongs to {owner}",
        "{help}";
    /// A drive has a stiffness, is rigid, or has an effort; a coupling has a stiffness or is rigid.
    E087 no_transmission(subject, none, help) "{subject} has no stiffness", "{none}", "write its `stiffness:`, {help}";
    /// A rigid drive has neither stiffness, damping nor effort, a rigid coupling neither stiffness nor damping.
    E088 rigid_spring(subject, key, follows) "{subject} is rigid and has `{key}`", "it has no spring and no damper, and its {follows}",
        "remove either `{key}` or `rigid: true`";
    /// The speed of a rigid drive does not jump.
    E089 jumps(coordinate, time) "the speed of rigid drive `{coordinate}` jumps at {time}",
        "this would need an infinite force", "add a `ramp` in s, or start the motion at t = 0 or earlier";

    // Run.
    /// `step` ≤ `output` ≤ `duration`.
    E090 run_order(smaller, larger) "`{smaller}` is longer than `{larger}`", "longer than `{larger}`",
        "choose step ≤ output ≤ duration, in s";
    /// At least one analysis is requested.
    E091 no_analyses() "`analyses` is empty", "nothing to compute", "list one or more of statics, dynamics, modes, derivatives";
    /// The guess of a coordinate is not prescribed by a rigid drive.
    E092 prescribed_guess(coordinate) "the guess of `{coordinate}` has no effect", "its rigid drive prescribes its position",
        "remove it";
    /// A drive with a maximum effort has a stiffness.
    E093 limited_without_spring(coordinate) "the drive of `{coordinate}` has a maximum effort but no spring", "its stiffness is 0",
        "give it a stiffness above zero, or remove `max_effort`";

    // Stops and friction of joints.
    /// Stops and friction belong to joints, not to a free base or the inside of a beam.
    E094 not_a_joint(coordinate, what, owner) "coordinate `{coordinate}` cannot have {what}", "it belongs to {owner}",
        "name the coordinate of a revolute or prismatic joint";
    /// Stops limit at least one end of a joint's range.
    E095 no_stop(coordinate) "the stops of `{coordinate}` have no position", "neither `min` nor `max`",
        "write `min:` or `max:` or both, in rad or m";
    /// The minimum position of a joint is below its maximum.
    E096 stops_crossed(coordinate, least, greatest) "the stops of `{coordinate}` leave no range", "from {least} to {greatest}",
        "make `min` less than `max`";
    /// The breakaway friction is at least the Coulomb friction.
    E097 breakaway(coordinate, coulomb, breakaway) "the friction of `{coordinate}` is less at rest than in motion",
        "breakaway {breakaway}, coulomb {coulomb}", "make `breakaway` at least as large as `coulomb`, or leave it out";
    /// Stribeck friction declines from a breakaway friction.
    E098 stribeck_alone(coordinate) "the Stribeck friction of `{coordinate}` has no breakaway friction to decline from", "`stribeck` without `breakaway`",
        "add `breakaway:`, at least as large as `coulomb`, or remove `stribeck`";

    // Loads.
    /// A load has a force or a moment.
    E099 no_load(load) "load `{load}` has neither force nor moment", "pulls nowhere",
        "write `force: [x, y, z]` in N, `moment: [x, y, z]` in N m, or `wind`";

    // Curved beams.
    /// A curved beam has sections between which it is bent.
    E100 bent_in_one_piece() "a rigid beam cannot be curved", "its one body is straight",
        "leave `bend` out, or divide the beam into sections";

    // Joints that stick.
    /// The parameters of bristle friction are constants, since the deflection of bristles is a state of the motion.
    E101 live_bristles(coordinate) "the friction of `{coordinate}` has bristles, so it cannot use a live parameter", "`coulomb`, `breakaway` or `stribeck` is a parameter",
        "write numbers there, or remove `bristle`";
    /// Bristles have a Coulomb friction above zero.
    E102 bristles_of_nothing(coordinate) "the bristles of `{coordinate}` need a Coulomb friction above 0", "`coulomb` is 0", "write the Coulomb friction, or remove `bristle`";
    /// A joint whose motion is prescribed does not stick.
    E103 prescribed_bristles(coordinate) "the friction of `{coordinate}` has bristles, but its drive is rigid", "a joint that follows its motion exactly does not stick",
        "remove `bristle`, or give the drive a `stiffness`";
    /// A drive with a maximum rate or power has a maximum effort.
    E104 limit_without_effort(coordinate, key) "the drive of `{coordinate}` has `{key}` but no `max_effort`", "a real drive has all of them",
        "add `max_effort:`, the maximum torque or force of the drive, N m or N";
    /// Bristles stick: their friction has no width.
    E105 width_of_bristles(coordinate) "the friction of `{coordinate}` has a `width` and a `bristle`", "bristles stick without creeping",
        "remove `width`, or `bristle`";
    /// Only joints of the chain have bristles.
    E106 bristles_in_a_loop(joint) "the friction of loop joint `{joint}` has a `bristle`", "only joints of the chain stick",
        "remove `bristle`: the pin then creeps at about the rate `width`; or close the loop at another joint, so that this pin is one of the chain";

    // Inputs.
    /// An input has a value or follows a motion until it is set.
    E110 input_twice(input) "input `{input}` has a `value` and a `motion`", "one of the two",
        "keep the one that applies until the input is set";
    /// References name an input.
    E111 unknown_input(name, help) "unknown input `{name}`", "not under `inputs`", "{help}";
    /// An input does not follow an input.
    E112 input_of_input(input) "input `{input}` follows an input", "an input again",
        "write the `value` or the `motion` that it has until it is set";
    /// A rigid drive does not follow an input, which may jump.
    E113 rigid_input(coordinate) "the rigid drive of `{coordinate}` follows an input", "an input may jump, a rigid drive cannot",
        "give the drive `stiffness` and `damping`, or a motion without inputs";
    /// Every input is used.
    E114 unused_input(input) "input `{input}` is not used", "no drive, valve, load or rope refers to it",
        "name it in `motion: {{input: …}}` of a drive or a rope, in `offset` or `effort` of a drive, in the `opening` of a valve or in `scale: {{input: …}}` of a load, or remove it";

    // Cylinders.
    /// The rod of a cylinder is thinner than its piston.
    E115 thick_rod(cylinder, rod, bore) "the rod of cylinder `{cylinder}` is not thinner than its piston", "rod {rod} m, bore {bore} m",
        "both are diameters: make `rod` less than `bore`";
    /// A cylinder has its joint between its pins.
    E116 spans_not(cylinder, coordinate) "cylinder `{cylinder}` does not move `{coordinate}`", "both pins are on the same side of this joint",
        "put `foot` on a link before the joint and `head` on the link that it moves, or name another coordinate";
    /// A cylinder moves a single joint.
    E117 spans_more(cylinder, coordinate, other) "cylinder `{cylinder}` spans `{other}` besides `{coordinate}`", "two joints between its pins",
        "put its pins on links that only `{coordinate}` moves relative to each other";
    /// The joint of a cylinder has a drive, whose effort is the cylinder's.
    E118 undriven(cylinder, coordinate) "cylinder `{cylinder}` has no drive", "`{coordinate}` is not driven",
        "add a drive for `{coordinate}` that prescribes the motion of the cylinder";
    /// A joint has one cylinder; two in parallel are given as one with twice the area.
    E119 second_cylinder(coordinate, other) "`{coordinate}` has two cylinders", "moved by cylinder `{other}` already",
        "give one cylinder: two equal ones in parallel act as one with √2 times the `bore` and `rod`";
    /// A cylinder with a valve has compressible oil on both sides, and a maximum pressure.
    E120 valve_without_oil(cylinder, missing) "the valve of cylinder `{cylinder}` needs {missing}", "pressures follow from the oil's volumes and stiffness",
        "typical: `bulk_modulus: 1.2e9` Pa, `max_pressure: 28e6` Pa and `hose_volumes: [5e-4, 5e-4]` m³";
    /// A pump supplies the valves with pressure.
    E121 valve_without_pressure(cylinder) "nothing supplies the valve of cylinder `{cylinder}`", "the spec gives no pressure of a pump",
        "add `pump: {{max_flow: 1.5e-3, pressure: 22e6}}` with the data of your pump, in m³/s and Pa";
    /// A joint that oil moves has a drive with a stiffness, and without a limit and an effort.
    E122 valve_of_another_drive(cylinder, coordinate) "cylinder `{cylinder}` has a valve, but the drive of `{coordinate}` is rigid, limited or has an `effort`",
        "oil moves this joint: the cylinder's pressures limit its force",
        "give the drive a `stiffness`, which holds the crane at rest before the run, and neither `rigid`, `effort` nor `max_effort`";
    /// A valve opens before its spool reaches the end of its travel.
    E123 covered_valve(cylinder, overlap) "the valve of cylinder `{cylinder}` never opens", "an overlap of {overlap} covers the whole travel of the spool",
        "`overlap` is a fraction of the spool's travel below 1, such as 0.05";
    /// Oil remains on both sides at the ends of the stroke.
    E124 no_oil_at_the_end(cylinder) "cylinder `{cylinder}` has no oil left at an end of its stroke", "a volume of 0 m³ has an infinite stiffness",
        "give both sides the oil of hoses and dead ends, such as `[5e-4, 5e-4]` m³";
    /// A linkage moves a joint that rotates.
    E125 straight_linkage(cylinder, coordinate) "cylinder `{cylinder}` has a linkage, but `{coordinate}` slides", "rocker and link need a joint that rotates",
        "remove `linkage`, or name the coordinate of a revolute joint";
    /// A pump supplies cylinders.
    E126 pump_alone() "the pump supplies nothing", "the spec has no cylinders", "add `cylinders:`, or remove `pump`";
    /// A servo or an opening over time commands a valve.
    E127 uncommanded_valve(cylinder) "nothing commands the valve of cylinder `{cylinder}`", "neither `gain` nor `opening`",
        "write `gain:`, 1/m, for a servo that follows the drive's motion, or `opening:`, a motion or an input from -1 to 1";
    /// A valve has one command: a servo or an opening over time.
    E128 valve_commanded_twice(cylinder, other) "the valve of cylinder `{cylinder}` has two commands", "`opening`, and {other}",
        "with `opening`, remove `gain` and `feed_forward` (in a spec that extends another: `gain: ~`), and let the drive's motion `hold` the position of the crane before the run";

    // Connectors.
    /// At least one coordinate changes the length of a connector.
    E130 rigid_connector(connector) "connector `{connector}` cannot change its length", "there is no joint between its points",
        "attach it to links on both sides of a joint, or to a link and the world";
    /// A rope has a length or a motion of its winch.
    E131 rope_length(connector) "rope `{connector}` needs exactly one of `length` and `motion`", "one of them gives its free length",
        "write `length:` in m, or `motion:` for a winch";
    /// The two points of a connector are apart.
    E132 meeting_points(connector) "the two points of connector `{connector}` coincide", "the line between them has no direction",
        "attach it to points that are apart at the `guess` and remain so while the crane moves";
    /// A coupling joins two coordinates.
    E133 own_leader(coupling) "coupling `{coupling}` makes a coordinate follow itself", "the same as `coordinate`",
        "write the other coordinate, the one that leads, under `follows`";

    // Tables from files.
    /// A table refers to a CSV file that can be read.
    E134 no_data(file, problem) "`file: {file}` cannot be read: {problem}", "times and values of the table",
        "give a CSV file, with its path relative to this spec: times in s in the first column, values in another";
    /// A table refers to a column that its file has.
    E135 data_column(file, column, known) "`{file}` has no column `{column}`", "its columns: {known}",
        "the first row names the columns; a unit in brackets is not part of the name";
    /// The units of columns of a data file are in the table of units.
    E136 data_unit(file, column, unit, help) "column `{column}` of `{file}` is in `{unit}`, which is not a unit", "its heading gives a unit in brackets",
        "{help}; without a unit, numbers are in SI units";
    /// The rows of a data file contain numbers.
    E137 data_number(cell, column, help) "{cell} in column {column} is not a number", "a row of the table", "{help}";
    /// A data file has at most 1000 rows.
    E138 long_table(file, rows, most, every) "`{file}` has {rows} rows", "at most {most}, because every row costs time in every step",
        "keep one row in {every}: a smooth curve passes through the rows";
    /// A table has times and values, or a file.
    E139 table_incomplete() "the table lacks `times` or `values`", "expected both, or a `file`",
        "write `{{times: [0, 1, 2], values: [0, 0.5, 1]}}` or `{{file: wind.csv, column: wind}}`";
    /// Only tables from files have columns.
    E140 column_without_file() "`column` belongs to a `file`", "this table has none", "remove it, or give the `file`";
    /// A table has times and values or a file, not both.
    E141 table_twice() "the table has times and values as well as a `file`", "one of them suffices", "remove the other one";
    /// The columns of a data file are separated by commas, and its numbers have decimal points.
    E142 data_separators(file, with) "`{file}` has {with}", "expected lines such as `0.5,1.2`",
        "save it as CSV with commas between columns and decimal points; in a spreadsheet, choose English (USA) as its language first";

    // Joints that close loops.
    /// A joint that closes a loop holds a link.
    E143 loop_in_the_world(joint) "loop joint `{joint}` holds nothing", "both points are in the world",
        "write `link:` under `from` or `to`";
    /// At least one coordinate moves the points of a loop joint against each other.
    E144 rigid_loop(joint) "loop joint `{joint}` closes no loop", "there is no joint between its points",
        "attach it to links on both sides of a joint, or to a link and the world";
    /// At least one coordinate between the points of a loop joint, or of a rigid coupling, is free to move.
    E145 prescribed_loop(subject, mover) "{subject} holds what rigid drives move", "all coordinates that it ties are prescribed",
        "give one of these drives a `stiffness`, or leave its joint passive: the {mover} moves it";
    /// Axes of loop joints and directions of wind are directions.
    E146 no_direction(subject) "{subject} has no direction", "all three numbers are 0",
        "write a direction, such as `[0, 1, 0]`";
    /// The two points of a rod are apart.
    E147 meeting_rod(joint) "the two points of rod `{joint}` coincide at the guess", "the rod between them has no direction",
        "write a `guess` at which the rod has about its length; a joint without length is a `ball`";
    /// Eight cranes per call cannot have loops or rigid couplings.
    E148 ensemble_of_loops(what, help) "`ensemble` cannot be combined with {what}", "eight cranes per call are for open chains",
        "remove `ensemble`: runs of many cranes then compute them one by one{help}";
    /// Of the joints that close loops, only pins have friction and damping.
    E149 friction_of_no_pin(joint, key, kind) "loop joint `{joint}` has `{key}`, but is a `{kind}`", "only a `pin` has friction and damping",
        "remove `{key}`, or write `joint: {{pin: {{axis: …}}}}` with the direction about which it turns";
    // Branches.
    /// The first link stands on the world.
    E150 base_on_link(link) "the first link, `{link}`, cannot be attached to another link", "it stands on the world",
        "remove `on`, or list the link that carries it before it";
    /// A link is not attached to itself.
    E151 on_itself(link) "link `{link}` is attached to itself", "its own name", "name an earlier link, or remove `on` to use the previous one";
    /// A link is attached to an earlier one.
    E152 on_later(link, other) "link `{link}` is attached to `{other}`, which comes later", "listed below `{link}`",
        "list `{other}` before `{link}`: a link comes after the one that carries it";
    /// Links are not attached to each other in a circle.
    E153 circle(link, other) "links `{link}` and `{other}` carry each other", "`{other}` is attached to `{link}`, directly or through others",
        "attach one of them to another link; a joint under `loop_joints:` closes a loop of links";
    /// Only beams and ropes have a `start`.
    E154 start_of_rigid(link) "link `{link}` has no start", "a rigid link has one frame", "leave out `at`, or write `[x, y, z]` in the frame of `{link}`, in m";
    /// A place on a beam or a rope is between its beginning and its end.
    E155 beside_the_beam(link, x, length) "the place at x = {x} m is not on link `{link}`", "the link reaches from 0 to {length} m",
        "write `[x, y, z]` in m from the beginning of `{link}` along its x, or `tip`";
    // Ropes over sheaves.
    /// Neighbouring points of a rope over sheaves are apart.
    E156 meeting_sheaves(rope, one, other) "{one} and {other} of rope `{rope}` coincide", "the rope between them has no direction",
        "attach them to points that are apart at the `guess` and remain so while the crane moves";
    /// Only ropes run over sheaves and have falls.
    E157 sheaves_without_rope(connector, key) "connector `{connector}` has `{key}`, but its law is not `rope`", "only ropes run over sheaves",
        "write `law: {{rope: {{axial_stiffness: 5e6, length: 12}}}}` with numbers of the rope, or remove `{key}`";
    /// A list of sheaves has at least one.
    E158 no_sheaves(rope) "rope `{rope}` runs over no sheaves", "an empty list",
        "list the sheaves from `from` to `to`, such as `over: [{{link: boom, at: [4, 0, 0.2]}}]`, or remove `over`";
    /// A rope has a whole number of falls.
    E159 falls(rope, count) "rope `{rope}` has {count} falls", "a whole number from 1 to 100",
        "write how many parts of the rope run between the last sheave and `to`, such as `falls: 2`";
    /// A rope has a stiffness or an axial stiffness.
    E160 rope_stiffness(rope) "rope `{rope}` needs exactly one of `stiffness` and `axial_stiffness`", "one of them gives its stiffness",
        "write `stiffness:` in N/m, which stays the same, or `axial_stiffness:`, EA in N: the stiffness is then EA divided by the free length";
    /// The free length of a rope with an axial stiffness stays above zero.
    E161 wound_up(rope, length) "the free length of rope `{rope}` does not stay above zero", "it reaches {length} m, and EA divided by it is the stiffness",
        "write lengths above 0 m, or a `stiffness` in N/m instead of `axial_stiffness`";

    // Telescopes.
    /// A beam that slides in another one has a prismatic joint along x.
    E170 slider_joint(link) "the joint of link `{link}` is not prismatic along x", "its beam slides in another one along its x",
        "write `joint: {{prismatic: {{axis: x}}}}`: the coordinate is how far the beam has moved out";
    /// A beam that slides in another one is placed by that.
    E171 placed_slider(link, key) "link `{link}` slides in a beam, and has `{key}`", "the beam in which it slides and `overlap` place it",
        "remove `{key}`; `overlap` is how far the beam is in the outer one where its coordinate is 0";
    /// What a beam slides in is a beam.
    E172 slides_in_no_beam(link, outer) "link `{link}` slides in `{outer}`, which is not a beam", "only beams hold pads",
        "give `{outer}` a `beam:`, with `sections: rigid` if it does not bend";
    /// The outer beam of a telescope is straight and divided into sections.
    E173 uneven_outer(outer, key) "beam `{outer}`, in which another one slides, has `{key}`", "pads move on straight beams that are divided into sections",
        "describe `{outer}` by `sections`, `material` and `section` or `parts`, without `bend`";
    /// The inner beam of a telescope is straight and divided into sections.
    E174 uneven_slider(link, key) "beam `{link}` slides in another one, and has `{key}`", "pads move on straight beams that are divided into sections",
        "describe it by `sections`, `material` and `section` or `parts`, without `bend`";
    /// The overlap of two beams of a telescope is within both.
    E175 overlap(link, overlap, length) "the overlap of `{link}` is {overlap} m, more than a beam of {length} m", "where the coordinate is 0, the inner beam is that far in the outer one",
        "write an overlap of at most the length of both beams; the coordinate shortens it";
    /// Pads hold a beam against twist.
    E176 untwisted(link) "no pad holds `{link}` against twist", "the third number of `stiffness` is 0 in both, and `exact` lacks `twist`",
        "write the stiffness against twist in N m/rad as the third number of `front`, of `rear` or of both, or add `twist` to `exact`";

    // Efforts of drives.
    /// A drive that is rigid or has a spring has a motion.
    E177 drive_without_motion(coordinate) "drive `{coordinate}` has no motion", "its spring, or its joint, follows a motion",
        "write `motion:`, for example `motion: {{hold: 0}}`";
    /// A drive with a motion has a spring or a damper, or is rigid.
    E178 motion_without_spring(coordinate) "the motion of drive `{coordinate}` has no effect", "it has an `effort`, and neither spring nor damper",
        "remove `motion`, or write the `stiffness:` or `damping:` through which it acts";

    // Exact pads.
    /// Where a pad holds exactly it has no stiffness, damping or clearance.
    E179 exact_spring(pad, direction, key) "{pad} is exact along `{direction}` and has `{key}` there", "an exact pad does not give way",
        "write 0 here, or remove `{direction}` from `exact`";
    /// A pad without `stiffness` is exact along y and z.
    E180 loose_pad(pad, direction) "{pad} does not hold along {direction}", "it has no `stiffness`, and `exact` lacks {direction}",
        "write `exact: [y, z]`, with `twist` if it holds against it, or give the `stiffness`";
    /// A load that a combination names exists.
    E181 unknown_load(name, help) "there is no load `{name}`", "not listed under `loads:`", "{help}";
    /// A mass that a combination names is a live parameter.
    E182 unknown_mass(name, help) "there is no live parameter `{name}`", "a mass with a factor of its own is one", "{help}";
    /// A mass that a combination names is in kg.
    E183 not_a_mass(combination, name, unit) "`{name}`, a mass of combination `{combination}`, is in {unit}", "its weight has a factor of its own",
        "name a live parameter in kg; factors of forces and moments are given under `loads`";
    /// Live places along a beam, where sections end, keep their order.
    E184 places_meet() "a place on a beam meets another one, or an end of the beam", "it is divided where something acts on it",
        "give the place in the spec: then the beam is divided again";
    /// The `combination` with which a crane is computed is one of its `combinations`.
    E185 unknown_combination(name, help) "there is no combination `{name}`", "not listed under `combinations:`", "{help}";
    /// A load has either a force or a wind.
    E186 wind_and_force(load) "load `{load}` has a wind and a force", "the wind gives its force", "remove `force`, or write another load for it";
    /// A wind has either a pressure or a speed.
    E187 pressure_or_speed(load) "the wind of load `{load}` needs either a pressure or a speed", "one of the two gives its force",
        "write `pressure: 250 Pa` or `speed: 20 m/s`";
    /// A motion that halts is not an input.
    E188 halted_input(name) "`halt` of `{name}` cannot stop an input", "its motion is set from outside",
        "stop the input instead, and remove `halt`; or give it a motion over time, such as `motion: {{speed: {{rate: 0.2}}}}`";
    /// With a slope, gravity is along z.
    E189 slope_twice() "`slope` turns a gravity that is inclined already", "`gravity` has a part along x or y",
        "write `gravity: [0, 0, -9.81]` or leave it out; or remove `slope`";
    /// A slope is less steep than 90°.
    E190 steep_slope(angle, degrees) "the ground is inclined by {angle} rad", "90° or more", "angles are in rad: write `{degrees} deg` for degrees";
    /// A point is either on a link or in a frame.
    E191 link_or_frame(point) "point `{point}` needs either a link or a frame", "one of the two says where `at` is given",
        "write `link:` with a link, or `frame:` with one of `frames`";
    /// A frame that carries a point exists, and is on a link.
    E192 unknown_frame(name, help) "there is no frame `{name}` on a link", "not listed under `frames:` with a `link`", "{help}";
    /// An event sets parameters.
    E193 nothing_set(event) "event `{event}` sets nothing", "it changes the values of parameters", "write `set: {{payload: 0}}`, with parameters by name";
    /// What events set obeys the rules for parameters.
    E194 event_breaks_rule(event, what, help) "after event `{event}`, {what}", "these values are set together", "{help}";
    /// Masses that join with a velocity have a point.
    E195 joins_without_point(event) "what joins at event `{event}` has a velocity and no point", "its momentum acts at its centre of mass",
        "write `point:` with the one of `points` at which it is";
    /// The point at which masses join exists.
    E196 unknown_point(name, help) "there is no point `{name}`", "not listed under `points:`", "{help}";
    /// A point that the ground may carry moves.
    E197 rigid_contact(name) "the point of contact `{name}` never moves", "no coordinate moves this link", "name a link that moves, or remove the contact";
    /// The file of a mesh is an STL or OBJ file.
    E198 unknown_mesh(file) "a mesh is in `{file}`", "not an STL or OBJ file", "name a file that ends in `.stl` or `.obj`; other programs convert others";
    /// An event has either a time or a condition.
    E199 at_or_when(event) "event `{event}` needs either a time or a condition", "one of the two says when it happens",
        "write `at: 2 s`, or `when: {{result: hook_z, above: 1.5 m}}`";
    /// The result of a condition is one of the crane's at an instant.
    E200 unknown_result(name, help) "there is no result `{name}`", "conditions name columns of the crane's parts, such as `boom_psi` or `hoist_force`", "{help}";
    /// A condition has either a value above or one below.
    E201 above_or_below(event) "the condition of event `{event}` needs either `above` or `below`", "it happens when the result passes one value",
        "write `above: 1.5 m` or `below: 1.5 m`";
    /// What a combination names has a factor.
    E202 no_factor(combination, what, help) "combination `{combination}` names {what}, and has no factor for it", "nothing says by how much it counts", "{help}";
    /// A combination with hoisting says what is hoisted.
    E203 nothing_hoisted(combination) "combination `{combination}` hoists nothing", "its factor multiplies the weight of what is `hoisted`",
        "write `hoisted: [payload]`, with live parameters in kg";

    // Plausibility: warnings.
    /// Young's modulus is from 1e9 to 1e12 Pa, the shear modulus from 1e8 to 5e11 Pa, a yield stress from 1e6 to 5e9 Pa.
    W001 modulus(what, subject, given, usual, help) "{what} of {subject} is {given} Pa", "usual: {usual} Pa", "{help}";
    /// The shear modulus is at most half of Young's modulus: Poisson's ratio is not below zero.
    W002 poisson(subject, ratio) "{subject} has a Poisson's ratio of {ratio}", "`G` exceeds E/2",
        "check that `E` and `G` are not swapped; steel has E = 2.1e11, G = 8.1e10";
    /// Densities are from 100 to 25000 kg/m³.
    W003 density(subject, given, help) "the density of {subject} is {given} kg/m³", "usual: 100 to 25000 kg/m³", "{help}";
    /// Cross-sections are at most 5 m high and wide, their area at most 4 m², their moments at most 10 m⁴.
    W004 section_size(subject, what, help) "the section of {subject} has {what}", "larger than in any crane", "{help}";
    /// Lengths and distances within a crane are at most 200 m.
    W005 far(what, given, help) "{what} is {given} m", "larger than any crane", "{help}";
    /// A beam is longer than its section is high or wide.
    W006 stubby(subject, key, side, length) "{subject} is shorter than its section is high or wide", "`{key}` is {side} m, the beam {length} m long",
        "check both units; a body this short does not bend like a beam: use `sections: rigid`";
    /// The torsion constant of a section is at most the sum of its two second moments of area.
    W007 torsion_constant(subject, given, polar) "the torsion constant `Jo` of {subject} exceeds Jy + Jz", "{given} m⁴ exceeds {polar} m⁴",
        "write the torsion constant: Jy + Jz for circles and tubes, less for boxes, far less for open sections";
    /// Angles without `deg` or `pi` are at most one turn, speeds one turn per second.
    W008 degrees(what, given, unit, turns, help) "{what} is {given} {unit}", "{turns}", "{help}";
    /// The damping of a beam does not suppress its lowest bending vibration: β ω is at most 10 for the beam alone, clamped at one end.
    W009 overdamped(link, beta, frequency, product) "the damping of beam `{link}` suppresses all vibration: β ω = {product}",
        "β = {beta} s, the lowest bending frequency is {frequency} rad/s", "check the unit: `beta` is in s, 1e-4 to 1e-2 s for steel structures";
    /// A payload is not out of proportion to the crane that carries it.
    W010 payload(subject, mass, crane, help) "the mass of {subject} is {mass} kg", "the crane that carries it has a mass of {crane} kg", "{help}";
    /// Principal moments satisfy the triangle inequality; measured ones may exceed it by up to 25 % (beyond: E051).
    W011 slight_triangle(subject, largest, others) "{subject} slightly violates the triangle inequality", "{largest} kg m² exceeds {others} kg m², the sum of the other two principal moments",
        "no principal moment about the centre of mass exceeds the sum of the other two; rounded or identified data may violate this slightly";
    /// The free length of a connector is consistent with the distance between its points at the guess.
    W021 connector_length(connector, length, distance) "connector `{connector}` has a free length of {length} m", "its points are {distance} m apart at the guess",
        "check the unit, the points and the `guess`: its force is the stiffness times the difference between distance and length; a rope only pulls";
    /// Pressures, flows, sizes of cylinders, stiffnesses and other numbers have usual magnitudes in SI units.
    W022 unusual(what, given, usual, help) "{what} is {given}", "usual: {usual}", "{help}";
    /// The relief valves of a cylinder open above the pressure of the pump.
    W023 relief_below_pump(pressure, cylinder, relief) "the pump supplies {pressure} Pa, more than the relief pressure of cylinder `{cylinder}`",
        "its relief valve opens at {relief} Pa, its `max_pressure`", "check both; a relief valve usually opens above the pressure of the pump";
    /// The command of a valve is from −1 to 1.
    W024 opening_beyond(cylinder, opening) "the valve of cylinder `{cylinder}` has an opening of {opening}", "−1 and 1 are fully open; beyond them nothing changes",
        "write a fraction: 50 % is 0.5";
    /// When its drive starts, the distance between the pins of a cylinder is within its stroke.
    W025 out_of_stroke(cylinder, length, least, most, help) "cylinder `{cylinder}` is {length} m long at the start of its drive's motion", "its stroke is from {least} m to {most} m",
        "{help}";
    /// Bristles of a joint that sticks slide after a deflection of 1e-8 to 0.1 m or rad.
    W026 odd_bristles(coordinate, deflection, unit) "the bristles of `{coordinate}` slide after a deflection of {deflection} {unit}", "breakaway friction over stiffness; usual: 1e-8 to 0.1 {unit}",
        "check the unit of `stiffness`: bristles that are too stiff force very small steps, and bristles that are too soft act as a spring";
    /// The greatest rate of a drive is at least a hundredth of what its motion asks for.
    W028 slow_drive(coordinate, limit, speed, unit) "the drive of `{coordinate}` moves at most at {limit} {unit}", "its motion is {speed} {unit} fast on average",
        "check the unit of `max_rate`: a drive this slow stands still, and forces very small steps";
    /// Where its drive starts, a cylinder has a lever arm of at least 0.01 m.
    W029 no_lever(cylinder, lever) "cylinder `{cylinder}` has a lever arm of {lever} m where its drive starts", "its force is the effort of the drive over this lever arm",
        "check the pins and the motion of the drive: pins in line with the joint carry no moment";
    /// The safety factor of a beam is at least 1.
    W030 unsafe_factor(link, factor) "the safety factor of beam `{link}` is {factor}", "below 1 it allows stresses beyond the yield stress",
        "write the yield stress over the allowable stress, such as 1.5";
    /// The radius of gyration of a link is not larger than the crane.
    W031 spread_mass(subject, radius, size) "the inertia of {subject} is that of a mass {radius} m away from its centre", "all joints and feet of the crane are within {size} m",
        "check exponents and units: moments of inertia are in kg m², radii of `gyration` in m";
    /// A centre of mass is not farther away than the crane is large.
    W032 far_mass(subject, distance, size) "the centre of mass of {subject} is {distance} m away from its frame", "all joints and feet of the crane are within {size} m",
        "write `com` in m, from the origin of the link's frame; check the decimal point";
    /// A boom does not turn about the vertical directly after a joint that does.
    W033 swept(link, before) "boom `{link}` sweeps in the horizontal plane", "its joint turns about the vertical, as that of `{before}` does",
        "a boom that is raised has a horizontal axis: add `rotation: {{x: 90 deg}}` to its `placement`, or set the `axis` of its joint";
    /// The feet of a crane are at similar heights.
    W034 raised_foot(support, height, usual) "support `{support}` is {height} m high", "the other supports are at a height of {usual} m",
        "check the third number of `at`, in m: a foot in the air lifts off at once or tilts the crane";
    /// Supports are apart.
    W035 same_foot(support, other) "support `{support}` is in the same place as `{other}`", "two supports in one place act as one",
        "give each its own position, `at: [x, y, z]` in m: usually the signs of y differ";
    /// The base of a crane on feet that lift is not far lighter than what it carries.
    W037 light_base(link, mass, carried) "the base `{link}` has a mass of {mass} kg", "it carries {carried} kg, on feet that can lift",
        "write masses in kg: 8.6 t = 8600 kg, without a comma or a point for thousands";
    /// A coupling of two joints of one kind has a ratio of at most 20.
    W039 high_ratio(coupling, ratio, coordinate, leader) "coupling `{coupling}` has a ratio of {ratio}", "`{coordinate}` moves {ratio} times as far as `{leader}`",
        "`ratio` is the travel of `coordinate` over that of `follows`: two stages on a chain have 1";
    /// The linkage of a cylinder can be assembled where its drive starts.
    W040 unassembled(cylinder, rocker, link, distance) "the linkage of cylinder `{cylinder}` cannot be assembled at the start of its drive's motion",
        "rocker {rocker} m and link {link} m, but pivot and head are {distance} m apart",
        "their sum must exceed this distance, and their difference must be less: check `rocker`, `link`, `pivot` and `head`, in m";
    /// The weight that a drive holds turns its joint by less than 0.5 rad, or moves it by less than 0.5 m.
    W041 soft_drive(coordinate, sag, unit, stiffness, stiffness_unit) "the drive of `{coordinate}` is too soft for the weight that it holds",
        "with {stiffness} {stiffness_unit} the weight moves it by about {sag} {unit}", "check the exponent of `stiffness`; drives of cranes have 1e5 to 1e8 {stiffness_unit}";
    /// A stage of a telescope stays in its outer beam.
    W042 out_of_beam(stage, outer, overlap, coordinate, position, least) "`{stage}` leaves `{outer}`: with `{coordinate}` at {position} m the overlap is {overlap} m",
        "nothing holds it there, and results mean nothing", "let `{coordinate}` end at {least} m, or give longer beams and a longer `overlap`";
    /// A stage of a telescope overlaps its outer beam by at least the height of its section.
    W043 short_overlap(stage, overlap, coordinate, position, height, least) "the overlap of `{stage}` is only {overlap} m with `{coordinate}` at {position} m",
        "less than the height of its section, {height} m: real pads are too long, and walls too weak, for such a hold",
        "let `{coordinate}` end at {least} m, or give longer beams and a longer `overlap`";
    /// The sides of a loop can form a closed polygon.
    W044 open_polygon(joint, longest, others) "loop joint `{joint}` cannot close", "one side of its loop is {longest} m, all others together {others} m",
        "check `at` of both of its points, the lengths of its links and of a `rod`, in m";
    /// The axes of a pin are within 60° of each other at the guess.
    W045 crossed_axes(joint, angle) "the axes of pin `{joint}` are {angle}° apart at the guess", "a pin holds them parallel",
        "write `to_axis`, the direction of the axis in the frame of the link `to`, or a `guess` near a pose in which both are parallel";
    /// Two loop joints do not hold the same points.
    W046 held_twice(joint, other) "loop joint `{joint}` holds what `{other}` holds already", "both of its points are those of `{other}`",
        "remove one of them: how they share a force cannot be determined";
    /// A point of a loop joint on a beam is not beyond the beam by more than half its length.
    W047 beyond_beam(joint, x, link, length) "a point of loop joint `{joint}` is at {x} m, beyond beam `{link}` of {length} m", "the last element carries it like a rigid bracket",
        "check `at`, whose first number is the distance along the beam, in m";
    /// The clearance of a pad is at most 0.05 m, or 0.2 rad.
    W048 wide_clearance(stage, clearance, unit) "a pad of `{stage}` has a clearance of {clearance} {unit}", "the beam moves this far before the pad holds it",
        "write it in m and rad: 2 mm = 2e-3";
    /// The pads of a telescope have at least 1e4 N/m.
    W049 soft_pads(stage, stiffness) "a pad of `{stage}` has a stiffness of {stiffness} N/m", "the stage would drop through it",
        "write it in N/m: 20 kN/mm = 2e7; pads of cranes have 1e6 to 1e9 N/m";
    /// The effort of a drive stays within its maximum.
    W050 effort_beyond_limit(coordinate, effort, limit, unit) "the effort of the drive of `{coordinate}` reaches {effort} {unit}", "its `max_effort` is {limit} {unit}, and it delivers no more",
        "check the exponents of `effort` and `max_effort`";
    /// The curve through a table stays between its points, to 5 % of their range.
    W051 overshoot(from, to, reached) "the curve through this table reaches {reached}", "between two of its points, {from} and {to}",
        "write `shape: monotone`, with which it stays between its points, or more points";
    /// The stroke of a cylinder is shorter than its retracted length.
    W052 long_stroke(cylinder, stroke, retracted) "the stroke of cylinder `{cylinder}` is {stroke} m", "retracted, it is only {retracted} m long, and its rod must fit into it",
        "`retracted` is the distance between the pins of the retracted cylinder";
    /// The pins of a cylinder are in a plane in which its joint moves, to 30 % of their distance.
    W053 pins_aside(cylinder, aside, coordinate, share) "the pins of cylinder `{cylinder}` are {aside} m apart along the axis of `{coordinate}`", "{share} % of its force bends the pins instead of turning the joint",
        "check the order of x, y and z in `foot` and `head`: each is in the frame of its own link";
    /// The wall of a hollow section is at most a quarter as thick as its sides.
    W054 thick_wall(subject, key, thickness, side) "the `{key}` of {subject} is {thickness} m", "a side of the section is only {side} m",
        "write it in m: 14 mm = 0.014";
    /// The overlap of a stage is not longer than its beams.
    W055 pushed_through(stage, outer, overlap, coordinate, position, longest) "`{stage}` is {overlap} m in `{outer}` with `{coordinate}` at {position} m", "the shorter of the two beams is {longest} m long",
        "the coordinate grows as the stage comes out: check its sign, and that of the `ratio` of a coupling";
    /// Feet are at similar distances from the axis of their base.
    W059 far_foot(support, distance, others) "support `{support}` is {distance} m away from the axis of its base", "all others are within {others} m",
        "check the decimal point of `at`, in m";
    /// The smallest side of a shape is not larger than the crane.
    W060 large_shape(link, side, size) "every side of the shape of link `{link}` is at least {side} m long", "all joints and feet of the crane are within {size} m",
        "write sizes in m, or with their unit, such as `150 mm`";
    /// A rod is at least a tenth as thick as its piston, and a piston at most as wide as its cylinder is long.
    W061 odd_cylinder(cylinder, bore, rod, retracted) "cylinder `{cylinder}` has a bore of {bore} m and a rod of {rod} m", "retracted, it is {retracted} m long",
        "check the decimal points of `bore` and `rod`; rods are usually half as thick as their piston";
    /// The springs of feet, pads and couplings give way within 2 s.
    W062 slow_damper(what, time) "{what} gives way in {time} s", "its damping over its stiffness: it would sink like honey",
        "check the exponents of both; usual are 0.001 to 0.1 s";
    /// The third stiffness of a pad is that against twist.
    W063 stiff_twist(what, twist, along) "{what} has a stiffness of {twist} N m/rad against twist", "along y and z it has at most {along} N/m",
        "check the order: along y, along z, against twist; pads 0.2 m apart have a hundredth of the number of y and z";
    /// Gravity presses supports on the ground, within 40° of z.
    W064 gravity_aside(angle) "gravity is {angle}° off the vertical of the supports", "z of the world points up, and supports press along it",
        "write `gravity: [0, 0, -9.81]`, and slopes as an angle such as `5 deg`";
    /// Motions and events are within the run.
    W065 late(what, time, end) "{what} {time}", "the run ends at {end} s",
        "write times in s, or with their unit, such as `4000 ms`; or give `run:` a longer `duration`";
    /// The additional mass of a beam is at most 20 times that of its section.
    W066 heavy_extra(extra, section) "`extra_mass` is {extra} kg/m", "the section itself has {section} kg/m",
        "write it in kg/m: the mass of hoses and plates over the length of the beam";
    /// The wall of a hollow section is at least a 300th as thick as its sides.
    W067 thin_wall(subject, key, thickness, side) "the `{key}` of {subject} is {thickness} m", "a side of the section is {side} m: it would buckle like foil",
        "write it in m: 6 mm = 0.006";
    /// A sliding joint moves by at most five times the size of the crane.
    W068 far_slide(coordinate, position, size) "`{coordinate}` reaches {position} m", "all joints and feet of the crane are within {size} m without it",
        "write positions in m, or with their unit, such as `120 cm`";
}
