//! The shared library of functional mock-up units of live cranes: the functions that `crane-fmu` exports to C.

crane_fmu::units!(crane_fmu::live);
