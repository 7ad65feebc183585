//! An instance as both versions of the interface see it: what an importer's pointer points to, and where messages go.

use std::ffi::c_void;
use std::path::PathBuf;
use std::ptr;
use std::rc::Rc;

use super::guarded;
use crate::Make;
use crate::instance::{Fault, Instance};

/// An opaque pointer handed to the importer.
pub(super) type Pointer = *mut c_void;

/// `fmi2Status` and `fmi3Status`.
#[repr(C)]
#[derive(Clone, Copy)]
pub enum Status {
    Ok = 0,
    Warning = 1,
    Discard = 2,
    Error = 3,
}

/// What the importer's component pointer points to.
pub(super) struct Unit {
    pub(super) instance: Instance,
    pub(super) host: Host,
    /// Time reached by the last successful step, s.
    pub(super) last: f64,
}

impl Unit {
    /// A new instance for the importer; null, with a message, if it cannot be made.
    pub(super) fn make(make: Make, folder: Result<PathBuf, String>, token: &str, host: Host) -> Pointer {
        let made = guarded(|| {
            let folder = folder.map_err(Fault::Error)?;
            Instance::new(&folder, token, make).map_err(Fault::Error)
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

/// Reports a message: status, category and text.
pub(super) type Logger = Rc<dyn Fn(Status, &str, &str)>;

/// Where messages go.
#[derive(Clone)]
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

/// Runs `work` on a component and reports its warnings and errors, after it has let go of the component: the importer's logger may call
/// functions of the same component.
///
/// # Safety
/// The component was returned by [`Unit::make`] and has not been passed to [`free`]; no other call is using it.
pub(super) unsafe fn with(component: Pointer, work: impl FnOnce(&mut Unit) -> Result<(), Fault>) -> Status {
    let (done, warnings, host) = {
        // SAFETY: as the caller promises.
        let Some(unit) = (unsafe { component.cast::<Unit>().as_mut() }) else { return Status::Error };
        let done = guarded(|| work(&mut *unit));
        (done, unit.instance.take_warnings(), unit.host.clone())
    };
    host.warn(&warnings);
    match done {
        Ok(()) => Status::Ok,
        Err(fault) => host.fail(&fault),
    }
}

/// Frees a component.
///
/// # Safety
/// The component was made by [`Unit::make`] and is freed only once; or it is null.
pub(super) unsafe fn free(component: Pointer) {
    if !component.is_null() {
        // SAFETY: as the caller promises.
        drop(unsafe { Box::from_raw(component.cast::<Unit>()) });
    }
}

/// Writes a value to memory of the importer, unless the pointer is null.
///
/// # Safety
/// `target` points to memory for one value that nothing else accesses meanwhile; or it is null.
pub(super) unsafe fn write<T>(target: *mut T, value: T) {
    // SAFETY: as the caller promises.
    if let Some(target) = unsafe { target.as_mut() } {
        *target = value;
    }
}

/// Refuses a request for variables of a type that a crane does not have.
pub(super) fn none_of(count: usize, kind: &str, only: &str) -> Result<(), Fault> {
    if count == 0 {
        Ok(())
    } else {
        Err(Fault::Error(format!("a crane has no variables of type {kind}: all are {only}")))
    }
}
