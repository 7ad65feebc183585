//! C expressions: text, and how tightly it binds.

use super::Precision;

/// How tightly an expression binds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Sum,
    Product,
    Sign,
    Atom,
}

/// An expression.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Expression {
    text: String,
    level: Level,
}

impl Expression {
    /// A name, an element of an array, a call.
    pub fn atom(text: impl Into<String>) -> Self {
        Self { text: text.into(), level: Level::Atom }
    }

    /// A number; `{:?}` prints the shortest digits that read back as the same.
    pub fn number(value: f64, precision: Precision) -> Self {
        let magnitude = Self::atom(format!("{:?}{}", value.abs(), precision.suffix()));
        if value.is_sign_negative() { magnitude.negative() } else { magnitude }
    }

    /// A call of a function.
    pub fn call(function: &str, arguments: &[Expression]) -> Self {
        let arguments: Vec<&str> = arguments.iter().map(|argument| argument.text.as_str()).collect();
        Self::atom(format!("{function}({})", arguments.join(", ")))
    }

    /// −a
    pub fn negative(self) -> Self {
        let operand = self.within(Level::Atom);
        Self { text: format!("-{operand}"), level: Level::Sign }
    }

    /// a + b
    pub fn plus(self, other: Self) -> Self {
        self.binary("+", other, Level::Sum)
    }

    /// a − b
    pub fn minus(self, other: Self) -> Self {
        self.binary("-", other, Level::Sum)
    }

    /// a · b
    pub fn times(self, other: Self) -> Self {
        self.binary("*", other, Level::Product)
    }

    /// a / b
    pub fn over(self, other: Self) -> Self {
        self.binary("/", other, Level::Product)
    }

    /// The text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Operations of one level are evaluated from left to right: the right operand must bind more tightly, because sums are not
    /// associative.
    fn binary(self, sign: &str, other: Self, level: Level) -> Self {
        let right = match level {
            Level::Sum => Level::Product,
            _ => Level::Sign,
        };
        Self { text: format!("{} {sign} {}", self.within(level), other.within(right)), level }
    }

    /// The text as an operand that must bind at least this tightly.
    fn within(self, level: Level) -> String {
        if self.level < level { format!("({})", self.text) } else { self.text }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parentheses_stand_where_they_are_needed() {
        let [a, b, c] = ["a", "b", "c"].map(Expression::atom);
        let text = |expression: Expression| expression.text;
        assert_eq!(text(a.clone().plus(b.clone()).plus(c.clone())), "a + b + c");
        assert_eq!(text(a.clone().plus(b.clone().plus(c.clone()))), "a + (b + c)");
        assert_eq!(text(a.clone().minus(b.clone().minus(c.clone()))), "a - (b - c)");
        assert_eq!(text(a.clone().plus(b.clone()).times(c.clone())), "(a + b) * c");
        assert_eq!(text(a.clone().over(b.clone().times(c.clone()))), "a / (b * c)");
        assert_eq!(text(a.clone().negative().negative()), "-(-a)");
        assert_eq!(text(a.clone().minus(b.clone().negative())), "a - -b");
        assert_eq!(text(a.times(b).negative()), "-(a * b)");
        assert_eq!(text(Expression::number(-0.5, Precision::Single)), "-0.5f");
        assert_eq!(text(c.over(Expression::number(1e-20, Precision::Double))), "c / 1e-20");
    }
}
