//! An instance as both versions of the interface see it: what an importer's pointer points to, and where messages go.

use std::ffi::c_void;
use std::path::PathBuf;
use std::ptr;

use super::guarded;
use crate::instance::{Fault, Instance};

/// A pointer of the importer to something that was made here.
pub(super) type Pointer = *mut c_void;

/// `fmi2Status` and `fmi3Status`.
#[repr(C)]
#[derive(Clone, Copy)]
pub(super) enum Status {
    Ok = 0,
    Warning = 1,
    Discard = 2,
    Error = 3,
}

/// What a component points to.
pub(super) struct Unit {
    pub(super) instance: Instance,
    pub(super) host: Host,
    /// Time of the last step that was done, s.
    pub(super) last: f64,
}

impl Unit {
    /// A new instance for the importer; null, with a message, if it cannot be made.
    pub(super) fn make(folder: Result<PathBuf, String>, token: &str, host: Host) -> Pointer {
        let made = guarded(|| {
            let folder = folder.map_err(Fault::Error)?;
            Instance::new(&folder, token).map_err(Fault::Error)
        });
        match made {
            Ok(mut instance) => {
                host.warn(&instance.take_warnings());
                Box::into_raw(Box::new(Unit { instance, host, last: 0.0 })).cast()
            }
            Err(fault) => {
                host.fail(&fault);
                ptr::null_mut()
            }
        }
    }
}

/// Says a text of a category.
pub(super) type Logger = Box<dyn Fn(Status, &str, &str)>;

/// Where messages go.
pub(super) struct Host {
    pub(super) say: Logger,
    /// Whether warnings are wanted; errors always are.
    pub(super) logs: bool,
}

impl Host {
    fn warn(&self, warnings: &[String]) {
        for warning in warnings.iter().filter(|_| self.logs) {
            (self.say)(Status::Warning, "logStatusWarning", warning);
        }
    }

    fn fail(&self, fault: &Fault) -> Status {
        let status = match fault {
            Fault::Discard(_) => Status::Discard,
            Fault::Error(_) => Status::Error,
        };
        (self.say)(status, "logStatusError", &fault.to_string());
        status
    }
}

/// Does some work on a component, and says what there is to say.
///
/// # Safety
/// The component is one that [`Unit::make`] has returned and [`free`] has not taken back; no other call is at it.
pub(super) unsafe fn with(component: Pointer, work: impl FnOnce(&mut Unit) -> Result<(), Fault>) -> Status {
    // SAFETY: as the caller promises.
    let Some(unit) = (unsafe { component.cast::<Unit>().as_mut() }) else { return Status::Error };
    let done = guarded(|| work(&mut *unit));
    unit.host.warn(&unit.instance.take_warnings());
    match done {
        Ok(()) => Status::Ok,
        Err(fault) => unit.host.fail(&fault),
    }
}

/// Takes a component back.
///
/// # Safety
/// The component was made by [`Unit::make`], and is given back once; or it is null.
pub(super) unsafe fn free(component: Pointer) {
    if !component.is_null() {
        // SAFETY: as the caller promises.
        drop(unsafe { Box::from_raw(component.cast::<Unit>()) });
    }
}

/// Writes to a place of the importer, if there is one.
///
/// # Safety
/// There is room for a value at `place`, which nobody else looks at; or it is null.
pub(super) unsafe fn write<T>(place: *mut T, value: T) {
    // SAFETY: as the caller promises.
    if let Some(place) = unsafe { place.as_mut() } {
        *place = value;
    }
}

/// Variables of a type that a crane does not have.
pub(super) fn none_of(count: usize, kind: &str, own: &str) -> Result<(), Fault> {
    if count == 0 {
        Ok(())
    } else {
        Err(Fault::Error(format!("a crane has no variables of type {kind}: all are {own}")))
    }
}
