//! States that an importer keeps, as pointers and as bytes; the same in both versions of the interface.

use std::ptr;

use super::unit::{Pointer, Unit};
use super::{array, array_mut};
use crate::instance::{Fault, SavedState};

fn no_state() -> Fault {
    Fault::Error("no state was given".to_owned())
}

/// Saves the state, replacing an earlier one if there is one.
///
/// # Safety
/// `state` is null, or there is a pointer at `state` that is null or points to a state that was made here.
pub(super) unsafe fn keep(unit: &Unit, state: *mut Pointer) -> Result<(), Fault> {
    // SAFETY: as the caller promises.
    let pointer = unsafe { state.as_mut() }.ok_or_else(no_state)?;
    // SAFETY: as the caller promises.
    match unsafe { pointer.cast::<SavedState>().as_mut() } {
        Some(kept) => *kept = unit.instance.state(),
        None => *pointer = Box::into_raw(Box::new(unit.instance.state())).cast(),
    }
    Ok(())
}

/// Restores a state.
///
/// # Safety
/// The state was made here, or is null.
pub(super) unsafe fn restore(unit: &mut Unit, state: Pointer) -> Result<(), Fault> {
    // SAFETY: as the caller promises.
    unit.instance.set_state(unsafe { state.cast::<SavedState>().as_ref() }.ok_or_else(no_state)?)?;
    unit.last = unit.instance.time();
    Ok(())
}

/// Frees a state.
///
/// # Safety
/// The state at `state` was made here, and is freed only once.
pub(super) unsafe fn free(state: *mut Pointer) {
    // SAFETY: as the caller promises.
    unsafe {
        if let Some(pointer) = state.as_mut().filter(|pointer| !pointer.is_null()) {
            drop(Box::from_raw(pointer.cast::<SavedState>()));
            *pointer = ptr::null_mut();
        }
    }
}

/// Writes how many bytes a state takes.
///
/// # Safety
/// The state was made here, or is null; there is room for a number at `size`, or it is null.
pub(super) unsafe fn measure(state: Pointer, size: *mut usize) -> Result<(), Fault> {
    // SAFETY: as the caller promises.
    let (state, size) = unsafe { (state.cast::<SavedState>().as_ref(), size.as_mut()) };
    *size.ok_or_else(no_state)? = state.ok_or_else(no_state)?.bytes().len();
    Ok(())
}

/// Writes a state as bytes.
///
/// # Safety
/// The state was made here, or is null; there is room for `size` bytes.
pub(super) unsafe fn to_bytes(state: Pointer, bytes: *mut u8, size: usize) -> Result<(), Fault> {
    // SAFETY: as the caller promises.
    let (state, bytes) =
        unsafe { (state.cast::<SavedState>().as_ref().ok_or_else(no_state)?, array_mut(bytes, size)?) };
    let saved = state.bytes();
    let Some(target) = bytes.get_mut(..saved.len()) else {
        return Err(Fault::Error(format!("{size} bytes are too few: the state takes {}", saved.len())));
    };
    target.copy_from_slice(&saved);
    Ok(())
}

/// Makes a state from bytes.
///
/// # Safety
/// There are `size` bytes; there is room for a pointer at `state`.
pub(super) unsafe fn from_bytes(unit: &Unit, bytes: *const u8, size: usize, state: *mut Pointer) -> Result<(), Fault> {
    // SAFETY: as the caller promises.
    let (bytes, pointer) = unsafe { (array(bytes, size)?, state.as_mut()) };
    let read = unit.instance.state_of(bytes);
    let read = read.ok_or_else(|| Fault::Error(format!("{size} bytes are not a state of this crane")))?;
    *pointer.ok_or_else(no_state)? = Box::into_raw(Box::new(read)).cast();
    Ok(())
}
