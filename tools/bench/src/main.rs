//! Times one kernel, so that programs that time other libraries can alternate with it.
//!
//! ```text
//! crane-bench coordinates              the numbers of coordinates, one per line
//! crane-bench spec N                   the YAML text of the crane with N coordinates
//! crane-bench kernels N                names of its kernels and the number of cranes per call, one per line
//! crane-bench step                     the step of the kernel rk4_step, s
//! crane-bench repeat N KERNEL CALLS    calls a kernel CALLS times, for programs that count instructions
//! crane-bench states N                 states as records t, q, v, f: 64-bit little-endian numbers
//! crane-bench values N KERNEL          what a kernel computes at these states, in the same form
//! crane-bench time N KERNEL SECONDS    nanoseconds per call, measured for this long
//! crane-bench limits N                 functions: operations, angles among them, and the time of the longest chain of operations, ns
//! crane-bench plan N                   a run: duration and interval of results, s, and the coordinates at the start
//! crane-bench run N METHOD X REPEAT    shortest time of this run, s, with a step or tolerance X, and the coordinates at its results
//! ```

use std::io::Write as _;
use std::process::ExitCode;
use std::time::Duration;

use crane_bench::cranes::{self, Entry};
use crane_bench::kernel::Kernel;
use crane_bench::runs::Plan;
use crane_bench::{kernels, limits};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match run_command(&words) {
        Ok(bytes) => {
            // A reader that has seen enough may close the pipe.
            let _ = std::io::stdout().write_all(&bytes);
            ExitCode::SUCCESS
        }
        Err(message) => {
            eprintln!("crane-bench: {message}");
            ExitCode::from(2)
        }
    }
}

fn run_command(words: &[&str]) -> Result<Vec<u8>, String> {
    match words {
        ["coordinates"] => Ok(lines(cranes::all().iter().map(|entry| entry.coordinates.to_string()))),
        ["step"] => Ok(lines([kernels::STEP.to_string()].into_iter())),
        ["spec", n] => Ok(crane(n)?.spec.into()),
        ["kernels", n] => {
            Ok(lines((crane(n)?.kernels)().iter().map(|kernel| format!("{} {}", kernel.name, kernel.lanes))))
        }
        ["states", n] => Ok(bytes(&(crane(n)?.records)())),
        ["values", n, name] => Ok(bytes(&kernel(n, name)?.values())),
        ["time", n, name, seconds] => {
            let seconds: f64 = seconds.parse().map_err(|error| format!("{seconds}: {error}"))?;
            let budget = Duration::try_from_secs_f64(seconds).map_err(|error| format!("{seconds}: {error}"))?;
            Ok(lines([kernel(n, name)?.nanoseconds(budget).to_string()].into_iter()))
        }
        ["limits", n] => Ok(lines(limits::lines(crane(n)?.spec).into_iter())),
        ["plan", n] => {
            let Plan { start, duration, output } = (crane(n)?.plan)();
            Ok(bytes(&[vec![duration, output], start].concat()))
        }
        ["run", n, method, accuracy, repeat] => {
            let method = method.parse().map_err(|error| format!("{method}: {error}"))?;
            let accuracy = accuracy.parse().map_err(|error| format!("{accuracy}: {error}"))?;
            let repeat = repeat.parse().map_err(|error| format!("{repeat}: {error}"))?;
            Ok(bytes(&(crane(n)?.run)(method, accuracy, repeat)?))
        }
        ["repeat", n, name, calls] => {
            kernel(n, name)?.time(calls.parse().map_err(|error| format!("{calls}: {error}"))?);
            Ok(Vec::new())
        }
        _ => Err("no such command; the comment at the top of the source lists all".into()),
    }
}

fn crane(n: &str) -> Result<Entry, String> {
    let coordinates = n.parse().ok();
    coordinates.and_then(cranes::find).ok_or(format!("no crane with {n} coordinates; try `crane-bench coordinates`"))
}

fn kernel(n: &str, name: &str) -> Result<Kernel, String> {
    crane(n)?.kernel(name).ok_or(format!("no kernel `{name}`; try `crane-bench kernels {n}`"))
}

fn lines(lines: impl Iterator<Item = String>) -> Vec<u8> {
    lines.map(|line| line + "\n").collect::<String>().into_bytes()
}

fn bytes(numbers: &[f64]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}
