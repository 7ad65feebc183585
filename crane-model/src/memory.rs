//! What a motion remembers from step to step, number by number.
//!
//! Each part visits the numbers on which its further steps depend, and the visitor reads or replaces them: one list serves for saving and
//! for going on from what was saved.

/// Reads a number or replaces it.
pub type Visit<'a> = &'a mut dyn FnMut(&mut f64);

/// Longest list of flags or indices, against memory that was damaged.
const LONGEST: usize = 1 << 16;

/// Visits numbers.
pub fn visit_numbers(numbers: &mut [f64], visit: Visit<'_>) {
    numbers.iter_mut().for_each(visit);
}

/// Visits a count.
pub fn visit_count(count: &mut usize, visit: Visit<'_>) {
    let mut number = *count as f64;
    visit(&mut number);
    // Saturates if it is not a count.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let whole = number as usize;
    *count = whole;
}

/// Visits a flag.
pub fn visit_flag(flag: &mut bool, visit: Visit<'_>) {
    let mut number = f64::from(u8::from(*flag));
    visit(&mut number);
    *flag = number > 0.0;
}

/// Visits a number that may be missing.
pub fn visit_optional(number: &mut Option<f64>, visit: Visit<'_>) {
    let mut value = number.unwrap_or(f64::NAN);
    visit(&mut value);
    *number = Some(value).filter(|value| !value.is_nan());
}

/// Visits flags, whose number may change.
pub fn visit_flags(flags: &mut Vec<bool>, visit: Visit<'_>) {
    let mut count = flags.len();
    visit_count(&mut count, visit);
    flags.resize(count.min(LONGEST), false);
    for flag in flags {
        visit_flag(flag, visit);
    }
}

/// Visits indices below `end`, whose number may change.
pub fn visit_indices(indices: &mut Vec<usize>, end: usize, visit: Visit<'_>) {
    let mut count = indices.len();
    visit_count(&mut count, visit);
    indices.resize(count.min(end), 0);
    for index in indices {
        visit_count(index, visit);
        *index = (*index).min(end.saturating_sub(1));
    }
}
