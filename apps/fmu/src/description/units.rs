//! Units in terms of the base units of the interface.

use crane_codegen::units::Unit;

/// Exponents of kg, m, s and rad.
pub type Exponents = [i32; 4];

/// Names of the attributes for the exponents.
pub const NAMES: [&str; 4] = ["kg", "m", "s", "rad"];

/// Exponents of an SI unit such as `N m/rad` or `m/s2`: units after a slash divide. `None` for other units.
pub fn exponents(unit: &str) -> Option<Exponents> {
    let unit = Unit::parse(unit).ok().filter(Unit::is_si)?;
    let [m, kg, s, rad] = unit.dimension.0;
    Some([kg, m, s, rad])
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
