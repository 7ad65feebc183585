//! Executable memory of code: one mapping for each, never writable, gone with the code. Alone in its process, whose mappings it
//! counts.

#![cfg(target_os = "linux")]

use crane_jit::{Code, Rounding, Step, StraightLine, Width};

/// Permissions of mappings without a file that may be executed.
fn executable() -> Vec<String> {
    let maps = std::fs::read_to_string("/proc/self/maps").unwrap();
    // address, permissions, offset, device, inode; then a name, if there is one
    let fields = maps.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
    let own = fields.filter(|fields| fields.len() == 5 && fields[1].contains('x'));
    own.map(|fields| fields[1].to_owned()).collect()
}

/// A line whose code takes several pages: nothing repeats in it.
fn line() -> StraightLine {
    let products = (0..3000).map(|at| Step::MulAdd([at + 1, 7919 * at % (at + 2), 0]));
    StraightLine {
        given: vec![None; 2],
        steps: products.chain([Step::Store { place: 0, value: 3001 }]).collect(),
        results: 1,
    }
}

#[test]
fn dropped_code_leaves_no_pages() {
    let before = executable().len();
    let Some(first) = Code::compile(&line(), Rounding::Separate, Width::One) else {
        println!("no code for this processor");
        return;
    };
    assert!(first.bytes() > 8192);
    // Neighbours may become one mapping, so several are not counted.
    let now = executable();
    assert_eq!(now.len(), before + 1, "{now:?}");
    assert!(now.iter().all(|permissions| !permissions.contains('w')), "{now:?}");
    drop(first);
    for _ in 0..100 {
        drop(Code::compile(&line(), Rounding::Separate, Width::One));
    }
    assert_eq!(executable().len(), before);
}
