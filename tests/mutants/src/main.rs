//! A mutation run with a switch: counts the small faults that the tests notice.
//!
//! ```text
//! cargo run --release --manifest-path tests/mutants/Cargo.toml -- [MODULE..] [--sample N] [--seed N] [--jobs N]
//! ```
//!
//! from the project's root. Modules are those of [`plan::MODULES`]; without one, all. The sources of a module are
//! copied with every fault in them at once, each behind a number that `PEBO_MUTANT` selects, so they are compiled once
//! and not once for each fault. A sample of N faults a module (40) is drawn by a seed (1); faults that overlap one that
//! is drawn, and those that do not compile, are left out. Each is then given to the tests of the module, the quick ones
//! first, until one fails. It prints, for each module, how many faults were tried, noticed, and by which tests first,
//! and which were missed: those that no test ran through at all are marked.
//!
//! Two classes of fault are missed and no test is wanting: one that changes how an answer is found and not the answer
//! (a bound on effort, an order of attempts), and one that turns an answer into *undecided*, where no test claims that
//! it is decided. `SURVIVORS.md` lists those that were examined, each with its reason: another missed fault wants a
//! test.
//!
//! The sample depends on file, function and fault alone: a seed keeps it when sources change elsewhere. The figures are
//! those of the same faults before and after their survivors were killed or listed; all that are missed after are
//! listed.
//!
//! | module | faults | noticed before | after | what had no test |
//! |---|---|---|---|---|
//! | tower | 97 (`--sample 100 --seed 7`) | 79 | 83 | roots of products with parts in common, four times an inverse tangent, negated sums of two, ranges of inverse cosines |
//! | analysis | 100 (`--sample 100 --seed 7`) | 82 | 91 | one-way couplings in a cycle, conditions on estimates, the author's own terms in a regression, an identity where the rates are none, words of doubts |
//! | program | 39 (`--sample 40`) | 29 | 34 | sums and weights of costs, short decimals |
//! | runtime | 36 (`--sample 40`) | 27 | 32 | sine and cosine together in single precision |

mod copy;
mod judge;
mod plan;
mod rewrite;
mod sites;

use std::process::ExitCode;

struct Arguments {
    modules: Vec<&'static plan::Module>,
    sample: usize,
    seed: u64,
    jobs: usize,
}

fn arguments() -> Result<Arguments, String> {
    let mut found = Arguments { modules: Vec::new(), sample: 40, seed: 1, jobs: 2 };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut number = || {
            let value = words.next().and_then(|value| value.parse::<usize>().ok());
            value.ok_or_else(|| format!("{word} needs a number"))
        };
        match word.as_str() {
            "--sample" => found.sample = number()?,
            "--seed" => found.seed = number()? as u64,
            "--jobs" => found.jobs = number()?.max(1),
            name => {
                let known = plan::MODULES.iter().find(|module| module.name == name);
                let names = || plan::MODULES.map(|module| module.name).join(", ");
                found.modules.push(known.ok_or_else(|| format!("`{name}` is none of {}", names()))?);
            }
        }
    }
    if found.modules.is_empty() {
        found.modules = plan::MODULES.iter().collect();
    }
    Ok(found)
}

fn run() -> Result<(), String> {
    let arguments = arguments()?;
    // Packages are changed one by one, with the faults of all modules that they have; the others are as they were.
    for package in plan::PACKAGES {
        let has = |module: &&plan::Module| module.package.name == package.name;
        let modules: Vec<_> = arguments.modules.iter().copied().filter(has).collect();
        if modules.is_empty() {
            continue;
        }
        let copy = copy::Copy::new()?;
        let mut drawn = sites::draw(copy.root(), &modules, arguments.sample, arguments.seed)?;
        let binaries = copy.build(package, &modules, &mut drawn)?;
        for module in modules {
            let faults: Vec<_> = drawn.iter().filter(|fault| fault.module == module.name).collect();
            judge::report(module, &faults, &binaries, arguments.jobs)?;
        }
    }
    Ok(())
}

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}
