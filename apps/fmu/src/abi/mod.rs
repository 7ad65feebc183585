//! The interface for C. Pointers of the importer are dereferenced here and nowhere else; no panic gets out.

#![allow(unsafe_code, non_snake_case)]

pub mod fmi2;
pub mod fmi3;
mod shared;
mod states;
mod unit;
mod units;

use std::any::Any;
use std::ffi::{CStr, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::slice;

use crate::instance::Fault;

/// Does the work of a call; a panic becomes an error with its message.
fn guarded<R>(work: impl FnOnce() -> Result<R, Fault>) -> Result<R, Fault> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| Err(Fault::Error(words_of(&*panic))))
}

fn words_of(panic: &(dyn Any + Send)) -> String {
    let words = panic.downcast_ref::<String>().map(String::as_str).or_else(|| panic.downcast_ref::<&str>().copied());
    format!("the crane's library has failed, please report it: {}", words.unwrap_or("no reason given"))
}

/// An array of the importer; null is refused unless it is empty.
///
/// # Safety
/// `first` is null, or `count` values are valid at `first` as long as the slice is used.
unsafe fn array<'a, T>(first: *const T, count: usize) -> Result<&'a [T], Fault> {
    match (count, first.is_null()) {
        (0, _) => Ok(&[]),
        (_, true) => Err(no_array(count)),
        // SAFETY: as the caller promises.
        _ => Ok(unsafe { slice::from_raw_parts(first, count) }),
    }
}

fn no_array(count: usize) -> Fault {
    Fault::Error(format!("no array was given for {count} values"))
}

/// An array of the importer to be written to; null is refused unless it is empty.
///
/// # Safety
/// `first` is null, or `count` values are valid at `first` and accessed by nobody else as long as the slice is used.
unsafe fn array_mut<'a, T>(first: *mut T, count: usize) -> Result<&'a mut [T], Fault> {
    match (count, first.is_null()) {
        (0, _) => Ok(&mut []),
        (_, true) => Err(no_array(count)),
        // SAFETY: as the caller promises.
        _ => Ok(unsafe { slice::from_raw_parts_mut(first, count) }),
    }
}

/// A text of the importer; empty if it is null or not UTF-8.
///
/// # Safety
/// `text` is null, or ends with a zero and stays valid as long as it is used.
unsafe fn words<'a>(text: *const c_char) -> &'a str {
    if text.is_null() {
        return "";
    }
    // SAFETY: as the caller promises.
    unsafe { CStr::from_ptr(text) }.to_str().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_an_error() {
        let outcome: Result<(), Fault> = guarded(|| panic!("no column {}", 7));
        let Err(Fault::Error(words)) = outcome else { panic!("an error is expected") };
        assert!(words.ends_with("no column 7"), "{words}");
    }
}
