//! The functions that the page calls: `room` makes room for a request, which the page writes into memory; `ask` answers it.
//!
//! `room(n)` returns the address of n bytes. `ask()` reads the request there, UTF-8, and returns the length of the answer, whose address is
//! `answer()`. A page has one engine, and a module one thread.

#![expect(unsafe_code, reason = "a name for a function outside of Rust counts as unsafe; there is no unsafe block")]

use std::cell::RefCell;

use crate::Engine;

/// A request, its answer, and what answers it.
#[derive(Default)]
struct Desk {
    request: Vec<u8>,
    answer: String,
    engine: Engine,
}

thread_local! {
    static DESK: RefCell<Desk> = RefCell::default();
}

/// Makes room for a request of some bytes, and returns its address.
#[unsafe(no_mangle)]
pub extern "C" fn room(bytes: usize) -> *const u8 {
    DESK.with_borrow_mut(|desk| {
        desk.request.clear();
        desk.request.resize(bytes, 0);
        desk.request.as_ptr()
    })
}

/// Answers the request, and returns the number of bytes of the answer.
#[unsafe(no_mangle)]
pub extern "C" fn ask() -> usize {
    DESK.with_borrow_mut(|desk| {
        desk.answer = desk.engine.answer(&desk.request);
        desk.answer.len()
    })
}

/// The address of the answer.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> *const u8 {
    DESK.with_borrow(|desk| desk.answer.as_ptr())
}
