//! Ends the command with a message before it has used so much memory that the system ends it, or something else.

use std::{env, fs, path::Path, process, sync::Arc, thread, time::Duration};

use crate::{
    problem::{Outcome, Problem},
    screen::Console,
};

/// The environment variable with another limit, MB; 0: none.
const VARIABLE: &str = "CRANE_MEMORY";
/// Between two looks, a program that writes to memory as fast as it can takes some 100 MB.
const INTERVAL: Duration = Duration::from_millis(50);
/// The limit as a fraction of the memory that there is.
const SHARE: f64 = 0.5;
/// MB of a kB.
const MEGABYTES: f64 = 1e-3;

/// Watches the memory of this process from a thread of its own, where the system says how much it is and how much there is, until the command has
/// ended.
///
/// # Errors
/// The environment variable is not a number.
pub fn watch(console: &Arc<Console>) -> Outcome<()> {
    let (most, whose) = if let Ok(text) = env::var(VARIABLE) {
        (limit(&text)?, format!("the {text} MB of {VARIABLE}"))
    } else if let Some(all) = available() {
        (SHARE * all, format!("half of the {all:.0} MB that there are"))
    } else {
        return Ok(());
    };
    if most == 0.0 || resident().is_none() {
        return Ok(());
    }
    // Without a thread for it, the command runs as it would without the guard.
    let console = Arc::downgrade(console);
    let _ = thread::Builder::new().name("memory".to_owned()).spawn(move || {
        while let Some(console) = console.upgrade() {
            if let Some(used) = resident().filter(|used| *used > most) {
                process::exit(i32::from(console.report(&beyond(used, &whose, &console))));
            }
            thread::sleep(INTERVAL);
        }
    });
    Ok(())
}

/// The problem of a process that uses too much.
fn beyond(used: f64, whose: &str, console: &Console) -> Problem {
    let of = console.crane_at_work().map_or(String::new(), |crane| format!(" for {crane}"));
    Problem::failed(
        format!("{used:.0} MB of memory{of} are more than {whose}"),
        format!(
            "divide beams into fewer sections, or compute fewer cranes at once (`--threads`); `{VARIABLE}=8000` permits 8000 MB, `{VARIABLE}=0` any"
        ),
    )
}

/// A limit as written, MB.
fn limit(text: &str) -> Outcome<f64> {
    text.trim().parse().ok().filter(|limit: &f64| limit.is_finite() && *limit >= 0.0).ok_or_else(|| {
        Problem::usage(
            format!("`{VARIABLE}={text}` is not an amount of memory"),
            "write a number of megabytes, such as 8000, or 0 for no limit",
        )
    })
}

/// Memory of this process, MB.
fn resident() -> Option<f64> {
    entry("/proc/self/status", "VmRSS:")
}

/// Memory of the machine, or of the groups of processes that this one belongs to if that is less, MB.
fn available() -> Option<f64> {
    let machine = entry("/proc/meminfo", "MemTotal:")?;
    Some(groups().into_iter().fold(machine, f64::min))
}

/// A number of kB in a file of lines such as `MemTotal:  16384 kB`, MB.
fn entry(file: &str, name: &str) -> Option<f64> {
    let text = fs::read_to_string(file).ok()?;
    let words = text.lines().find_map(|line| line.strip_prefix(name))?;
    words.trim().strip_suffix("kB")?.trim().parse().ok().map(|number: f64| MEGABYTES * number)
}

/// Limits of the groups of processes (cgroups, both versions), MB.
fn groups() -> Vec<f64> {
    let own = fs::read_to_string("/proc/self/cgroup").unwrap_or_default();
    let own = own.lines().find_map(|line| line.strip_prefix("0::")).unwrap_or("/");
    let root = Path::new("/sys/fs/cgroup");
    let of_groups = Path::new(own.trim_start_matches('/')).ancestors().map(|group| root.join(group).join("memory.max"));
    let limits = of_groups.chain([root.join("memory/memory.limit_in_bytes")]);
    let bytes = limits.filter_map(|file| fs::read_to_string(file).ok()?.trim().parse::<f64>().ok());
    bytes.map(|bytes| 1e-6 * bytes).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_megabytes() {
        assert_eq!(limit(" 8000 ").ok(), Some(8000.0));
        assert_eq!(limit("0").ok(), Some(0.0));
        for wrong in ["", "-1", "8 GB", "inf", "NaN"] {
            let problem = limit(wrong).expect_err(wrong);
            assert!(problem.message().contains("write a number of megabytes"), "{wrong}");
        }
    }

    /// A process that runs tests has a few MB, and a machine that runs them a few hundred.
    #[cfg(target_os = "linux")]
    #[test]
    fn memory_is_known_on_linux() {
        let (used, all) = (resident().expect("of this process"), available().expect("of this machine"));
        assert!(used > 1.0 && used < all && all > 200.0, "{used} MB of {all} MB");
    }
}
