//! Code in memory, and calls of it.
//!
//! Why a call is sound: `Code::compile` asks for code only on processors that have its instructions. `encode` translates
//! [`Instruction`]s one by one, gives back the registers that a call must keep, and returns; the only memory that the code reads or
//! writes besides is at the places that instructions name, in the frame and among the results. [`Functions::new`] counts both,
//! through all iterations of loops, and refuses what displacements do not reach; [`Functions::call`] compares them with the slices
//! that it receives. Pages are first writable, then executable, never both. They live as long as the value that calls them, and
//! nothing writes to them, so threads may call them at the same time.

#![allow(unsafe_code)]

use memmap2::{Mmap, MmapMut};

use crate::encode::encode;
use crate::instruction::Instruction;
use crate::line::{Lanes, Width};

/// A function of two pointers: the frame and the results.
#[cfg(target_arch = "x86_64")]
type Entry = unsafe extern "sysv64" fn(*mut f64, *mut f64);
#[cfg(not(target_arch = "x86_64"))]
type Entry = unsafe extern "C" fn(*mut f64, *mut f64);

/// Places that a frame or the results may have. All displacements that `encode` writes reach as far: 2³¹ bytes on x86-64, where a
/// place takes at most 64, and 2²⁴ on aarch64, where it takes 8.
const PLACES: usize = 1 << 20;

/// Functions in executable memory, which is freed when this is dropped.
#[derive(Debug)]
pub struct Functions {
    pages: Mmap,
    /// Where each begins, bytes.
    begins: Vec<usize>,
    width: Width,
    lanes: Lanes,
    places: usize,
    results: usize,
    bytes: usize,
    loops: usize,
}

impl Functions {
    /// The machine code of functions.
    ///
    /// # Errors
    /// The system has no memory, or does not permit to execute it; or a displacement would not reach all places.
    pub fn new<'a>(
        functions: impl Iterator<Item = &'a [Instruction]> + Clone,
        width: Width,
        lanes: Lanes,
    ) -> std::io::Result<Self> {
        assert!(width.numbers().is_multiple_of(lanes.numbers()), "all numbers of a place are computed");
        let (mut places, mut results, mut iterations) = (0, 0, 1u32);
        for instruction in functions.clone().flatten() {
            instruction.reach(&mut places, &mut results, &mut iterations);
        }
        if places.max(results) > PLACES {
            return Err(std::io::ErrorKind::FileTooLarge.into());
        }
        let is_loop = |instruction: &&Instruction| matches!(instruction, Instruction::Begin(_));
        let loops = functions.clone().flatten().filter(is_loop).count();
        let functions: Vec<Vec<u8>> = functions.map(|instructions| encode(instructions, lanes)).collect();
        let (mut begins, mut size) = (vec![], 0);
        for code in &functions {
            begins.push(size);
            // A function begins where a line of the cache does.
            size += code.len().next_multiple_of(64);
        }
        let mut pages = MmapMut::map_anon(size.max(1))?;
        for (begin, code) in begins.iter().zip(&functions) {
            pages[*begin..begin + code.len()].copy_from_slice(code);
        }
        let pages = pages.make_exec()?;
        synchronise(&pages);
        let bytes = functions.iter().map(Vec::len).sum();
        Ok(Self { pages, begins, width, lanes, places, results, bytes, loops })
    }

    /// The number of places in the frame.
    pub fn places(&self) -> usize {
        self.places
    }

    /// The length of the code.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// The number of loops.
    pub fn loops(&self) -> usize {
        self.loops
    }

    /// Calls a function with the frame and the results, for all numbers of each place.
    pub fn call(&self, function: usize, frame: &mut [f64], results: &mut [f64]) {
        let numbers = self.width.numbers();
        assert!(frame.len() >= self.places * numbers, "a frame has {} places", self.places);
        assert!(results.len() >= self.results * numbers, "there are {} results", self.results);
        let begin = &raw const self.pages[self.begins[function]];
        // SAFETY: `new` put the code of a function of this type there, in pages that are executable as long as `self` lives.
        let entry = unsafe { std::mem::transmute::<*const u8, Entry>(begin) };
        for lane in (0..numbers).step_by(self.lanes.numbers()) {
            let [frame, results] = [&mut *frame, &mut *results].map(|numbers| numbers.as_mut_ptr().wrapping_add(lane));
            // SAFETY: the code takes as many numbers of each place as `lanes` says, from number `lane` on: the last of them is within both slices,
            // which the assertions above compare with the places that it names. Both are borrowed for this call alone.
            unsafe { entry(frame, results) }
        }
    }
}

/// What was written as data is seen as instructions.
#[cfg(target_arch = "aarch64")]
fn synchronise(pages: &Mmap) {
    use std::arch::asm;
    // The least size of a line of either cache.
    const LINE: usize = 16;
    let range = pages.as_ptr_range();
    let (begin, end) = (range.start as usize, range.end as usize);
    for line in (begin..end).step_by(LINE) {
        // SAFETY: cleans a line of memory that is mapped; no number changes.
        unsafe { asm!("dc cvau, {}", in(reg) line, options(nostack, preserves_flags)) };
    }
    // SAFETY: a barrier, which waits for that.
    unsafe { asm!("dsb ish", options(nostack, preserves_flags)) };
    for line in (begin..end).step_by(LINE) {
        // SAFETY: forgets a line of instructions, which is read again from memory that is mapped.
        unsafe { asm!("ic ivau, {}", in(reg) line, options(nostack, preserves_flags)) };
    }
    // SAFETY: barriers, which wait for that and forget what was fetched ahead.
    unsafe { asm!("dsb ish", "isb", options(nostack, preserves_flags)) };
}

/// Caches of data and instructions agree by themselves.
#[cfg(not(target_arch = "aarch64"))]
fn synchronise(_: &Mmap) {}
