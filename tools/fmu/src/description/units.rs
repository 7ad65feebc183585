//! Units in terms of the base units of the interface.

/// Exponents of kg, m, s and rad.
pub type Exponents = [i32; 4];

/// Names of the attributes for the exponents.
pub const NAMES: [&str; 4] = ["kg", "m", "s", "rad"];

/// Units by symbol.
const SYMBOLS: [(&str, Exponents); 10] = [
    ("1", [0, 0, 0, 0]),
    ("kg", [1, 0, 0, 0]),
    ("m", [0, 1, 0, 0]),
    ("s", [0, 0, 1, 0]),
    ("rad", [0, 0, 0, 1]),
    ("Hz", [0, 0, -1, 0]),
    ("N", [1, 1, -2, 0]),
    ("Pa", [1, -1, -2, 0]),
    ("J", [1, 2, -2, 0]),
    ("W", [1, 2, -3, 0]),
];

/// Exponents of a unit such as `N m/rad` or `m/s2`: units after a slash divide. `None` if a symbol is unknown.
pub fn exponents(unit: &str) -> Option<Exponents> {
    let mut sum = [0; 4];
    for (index, part) in unit.split('/').enumerate() {
        let sign = if index == 0 { 1 } else { -1 };
        for factor in part.split([' ', '·']).filter(|factor| !factor.is_empty()) {
            let (symbol, power) = match factor.chars().last()? {
                '2' | '²' => (&factor[..factor.len() - last_length(factor)], 2),
                '3' | '³' => (&factor[..factor.len() - last_length(factor)], 3),
                '4' | '⁴' => (&factor[..factor.len() - last_length(factor)], 4),
                _ => (factor, 1),
            };
            let (_, base) = SYMBOLS.iter().find(|(known, _)| *known == symbol)?;
            sum.iter_mut().zip(base).for_each(|(sum, exponent)| *sum += sign * power * exponent);
        }
    }
    Some(sum)
}

/// Length of the last character in bytes.
fn last_length(text: &str) -> usize {
    text.chars().last().map_or(0, char::len_utf8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_taken_apart() {
        assert_eq!(exponents("N m/rad"), Some([1, 2, -2, -1]));
        assert_eq!(exponents("m/s2"), Some([0, 1, -2, 0]));
        assert_eq!(exponents("kg m²"), Some([1, 2, 0, 0]));
        assert_eq!(exponents("N s/m"), Some([1, 0, -1, 0]));
        assert_eq!(exponents("1"), Some([0; 4]));
        assert_eq!(exponents("deg"), None);
        assert_eq!(exponents("bar"), None);
    }
}
