//! The functions of FMI 3.0.2, in the order of its headers.

use std::ffi::{CString, c_char, c_double, c_int, c_uint, c_void};
use std::path::PathBuf;
use std::ptr;
use std::rc::Rc;

use super::shared::shared;
use super::unit::{Host, Pointer, Status, Unit, none_of, with, write};
use super::{array, array_mut, states, words};
use crate::Make;
use crate::instance::{Fault, Instance};

type Component = Pointer;
/// `bool` of C; any number but 0 counts as true.
type Boolean = u8;
/// `fmi3LogMessageCallback`.
pub type LogMessage = unsafe extern "C" fn(*mut c_void, Status, *const c_char, *const c_char);

const TRUE: Boolean = 1;
const FALSE: Boolean = 0;

#[unsafe(no_mangle)]
extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetDebugLogging(
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

/// Messages to the importer.
fn host(environment: *mut c_void, log: Option<LogMessage>, logs: Boolean) -> Host {
    let say = move |status, category: &str, text: &str| {
        let Some(log) = log else { return };
        if let (Ok(category), Ok(text)) = (CString::new(category), CString::new(text.replace('\0', " "))) {
            // SAFETY: the importer's function takes these types.
            unsafe { log(environment, status, category.as_ptr(), text.as_ptr()) }
        }
    };
    Host { say: Rc::new(say), logs: logs != FALSE }
}

/// The folder of the resources: in FMI 3.0 a path.
fn folder(path: &str) -> Result<PathBuf, String> {
    if path.is_empty() { Err("the importer gives no folder of resources".to_owned()) } else { Ok(PathBuf::from(path)) }
}

/// `fmi3InstantiateModelExchange` and `fmi3InstantiateCoSimulation`, which [`units!`](crate::units) exports.
///
/// # Safety
/// The caller keeps the contract of this function in the FMI standard: which pointers are valid, and for how many values.
pub unsafe fn instantiate(
    make: Make,
    token: *const c_char,
    resources: *const c_char,
    logs: Boolean,
    environment: *mut c_void,
    log: Option<LogMessage>,
) -> Component {
    // SAFETY: texts are valid, as the FMI standard guarantees.
    let (token, path) = unsafe { (words(token), words(resources)) };
    Unit::make(make, folder(path), token, host(environment, log, logs))
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3InstantiateScheduledExecution(
    _name: *const c_char,
    _token: *const c_char,
    _resources: *const c_char,
    _visible: Boolean,
    logs: Boolean,
    environment: *mut c_void,
    log: Option<LogMessage>,
    _clock_update: *const c_void,
    _lock: *const c_void,
    _unlock: *const c_void,
) -> Component {
    let text = "a crane has no clocks and cannot be scheduled: use it for co-simulation or model exchange";
    (host(environment, log, logs).say)(Status::Error, "logStatusError", text);
    ptr::null_mut()
}

shared! {
    free: fmi3FreeInstance,
    exit_initialisation: fmi3ExitInitializationMode,
    terminate: fmi3Terminate,
    reset: fmi3Reset,
    accept: [
        fmi3EnterEventMode,
        fmi3EnterConfigurationMode,
        fmi3ExitConfigurationMode,
        fmi3EvaluateDiscreteStates,
        fmi3EnterContinuousTimeMode,
        fmi3EnterStepMode,
    ],
    get_state: fmi3GetFMUState,
    set_state: fmi3SetFMUState,
    free_state: fmi3FreeFMUState,
    state_size: fmi3SerializedFMUStateSize,
    serialise: fmi3SerializeFMUState,
    deserialise: fmi3DeserializeFMUState,
    set_time: fmi3SetTime,
    set_states: fmi3SetContinuousStates,
    get_states: fmi3GetContinuousStates,
    derivatives: fmi3GetContinuousStateDerivatives,
    indicators: fmi3GetEventIndicators,
    nominals: fmi3GetNominalsOfContinuousStates,
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3EnterInitializationMode(
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
            unit.instance.initialise()
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetFloat64(
    component: Component,
    references: *const c_uint,
    count: usize,
    values: *mut c_double,
    value_count: usize,
) -> Status {
    // SAFETY: as the FMI standard guarantees.
    unsafe {
        with(component, |unit| {
            as_many(count, value_count)?;
            unit.instance.get(array(references, count)?, array_mut(values, count)?)
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetFloat64(
    component: Component,
    references: *const c_uint,
    count: usize,
    values: *const c_double,
    value_count: usize,
) -> Status {
    // SAFETY: as the FMI standard guarantees.
    unsafe {
        with(component, |unit| {
            as_many(count, value_count)?;
            unit.instance.set(array(references, count)?, array(values, count)?)
        })
    }
}

/// As many values as variables: these are numbers, not arrays.
fn as_many(count: usize, value_count: usize) -> Result<(), Fault> {
    if count == value_count {
        Ok(())
    } else {
        Err(Fault::Error(format!("{value_count} values for {count} variables: a crane has no arrays")))
    }
}

/// Reading and writing variables of types that a crane does not have.
macro_rules! no_variables {
    ($($name:ident: ($($value:ty),+), $kind:literal;)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(component: Component, _: *const c_uint, count: usize, $(_: $value),+) -> Status {
            // SAFETY: as the FMI standard guarantees.
            unsafe { with(component, |_| none_of(count, $kind, "Float64")) }
        }
    )*};
}

no_variables! {
    fmi3GetFloat32: (*mut f32, usize), "Float32";
    fmi3GetInt8: (*mut i8, usize), "Int8";
    fmi3GetUInt8: (*mut u8, usize), "UInt8";
    fmi3GetInt16: (*mut i16, usize), "Int16";
    fmi3GetUInt16: (*mut u16, usize), "UInt16";
    fmi3GetInt32: (*mut i32, usize), "Int32";
    fmi3GetUInt32: (*mut u32, usize), "UInt32";
    fmi3GetInt64: (*mut i64, usize), "Int64";
    fmi3GetUInt64: (*mut u64, usize), "UInt64";
    fmi3GetBoolean: (*mut Boolean, usize), "Boolean";
    fmi3GetString: (*mut *const c_char, usize), "String";
    fmi3GetBinary: (*mut usize, *mut *const u8, usize), "Binary";
    fmi3GetClock: (*mut Boolean), "Clock";
    fmi3SetFloat32: (*const f32, usize), "Float32";
    fmi3SetInt8: (*const i8, usize), "Int8";
    fmi3SetUInt8: (*const u8, usize), "UInt8";
    fmi3SetInt16: (*const i16, usize), "Int16";
    fmi3SetUInt16: (*const u16, usize), "UInt16";
    fmi3SetInt32: (*const i32, usize), "Int32";
    fmi3SetUInt32: (*const u32, usize), "UInt32";
    fmi3SetInt64: (*const i64, usize), "Int64";
    fmi3SetUInt64: (*const u64, usize), "UInt64";
    fmi3SetBoolean: (*const Boolean, usize), "Boolean";
    fmi3SetString: (*const *const c_char, usize), "String";
    fmi3SetBinary: (*const usize, *const *const u8, usize), "Binary";
    fmi3SetClock: (*const Boolean), "Clock";
    fmi3GetIntervalDecimal: (*mut c_double, *mut c_int), "Clock";
    fmi3GetIntervalFraction: (*mut u64, *mut u64, *mut c_int), "Clock";
    fmi3GetShiftDecimal: (*mut c_double), "Clock";
    fmi3GetShiftFraction: (*mut u64, *mut u64), "Clock";
    fmi3SetIntervalDecimal: (*const c_double), "Clock";
    fmi3SetIntervalFraction: (*const u64, *const u64), "Clock";
    fmi3SetShiftDecimal: (*const c_double), "Clock";
    fmi3SetShiftFraction: (*const u64, *const u64), "Clock";
}

/// Dependencies are not listed: every variable may depend on all others.
#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetNumberOfVariableDependencies(
    component: Component,
    _reference: c_uint,
    _count: *mut usize,
) -> Status {
    // SAFETY: as the FMI standard guarantees.
    unsafe { with(component, |_| Err(no_dependencies())) }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetVariableDependencies(
    component: Component,
    _reference: c_uint,
    _elements: *mut usize,
    _independents: *mut c_uint,
    _elements_of_independents: *mut usize,
    _kinds: *mut c_int,
    _count: usize,
) -> Status {
    // SAFETY: as the FMI standard guarantees.
    unsafe { with(component, |_| Err(no_dependencies())) }
}

fn no_dependencies() -> Fault {
    Fault::Error("a crane does not list dependencies: every variable may depend on all others".to_owned())
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetDirectionalDerivative(
    component: Component,
    unknowns: *const c_uint,
    unknown_count: usize,
    knowns: *const c_uint,
    known_count: usize,
    seed: *const c_double,
    seed_count: usize,
    sensitivity: *mut c_double,
    sensitivity_count: usize,
) -> Status {
    // SAFETY: as the FMI standard guarantees.
    unsafe {
        with(component, |unit| {
            as_many(known_count, seed_count)?;
            as_many(unknown_count, sensitivity_count)?;
            unit.instance.directional_derivative(
                array(unknowns, unknown_count)?,
                array(knowns, known_count)?,
                array(seed, known_count)?,
                array_mut(sensitivity, unknown_count)?,
            )
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetAdjointDerivative(
    component: Component,
    unknowns: *const c_uint,
    unknown_count: usize,
    knowns: *const c_uint,
    known_count: usize,
    seed: *const c_double,
    seed_count: usize,
    sensitivity: *mut c_double,
    sensitivity_count: usize,
) -> Status {
    // SAFETY: as the FMI standard guarantees.
    unsafe {
        with(component, |unit| {
            as_many(unknown_count, seed_count)?;
            as_many(known_count, sensitivity_count)?;
            unit.instance.adjoint_derivative(
                array(unknowns, unknown_count)?,
                array(knowns, known_count)?,
                array(seed, unknown_count)?,
                array_mut(sensitivity, known_count)?,
            )
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3UpdateDiscreteStates(
    component: Component,
    update_needed: *mut Boolean,
    terminate: *mut Boolean,
    nominals_changed: *mut Boolean,
    values_changed: *mut Boolean,
    next_event_time_defined: *mut Boolean,
    next_event_time: *mut c_double,
) -> Status {
    // SAFETY: as the FMI standard guarantees.
    unsafe {
        with(component, |unit| {
            let changed = unit.instance.update()?;
            let next = unit.instance.next_event()?;
            for flag in [update_needed, terminate, nominals_changed] {
                write(flag, FALSE);
            }
            write(values_changed, if changed { TRUE } else { FALSE });
            write(next_event_time_defined, if next.is_some() { TRUE } else { FALSE });
            write(next_event_time, next.unwrap_or(0.0));
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3CompletedIntegratorStep(
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

/// Counts that an importer asks for.
macro_rules! counts {
    ($($name:ident: $count:expr;)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(component: Component, count: *mut usize) -> Status {
            let counted: fn(&Instance) -> usize = $count;
            // SAFETY: as the FMI standard guarantees.
            unsafe {
                with(component, |unit| {
                    write(count, counted(&unit.instance));
                    Ok(())
                })
            }
        }
    )*};
}

counts! {
    fmi3GetNumberOfEventIndicators: Instance::indicators;
    fmi3GetNumberOfContinuousStates: Instance::states;
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetOutputDerivatives(
    component: Component,
    _references: *const c_uint,
    count: usize,
    _orders: *const i32,
    _values: *mut c_double,
    _value_count: usize,
) -> Status {
    // SAFETY: as the FMI standard guarantees.
    unsafe {
        with(component, |_| match count {
            0 => Ok(()),
            _ => Err(Fault::Error("a crane does not support derivatives of outputs".to_owned())),
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3DoStep(
    component: Component,
    from: c_double,
    length: c_double,
    _keep: Boolean,
    event_handling_needed: *mut Boolean,
    terminate: *mut Boolean,
    early_return: *mut Boolean,
    last: *mut c_double,
) -> Status {
    // SAFETY: as the FMI standard guarantees.
    unsafe {
        with(component, |unit| {
            for flag in [event_handling_needed, terminate, early_return] {
                write(flag, FALSE);
            }
            write(last, unit.last);
            unit.instance.step(from, length)?;
            unit.last = unit.instance.time();
            write(last, unit.last);
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3ActivateModelPartition(component: Component, _clock: c_uint, _time: c_double) -> Status {
    // SAFETY: as the FMI standard guarantees.
    unsafe { with(component, |_| Err(Fault::Error("a crane has no clocks".to_owned()))) }
}
