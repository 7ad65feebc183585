//! Functions that both versions of the interface have, under different names.

/// Functions of a component: each does its work on the unit and returns a status.
macro_rules! functions {
    ($($(#[$about:meta])* fn $name:ident($($argument:ident: $kind:ty),* $(,)?) |$unit:ident| $work:expr;)*) => {$(
        $(#[$about])*
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(component: $crate::abi::unit::Pointer, $($argument: $kind),*) -> $crate::abi::unit::Status {
            // SAFETY: as the FMI standard guarantees.
            unsafe { $crate::abi::unit::with(component, |$unit| $work) }
        }
    )*};
}
pub(super) use functions;

/// The functions that both versions have, by the names of one.
macro_rules! shared {
    (
        free: $free:ident,
        exit_initialisation: $exit_initialisation:ident,
        terminate: $terminate:ident,
        reset: $reset:ident,
        accept: [$($accept:ident),* $(,)?],
        get_state: $get_state:ident,
        set_state: $set_state:ident,
        free_state: $free_state:ident,
        state_size: $state_size:ident,
        serialise: $serialise:ident,
        deserialise: $deserialise:ident,
        set_time: $set_time:ident,
        set_states: $set_states:ident,
        get_states: $get_states:ident,
        derivatives: $derivatives:ident,
        indicators: $indicators:ident,
        nominals: $nominals:ident $(,)?
    ) => {
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $free(component: $crate::abi::unit::Pointer) {
            // SAFETY: as the FMI standard guarantees.
            unsafe { $crate::abi::unit::free(component) }
        }

        $crate::abi::shared::functions! {
            fn $exit_initialisation() |unit| unit.instance.start();
            fn $terminate() |unit| {
                unit.instance.end();
                Ok(())
            };
            fn $reset() |unit| {
                unit.instance.reset();
                unit.last = unit.instance.time();
                Ok(())
            };
            $(
                /// Requires no action: modes differ in what an importer may do, not in what the crane does.
                fn $accept() |_unit| Ok(());
            )*
            /// An existing state was made here, and is reused.
            fn $get_state(state: *mut Pointer) |unit| states::keep(unit, state);
            fn $set_state(state: Pointer) |unit| states::restore(unit, state);
            fn $free_state(state: *mut Pointer) |_unit| {
                states::free(state);
                Ok(())
            };
            fn $state_size(state: Pointer, size: *mut usize) |_unit| states::measure(state, size);
            fn $serialise(state: Pointer, bytes: *mut u8, size: usize) |_unit| states::to_bytes(state, bytes, size);
            fn $deserialise(bytes: *const u8, size: usize, state: *mut Pointer) |unit| {
                states::from_bytes(unit, bytes, size, state)
            };
            fn $set_time(time: c_double) |unit| unit.instance.set_time(time);
            fn $set_states(states: *const c_double, count: usize) |unit| {
                unit.instance.set_continuous_states(array(states, count)?)
            };
            fn $get_states(states: *mut c_double, count: usize) |unit| {
                unit.instance.continuous_states(array_mut(states, count)?)
            };
            fn $derivatives(derivatives: *mut c_double, count: usize) |unit| {
                unit.instance.derivatives(array_mut(derivatives, count)?)
            };
            fn $indicators(indicators: *mut c_double, count: usize) |unit| {
                unit.instance.event_indicators(array_mut(indicators, count)?)
            };
            /// Coordinates of a crane are some metres and about a radian, and so are their rates.
            fn $nominals(nominals: *mut c_double, count: usize) |_unit| {
                array_mut(nominals, count)?.fill(1.0);
                Ok(())
            };
        }
    };
}
pub(super) use shared;
