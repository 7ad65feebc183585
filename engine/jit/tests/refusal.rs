//! A system that refuses to execute memory that was written: there is no code, and no error. The refusal is for the rest of the
//! process, so it has a process of its own.

#![cfg(target_os = "linux")]
#![allow(unsafe_code)]

use crane_jit::{Code, Rounding, Step, StraightLine, Width};

/// prctl(2), since Linux 6.3.
const SET_MEMORY_DENY_WRITE_EXECUTE: libc::c_int = 65;
/// No memory becomes executable.
const REFUSE_EXECUTION: libc::c_ulong = 1;

#[test]
fn refused_memory_is_no_code() {
    let product = Step::MulAdd([0, 1, 2]);
    let line = StraightLine {
        given: vec![None, None, Some(-0.0)],
        steps: vec![product, Step::Store { place: 0, value: 3 }],
        results: 1,
    };
    let has_code = || Code::compile(&line, Rounding::Separate, Width::One).is_some();
    if !has_code() {
        println!("no code for this processor");
        return;
    }
    let nothing: libc::c_ulong = 0;
    // SAFETY: it reads its arguments, and changes what this process may do, no memory.
    let answer = unsafe { libc::prctl(SET_MEMORY_DENY_WRITE_EXECUTE, REFUSE_EXECUTION, nothing, nothing, nothing) };
    if answer != 0 {
        println!("this system cannot refuse: {}", std::io::Error::last_os_error());
        return;
    }
    assert!(!has_code(), "the system refuses");
}
