//! The functions of C that create a crane: those that must know which crane it is.

/// Makes a shared library of functional mock-up units out of a crate: exports the functions that create a crane, by a
/// [`Make`](crate::Make), and with them all others.
#[macro_export]
macro_rules! units {
    ($make:expr) => {
        #[unsafe(no_mangle)]
        unsafe extern "C" fn fmi2Instantiate(
            name: *const ::std::ffi::c_char,
            _kind: ::std::ffi::c_int,
            guid: *const ::std::ffi::c_char,
            resources: *const ::std::ffi::c_char,
            callbacks: *const $crate::abi::fmi2::Callbacks,
            _visible: ::std::ffi::c_int,
            logs: ::std::ffi::c_int,
        ) -> *mut ::std::ffi::c_void {
            // SAFETY: as the standard has it.
            unsafe { $crate::abi::fmi2::instantiate($make, name, guid, resources, callbacks, logs) }
        }

        #[unsafe(no_mangle)]
        unsafe extern "C" fn fmi3InstantiateModelExchange(
            _name: *const ::std::ffi::c_char,
            token: *const ::std::ffi::c_char,
            resources: *const ::std::ffi::c_char,
            _visible: u8,
            logs: u8,
            environment: *mut ::std::ffi::c_void,
            log: ::std::option::Option<$crate::abi::fmi3::LogMessage>,
        ) -> *mut ::std::ffi::c_void {
            // SAFETY: as the standard has it.
            unsafe { $crate::abi::fmi3::instantiate($make, token, resources, logs, environment, log) }
        }

        #[unsafe(no_mangle)]
        unsafe extern "C" fn fmi3InstantiateCoSimulation(
            _name: *const ::std::ffi::c_char,
            token: *const ::std::ffi::c_char,
            resources: *const ::std::ffi::c_char,
            _visible: u8,
            logs: u8,
            _event_mode_used: u8,
            _early_return_allowed: u8,
            _intermediate: *const ::std::ffi::c_uint,
            _intermediate_count: usize,
            environment: *mut ::std::ffi::c_void,
            log: ::std::option::Option<$crate::abi::fmi3::LogMessage>,
            _intermediate_update: *const ::std::ffi::c_void,
        ) -> *mut ::std::ffi::c_void {
            // SAFETY: as the standard has it.
            unsafe { $crate::abi::fmi3::instantiate($make, token, resources, logs, environment, log) }
        }
    };
}
