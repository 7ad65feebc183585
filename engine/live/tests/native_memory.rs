//! Machine code of a crane is in memory until its last clone is dropped. Alone in its process, whose mappings it counts.

#![cfg(target_os = "linux")]

use crane_codegen::build;
use crane_codegen::program::FunctionId;
use crane_live::LiveCrane;

/// Bytes of mappings without a file that may be executed.
fn executable() -> usize {
    let maps = std::fs::read_to_string("/proc/self/maps").unwrap();
    let bytes = |line: &str| {
        // address, permissions, offset, device, inode; then a name, if there is one
        let fields: Vec<&str> = line.split_whitespace().collect();
        let (begin, end) = fields[0].split_once('-')?;
        let address = |hexadecimal| usize::from_str_radix(hexadecimal, 16).ok();
        (fields.len() == 5 && fields[1].contains('x')).then_some(address(end)? - address(begin)?)
    };
    maps.lines().filter_map(bytes).sum()
}

#[test]
fn the_last_clone_frees_machine_code() {
    let path = format!("{}/../../specs/eight_link_flexible.yaml", env!("CARGO_MANIFEST_DIR"));
    let source = build::open(path.as_ref()).unwrap_or_else(|failure| panic!("{failure}"));
    let before = executable();
    for _ in 0..10 {
        let crane = LiveCrane::from_spec(&source).unwrap();
        if !crane.compile(FunctionId::ForwardDynamics) {
            println!("no machine code for this processor");
            return;
        }
        let one = executable() - before;
        assert!((4096..1 << 20).contains(&one), "{one} bytes");
        let clone = crane.clone();
        drop(crane);
        assert!(clone.compile(FunctionId::ForwardDynamics));
        assert_eq!(executable() - before, one, "clones share it");
        drop(clone);
        assert_eq!(executable(), before);
    }
}
