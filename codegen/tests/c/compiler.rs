//! The system's C compiler.

use std::path::Path;
use std::process::Command;
use std::{env, fs};

use crane_codegen::emit_c::CCode;

/// Compiles and runs a program; returns the numbers that it prints.
pub fn run_program(folder: &Path, code: &CCode, main: &str) -> Vec<f64> {
    fs::create_dir_all(folder).unwrap();
    for (file, text) in [(format!("{}.h", code.name), &code.header), (format!("{}.c", code.name), &code.source)] {
        fs::write(folder.join(file), text).unwrap();
    }
    fs::write(folder.join("main.c"), main).unwrap();
    let program = folder.join("main");
    let compiler = env::var("CC").unwrap_or_else(|_| "cc".to_owned());
    let strict = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-O1", "-ffp-contract=off"];
    let compile = |arguments: &[&str]| {
        let done = Command::new(&compiler).args(arguments).current_dir(folder).output().unwrap();
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    };
    compile(&[&strict[..], &["-c", &format!("{}.c", code.name), "-o", "crane.o"]].concat());
    // The numbers in the caller's source are doubles; in single precision the caller rounds them.
    compile(&["-std=c99", "-O0", "main.c", "crane.o", "-lm", "-o", "main"]);
    let printed = Command::new(program).output().unwrap();
    assert!(printed.status.success());
    String::from_utf8(printed.stdout).unwrap().lines().map(|line| line.parse().unwrap()).collect()
}
