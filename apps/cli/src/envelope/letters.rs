//! A letter for each kind of limit, for the cells of charts.

/// Kinds of limits, their letters, and what they are, in the order of a legend.
const LETTERS: [(&str, char, &str); 16] = [
    ("tipping", 'T', "tipping"),
    ("utilisation", 'U', "utilisation of a beam"),
    ("pressure", 'P', "relief valve of a cylinder"),
    ("pump", 'Q', "pressure of the pump"),
    ("stroke", 'S', "stroke of a cylinder"),
    ("stops", 'N', "end stop of a joint"),
    ("effort", 'E', "effort of a drive"),
    ("sliding", 'F', "friction under all feet"),
    ("lift-off", 'L', "a foot lifts off"),
    ("ground", 'G', "pressure on the ground"),
    ("slack-ropes", 'R', "a rope is slack"),
    ("tension", 'W', "the tension of a rope"),
    ("overlap", 'O', "a stage is out of its outer beam, or too far in it"),
    ("deflection", 'D', "deflection"),
    ("equilibrium", 'X', "no equilibrium beyond"),
    ("", 'M', "none up to the maximum load considered"),
];

/// The letter of a kind of limit.
pub fn letter(kind: &str) -> char {
    LETTERS.iter().find(|(known, ..)| *known == kind).map_or('?', |(_, letter, _)| *letter)
}

/// The letters of some kinds and what they mean.
pub fn legend<'a>(kinds: impl Iterator<Item = &'a str>) -> Vec<String> {
    let kinds: Vec<&str> = kinds.collect();
    let used = LETTERS.iter().filter(|(kind, ..)| kinds.contains(kind));
    used.map(|(_, letter, meaning)| format!("{letter} {meaning}")).collect()
}
