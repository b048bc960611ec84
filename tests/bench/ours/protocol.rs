//! The protocol of every system in Rust, which `rivals/protocol.py` describes.
//!
//! In (JSON, one a line): `{"job": path, "recipe": name, "part": "proof" or "check"}`. Out: `{"seconds": s}` or
//! `{"failed": why}`.

use std::collections::BTreeMap;
use std::io::{BufRead as _, Write as _};
use std::process::ExitCode;
use std::time::Duration;

use serde_json::{Value, json};

/// A faster job is done once more before it is timed, with other operands: the caches have served other processes.
const SHORT: f64 = 0.02;

/// Options of a job.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct JobOptions {
    /// The system's method.
    pub(crate) recipe: String,
    /// A proof is timed alone, without the derivatives in its formula.
    pub(crate) alone: bool,
}

/// The work that is timed.
pub(crate) type Work = Box<dyn FnOnce() -> Check>;

/// The check of the result, which is not timed.
pub(crate) type Check = Box<dyn FnOnce() -> Result<(), String>>;

/// Answers until the input ends; `prepare` makes the operands of a job, untimed.
pub(crate) fn serve(prepare: impl Fn(&Value, &JobOptions) -> Result<Work, String>) -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [once, path, recipe] = arguments.as_slice()
        && once == "--once"
    {
        let how = JobOptions { recipe: recipe.clone(), alone: false };
        let done = read(path).and_then(|job| prepare(&job, &how)).and_then(|work| work()());
        return if done.is_ok() { ExitCode::SUCCESS } else { ExitCode::FAILURE };
    }
    let mut last: BTreeMap<(String, JobOptions), f64> = BTreeMap::new();
    for line in std::io::stdin().lock().lines().map_while(Result::ok) {
        let Ok(request) = serde_json::from_str::<Value>(&line) else { break };
        let field = |name: &str| request[name].as_str().unwrap_or_default().to_owned();
        let key = (field("job"), JobOptions { recipe: field("recipe"), alone: field("part") == "proof" });
        let warm = last.get(&key).is_none_or(|seconds| *seconds < SHORT);
        let reply = match timed(&prepare, &key.0, &key.1, warm) {
            Ok(seconds) => {
                last.insert(key, seconds);
                json!({ "seconds": seconds })
            }
            Err(why) => json!({ "failed": why }),
        };
        println!("{reply}");
        if std::io::stdout().flush().is_err() {
            break;
        }
    }
    ExitCode::SUCCESS
}

fn timed(
    prepare: &impl Fn(&Value, &JobOptions) -> Result<Work, String>,
    path: &str,
    how: &JobOptions,
    warm: bool,
) -> Result<f64, String> {
    let job = read(path)?;
    if warm {
        prepare(&job, how)?()()?;
    }
    let work = prepare(&job, how)?;
    let start = processor_time();
    let check = work();
    let seconds = processor_time().saturating_sub(start).as_secs_f64();
    check()?;
    Ok(seconds)
}

/// The processor time of this process: on a busy machine the clock counts others' work.
#[cfg(unix)]
fn processor_time() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    let nanoseconds = u32::try_from(time.tv_nsec).unwrap_or_default();
    Duration::new(time.tv_sec.cast_unsigned(), nanoseconds)
}

#[cfg(not(unix))]
fn processor_time() -> Duration {
    use std::time::Instant;

    static START: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
    START.get_or_init(Instant::now).elapsed()
}

fn read(path: &str) -> Result<Value, String> {
    let text = std::fs::read_to_string(path).map_err(|error| error.to_string())?;
    serde_json::from_str(&text).map_err(|error| error.to_string())
}

/// The texts of a list.
pub(crate) fn texts<'a>(job: &'a Value, key: &str) -> impl Iterator<Item = &'a str> {
    job[key].as_array().into_iter().flatten().filter_map(Value::as_str)
}

/// The pairs of a list of pairs of texts.
pub(crate) fn pairs<'a>(job: &'a Value, key: &str) -> impl Iterator<Item = (&'a str, &'a str)> {
    job[key].as_array().into_iter().flatten().filter_map(|pair| Some((pair[0].as_str()?, pair[1].as_str()?)))
}

/// The entries of an object of texts.
pub(crate) fn entries<'a>(job: &'a Value, key: &str) -> impl Iterator<Item = (&'a str, &'a str)> {
    job[key].as_object().into_iter().flatten().filter_map(|(name, text)| Some((name.as_str(), text.as_str()?)))
}

/// The terms of a polynomial: coefficients with their exponents.
pub(crate) fn terms(list: &Value) -> Vec<(i64, Vec<u32>)> {
    let exponent = |value: &Value| value.as_u64().and_then(|e| u32::try_from(e).ok());
    let term = |entry: &Value| Some((entry[0].as_i64()?, entry[1].as_array()?.iter().filter_map(exponent).collect()));
    list.as_array().into_iter().flatten().filter_map(term).collect()
}

/// A number of the job.
pub(crate) fn number(job: &Value, key: &str) -> Result<u64, String> {
    job[key].as_u64().ok_or_else(|| format!("the job has no {key}"))
}
