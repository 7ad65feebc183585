//! The functions of FMI 2.0.3, in the order of its headers.

use std::ffi::{CString, c_char, c_double, c_int, c_uint, c_void};
use std::rc::Rc;

use super::shared::{functions, shared};
use super::unit::{Host, Pointer, Status, Unit, none_of, with, write};
use super::{array, array_mut, states, words};
use crate::instance::Fault;
use crate::{Make, resources};

type Component = Pointer;
type Boolean = c_int;
type Logger = unsafe extern "C" fn(*mut c_void, *const c_char, Status, *const c_char, *const c_char, ...);

const TRUE: Boolean = 1;
const FALSE: Boolean = 0;

/// `fmi2CallbackFunctions`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Callbacks {
    logger: Option<Logger>,
    allocate: *const c_void,
    free: *const c_void,
    step_finished: *const c_void,
    environment: *mut c_void,
}

/// `fmi2EventInfo`.
#[repr(C)]
struct EventInfo {
    new_discrete_states_needed: Boolean,
    terminate_simulation: Boolean,
    nominals_changed: Boolean,
    values_changed: Boolean,
    next_event_time_defined: Boolean,
    next_event_time: c_double,
}

/// Messages to the importer.
fn host(callbacks: Option<Callbacks>, name: &str, logs: bool) -> Host {
    let name = CString::new(name).unwrap_or_default();
    let say = move |status, category: &str, text: &str| {
        let Some(Callbacks { logger: Some(logger), environment, .. }) = callbacks else { return };
        // The importer uses the text as a format string of C.
        let text = text.replace('\0', " ").replace('%', "%%");
        if let (Ok(category), Ok(text)) = (CString::new(category), CString::new(text)) {
            // SAFETY: the importer's logger takes these types and a format that asks for no further arguments.
            unsafe { logger(environment, name.as_ptr(), status, category.as_ptr(), text.as_ptr()) }
        }
    };
    Host { say: Rc::new(say), logs }
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetDebugLogging(
    component: Component,
    on: Boolean,
    _count: usize,
    _categories: *const *const c_char,
) -> Status {
    // SAFETY: as the FMI standard guarantees.
    unsafe {
        with(component, |unit| {
            unit.host.logs = on != FALSE;
            Ok(())
        })
    }
}

/// `fmi2Instantiate`, which [`units!`](crate::units) exports.
///
/// # Safety
/// The caller keeps the contract of this function in the FMI standard: which pointers are valid, and for how many values.
pub unsafe fn instantiate(
    make: Make,
    name: *const c_char,
    guid: *const c_char,
    resources: *const c_char,
    callbacks: *const Callbacks,
    logs: Boolean,
) -> Component {
    // SAFETY: texts and callbacks are valid, as the FMI standard guarantees.
    let (name, guid, uri, callbacks) =
        unsafe { (words(name), words(guid), words(resources), callbacks.as_ref().copied()) };
    Unit::make(make, resources::folder_of(uri), guid, host(callbacks, name, logs != FALSE))
}

shared! {
    free: fmi2FreeInstance,
    exit_initialisation: fmi2ExitInitializationMode,
    terminate: fmi2Terminate,
    reset: fmi2Reset,
    accept: [
        fmi2EnterEventMode,
        fmi2EnterContinuousTimeMode,
    ],
    get_state: fmi2GetFMUstate,
    set_state: fmi2SetFMUstate,
    free_state: fmi2FreeFMUstate,
    state_size: fmi2SerializedFMUstateSize,
    serialise: fmi2SerializeFMUstate,
    deserialise: fmi2DeSerializeFMUstate,
    set_time: fmi2SetTime,
    set_states: fmi2SetContinuousStates,
    get_states: fmi2GetContinuousStates,
    derivatives: fmi2GetDerivatives,
    indicators: fmi2GetEventIndicators,
    nominals: fmi2GetNominalsOfContinuousStates,
}

functions! {
    fn fmi2EnterInitializationMode() |unit| unit.instance.initialise();
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetupExperiment(
    component: Component,
    has_tolerance: Boolean,
    tolerance: c_double,
    start: c_double,
    _has_stop: Boolean,
    _stop: c_double,
) -> Status {
    // SAFETY: as the FMI standard guarantees.
    unsafe {
        with(component, |unit| {
            unit.instance.set_up((has_tolerance != FALSE).then_some(tolerance), start)?;
            unit.last = start;
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetReal(
    component: Component,
    references: *const c_uint,
    count: usize,
    values: *mut c_double,
) -> Status {
    // SAFETY: as the FMI standard guarantees.
    unsafe { with(component, |unit| unit.instance.get(array(references, count)?, array_mut(values, count)?)) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetReal(
    component: Component,
    references: *const c_uint,
    count: usize,
    values: *const c_double,
) -> Status {
    // SAFETY: as the FMI standard guarantees.
    unsafe { with(component, |unit| unit.instance.set(array(references, count)?, array(values, count)?)) }
}

/// Reading and writing variables of types that a crane does not have.
macro_rules! no_variables {
    ($($name:ident: $value:ty, $kind:literal;)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(component: Component, _: *const c_uint, count: usize, _: $value) -> Status {
            // SAFETY: as the FMI standard guarantees.
            unsafe { with(component, |_| none_of(count, $kind, "Real")) }
        }
    )*};
}

no_variables! {
    fmi2GetInteger: *mut c_int, "Integer";
    fmi2GetBoolean: *mut Boolean, "Boolean";
    fmi2GetString: *mut *const c_char, "String";
    fmi2SetInteger: *const c_int, "Integer";
    fmi2SetBoolean: *const Boolean, "Boolean";
    fmi2SetString: *const *const c_char, "String";
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetDirectionalDerivative(
    component: Component,
    unknowns: *const c_uint,
    unknown_count: usize,
    knowns: *const c_uint,
    known_count: usize,
    direction: *const c_double,
    derivative: *mut c_double,
) -> Status {
    // SAFETY: as the FMI standard guarantees.
    unsafe {
        with(component, |unit| {
            unit.instance.directional_derivative(
                array(unknowns, unknown_count)?,
                array(knowns, known_count)?,
                array(direction, known_count)?,
                array_mut(derivative, unknown_count)?,
            )
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2NewDiscreteStates(component: Component, info: *mut EventInfo) -> Status {
    // SAFETY: as the FMI standard guarantees.
    unsafe {
        with(component, |unit| {
            let changed = unit.instance.update()?;
            let next = unit.instance.next_event()?;
            let found = EventInfo {
                new_discrete_states_needed: FALSE,
                terminate_simulation: FALSE,
                nominals_changed: FALSE,
                values_changed: if changed { TRUE } else { FALSE },
                next_event_time_defined: if next.is_some() { TRUE } else { FALSE },
                next_event_time: next.unwrap_or(0.0),
            };
            write(info, found);
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2CompletedIntegratorStep(
    component: Component,
    _keep: Boolean,
    enter_event_mode: *mut Boolean,
    terminate: *mut Boolean,
) -> Status {
    // SAFETY: as the FMI standard guarantees.
    unsafe {
        with(component, |_| {
            write(enter_event_mode, FALSE);
            write(terminate, FALSE);
            Ok(())
        })
    }
}

/// Derivatives of inputs and outputs with respect to time, which a crane does not offer.
macro_rules! no_time_derivatives {
    ($($name:ident: $value:ty;)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(
            component: Component,
            _references: *const c_uint,
            count: usize,
            _orders: *const c_int,
            _values: $value,
        ) -> Status {
            // SAFETY: as the FMI standard guarantees.
            unsafe {
                with(component, |_| match count {
                    0 => Ok(()),
                    _ => Err(Fault::Error("a crane does not support derivatives of inputs and outputs".to_owned())),
                })
            }
        }
    )*};
}

no_time_derivatives! {
    fmi2SetRealInputDerivatives: *const c_double;
    fmi2GetRealOutputDerivatives: *mut c_double;
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2DoStep(component: Component, from: c_double, length: c_double, _keep: Boolean) -> Status {
    // SAFETY: as the FMI standard guarantees.
    unsafe {
        with(component, |unit| {
            unit.instance.step(from, length)?;
            unit.last = unit.instance.time();
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2CancelStep(component: Component) -> Status {
    // SAFETY: as the FMI standard guarantees.
    unsafe {
        with(component, |_| {
            Err(Fault::Error("there is no step under way: a call returns when its step is done".to_owned()))
        })
    }
}

/// `fmi2LastSuccessfulTime`.
const LAST_SUCCESSFUL_TIME: c_int = 2;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetRealStatus(component: Component, kind: c_int, value: *mut c_double) -> Status {
    // SAFETY: as the FMI standard guarantees.
    unsafe {
        with(component, |unit| match value.as_mut() {
            Some(time) if kind == LAST_SUCCESSFUL_TIME => {
                *time = unit.last;
                Ok(())
            }
            _ => Err(nothing_pending()),
        })
    }
}

fn nothing_pending() -> Fault {
    Fault::Discard("no step is pending: a call returns when its step is done".to_owned())
}

/// Queries about a step that is still under way: there is none.
macro_rules! no_status {
    ($($name:ident: $value:ty;)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(component: Component, _: c_int, _: $value) -> Status {
            // SAFETY: as the FMI standard guarantees.
            unsafe { with(component, |_| Err(nothing_pending())) }
        }
    )*};
}

no_status! {
    fmi2GetStatus: *mut c_int;
    fmi2GetIntegerStatus: *mut c_int;
    fmi2GetStringStatus: *mut *const c_char;
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetBooleanStatus(component: Component, _: c_int, value: *mut Boolean) -> Status {
    // SAFETY: as the FMI standard guarantees.
    unsafe {
        with(component, |_| {
            // `fmi2Terminated`, the only status of this type: no step requests termination.
            write(value, FALSE);
            Ok(())
        })
    }
}
