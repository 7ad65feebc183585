//! What a number measures: its unit and its limit, which stand at its key and nowhere else.

/// The unit and the limit of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Measure {
    /// The unit: `N/m`; `1` without one; `N m/rad or N/m` of a joint that turns or slides; `m, m, rad` of the items of a list; `…` that of
    /// the key to which the mapping belongs, `…/s` that per second; or `its own`, which the spec names.
    pub unit: &'static str,
    pub limit: Limit,
    /// The range of its magnitude, unless it is zero, beyond which its unit or its exponent is probably wrong.
    pub usual: [f64; 2],
    /// Those of the items of a list whose units differ.
    pub items: &'static [Measure],
}

/// The allowed range of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Limit {
    /// Any finite number.
    Any,
    /// Not negative.
    NotNegative,
    /// Above zero.
    Positive,
    /// Above zero; a live mass may be zero if the mass matrix stays regular without it.
    Mass,
    /// Not negative; a live one as [`Limit::Mass`].
    MassOfMoments,
    /// A whole number from 1 to this one.
    Whole(u32),
}

impl Measure {
    /// Every magnitude is usual.
    pub const ALL: [f64; 2] = [0.0, f64::INFINITY];
    /// Of a key without a number.
    pub const NONE: Self = Measure { unit: "", limit: Limit::Any, usual: Self::ALL, items: &[] };
    /// That of the key to which the mapping belongs.
    pub const INHERITED: Self = Measure { unit: "…", ..Self::NONE };

    /// Where it is that of the owner, this.
    pub fn within(&'static self, owner: &'static Self) -> &'static Self {
        if self.unit.starts_with('…') { owner } else { self }
    }

    /// That of an item of a list.
    pub fn of_item(&'static self, index: usize) -> &'static Self {
        self.items.get(index).unwrap_or(self)
    }

    /// In words, for descriptions of keys.
    pub fn describe(&self) -> String {
        let unit = match self.unit {
            "" | "…" | "…/s" => return String::new(),
            "1" => "Without unit",
            unit => &format!("In {unit}"),
        };
        let limit = match self.limit {
            Limit::Any => "",
            Limit::NotNegative | Limit::MassOfMoments => ", not negative",
            Limit::Positive | Limit::Mass => ", above 0",
            Limit::Whole(most) => &format!(", a whole number from 1 to {most}"),
        };
        format!("{unit}{limit}.")
    }
}
