//! Work that the compiler has translated for several sets of vector instructions.
//!
//! Why a call is sound: each form runs only on processors that have its instructions.

#![allow(unsafe_code)]

/// Work with loops over numbers. What [`run`](Work::run) calls is to be inlined, as it is itself: else it is translated for the smallest set only.
pub trait Work {
    /// Does it.
    fn run(self);
}

/// Does work with the widest vectors of this processor: the same operations, with the same results.
#[cfg(target_arch = "x86_64")]
pub fn with_vectors(work: impl Work) {
    use std::arch::is_x86_feature_detected as has;

    #[target_feature(enable = "avx512f")]
    fn eight(work: impl Work) {
        work.run();
    }
    #[target_feature(enable = "avx2")]
    fn four(work: impl Work) {
        work.run();
    }
    if has!("avx512f") {
        // SAFETY: the processor has the instructions.
        unsafe { eight(work) }
    } else if has!("avx2") {
        // SAFETY: the processor has the instructions.
        unsafe { four(work) }
    } else {
        work.run();
    }
}

/// Does work.
#[cfg(not(target_arch = "x86_64"))]
pub fn with_vectors(work: impl Work) {
    work.run();
}
