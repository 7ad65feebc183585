//! Whole-system tests of the compiler and the runtime.
