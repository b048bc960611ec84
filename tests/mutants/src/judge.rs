//! Gives each fault to the tests.

use std::collections::BTreeSet;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use crate::copy::{Binaries, Binary};
use crate::plan::{Module, Tests};
use crate::sites::Fault;

/// A test hangs if it takes this many times longer than without a fault, plus this time.
const PATIENCE: (u32, Duration) = (4, Duration::from_secs(20));

/// A run of the tests of a binary without a fault.
struct Baseline {
    /// The numbers of the faults that are run through.
    reached: BTreeSet<usize>,
    took: Duration,
}

/// Prints the results of a module's faults.
pub fn report(module: &Module, faults: &[&Fault], binaries: &Binaries, jobs: usize) -> Result<(), String> {
    let mut baselines = Vec::new();
    for tests in module.tests {
        let binary = &binaries[&(tests.package.name, tests.target)];
        let folder = binary.path.with_extension("reached");
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
        let start = Instant::now();
        if !passes(binary, tests.filter, 0, Some(&folder), Duration::from_secs(3600)) {
            return Err(format!("`{}` fails without a fault", named(tests)));
        }
        let entries = std::fs::read_dir(&folder).map_err(|error| error.to_string())?.flatten();
        let reached = entries.filter_map(|entry| entry.file_name().to_str()?.parse().ok()).collect();
        baselines.push(Baseline { reached, took: start.elapsed() });
    }
    let missed = Mutex::new(Vec::new());
    let noticed: Vec<AtomicUsize> = module.tests.iter().map(|_| AtomicUsize::new(0)).collect();
    let next = AtomicUsize::new(0);
    std::thread::scope(|scope| {
        for _ in 0..jobs {
            scope.spawn(|| {
                while let Some(fault) = faults.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let through = |baseline: &&Baseline| baseline.reached.contains(&fault.number);
                    let ran = baselines.iter().any(|baseline| through(&baseline));
                    let first = module.tests.iter().zip(&baselines).position(|(tests, baseline)| {
                        let patience = baseline.took * PATIENCE.0 + PATIENCE.1;
                        let binary = &binaries[&(tests.package.name, tests.target)];
                        through(&baseline) && !passes(binary, tests.filter, fault.number, None, patience)
                    });
                    if let Some(first) = first {
                        noticed[first].fetch_add(1, Ordering::Relaxed);
                    } else if let Ok(mut missed) = missed.lock() {
                        missed.push((fault, ran));
                    }
                }
            });
        }
    });
    let mut missed = missed.into_inner().map_err(|_| "a thread failed")?;
    missed.sort_by_key(|(fault, _)| (&fault.file, fault.line));
    let (all, survived) = (faults.len(), missed.len());
    println!("{}: {all} faults, {} noticed, {survived} missed", module.name, all - survived);
    for (tests, count) in module.tests.iter().zip(noticed) {
        println!("  first noticed by {}: {}", named(tests), count.into_inner());
    }
    for (fault, ran) in missed {
        let mark = if ran { "" } else { " (no test gets there)" };
        println!("  {}:{}: {}{mark}", fault.file.display(), fault.line, fault.what);
    }
    Ok(())
}

/// The name of tests for a reader.
fn named(tests: &Tests) -> String {
    [tests.package.name, tests.target, tests.filter].join(" ").trim_end().to_owned()
}

/// The tests pass with a fault, in time; the first that fails ends them.
fn passes(binary: &Binary, filter: &str, fault: usize, reached: Option<&Path>, patience: Duration) -> bool {
    let mut command = Command::new(&binary.path);
    command
        .args([filter, "--test-threads=1"])
        .env("PEBO_MUTANT", fault.to_string())
        .stdout(Stdio::piped())
        .stderr(Stdio::null());
    // As cargo runs it: in the folder of its package, with the project's seed.
    command.env("PROPTEST_RNG_SEED", "2015").env("PROPTEST_DISABLE_FAILURE_PERSISTENCE", "1");
    command.current_dir(&binary.folder);
    if let Some(folder) = reached {
        command.env("PEBO_REACHED", folder);
    }
    let Ok(mut child) = command.spawn() else { return false };
    let (sender, lines) = channel();
    if let Some(stdout) = child.stdout.take() {
        std::thread::spawn(move || {
            for line in BufReader::new(stdout).lines().map_while(Result::ok) {
                if sender.send(line).is_err() {
                    break;
                }
            }
        });
    }
    let end = Instant::now() + patience;
    loop {
        match lines.recv_timeout(end.saturating_duration_since(Instant::now())) {
            Ok(line) if line.ends_with("FAILED") => break,
            Ok(_) => {}
            Err(RecvTimeoutError::Disconnected) => return child.wait().is_ok_and(|status| status.success()),
            Err(RecvTimeoutError::Timeout) => break,
        }
    }
    let _ = child.kill();
    let _ = child.wait();
    false
}
