//! The arguments of the command line.

use std::ffi::OsString;
use std::path::PathBuf;
use std::str::FromStr;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::error::ErrorKind;
use clap::parser::ValueSource;
use clap::{Args, CommandFactory as _, FromArgMatches as _, Parser, Subcommand, ValueEnum};

use crate::emit::Scalar;

use super::budget::Limit;

const EXAMPLES: &str = "\
Examples:
  pebo-gen models/cuk.yaml -o src/cuk.rs          prove, then write the observer
  pebo-gen models/*.yaml -o src/observers/        the same for several models, a file each
  pebo-gen models/cuk.yaml --c cuk                a crate that C projects link: library, header, example
  pebo-gen check models/*.yaml --format json      verdicts for programs, a line each
  pebo-gen simulate models/cuk.yaml --plot cuk.svg
  pebo-gen replay models/cuk.yaml --data log.csv -o estimates.csv
  pebo-gen report models/cuk.yaml -o cuk.html     a page that explains the proof
  pebo-gen certificate models/cuk.yaml -o cuk.py  a script that proves the claims again
  pebo-gen explain cascade-refuted                what a diagnostic means, with an example
  generate_model | pebo-gen -                     a model from standard input

Exit status: 0 accepted, 1 a claim is refuted or undecided, 2 the input or the call is malformed.";

/// Proves parameter-estimation-based observers and emits them as Rust.
#[derive(Parser)]
#[command(
    version,
    subcommand_negates_reqs = true,
    arg_required_else_help = true,
    after_help = EXAMPLES
)]
pub(super) struct Arguments {
    #[command(subcommand)]
    pub(super) command: Option<Command>,
    #[command(flatten)]
    pub(super) generate: GenerateOptions,
    /// Time for each model, 10 seconds by default; what is not decided by then is undecided. Memory is limited to 512
    /// MB, in proportion more beyond 10 seconds. If given, `simulate` and `replay` also stop a run that takes longer
    #[arg(long, global = true, value_name = "SECONDS")]
    pub(super) limit: Option<Limit>,
}

impl Arguments {
    /// The arguments of a call, the first of which is the program's name, or what clap has to say instead.
    ///
    /// `--limit` may stand before a command and behind it; what belongs to the writing of code may not.
    pub(super) fn of(call: impl IntoIterator<Item = OsString>) -> Result<Self, clap::Error> {
        let matches = Self::command().try_get_matches_from(call)?;
        if let Some(command) = matches.subcommand_name() {
            let given = |id: &&str| matches.value_source(id) == Some(ValueSource::CommandLine);
            if let Some(id) = ["output", "c", "scalar"].into_iter().find(given) {
                let message = format!("`--{id}` belongs to `pebo-gen MODEL`, and cannot stand before `{command}`");
                return Err(Self::command().error(ErrorKind::ArgumentConflict, message));
            }
        }
        Self::from_arg_matches(&matches)
    }
}

impl FromStr for Limit {
    type Err = &'static str;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let seconds: f64 = text.parse().map_err(|_| "a number of seconds is expected, as 60 or 0.5")?;
        Self::of_seconds(seconds)
    }
}

#[derive(Subcommand)]
pub(super) enum Command {
    /// Check models and print what is proved, without emitting code
    Check(CheckOptions),
    /// Simulate the closed loop of plant, control law and observer
    Simulate(SimulateOptions),
    /// Run the observer over recorded data
    Replay(ReplayOptions),
    /// Explain a diagnostic by its code
    Explain(ExplainOptions),
    /// Print the completions for a shell
    Completions(CompletionsOptions),
    /// Print the manual page
    Man,
    /// Print the JSON schema of `check --format json`, of `solve --format json`, or of model files
    Schema(SchemaOptions),
    /// Search for the transform phi, whether or not the model has one
    Solve(SolveOptions),
    /// Write a page that explains the proof: typeset derivation, code, and the figure of the closed loop
    Report(ReportOptions),
    /// Write a Python script that proves every claim again, with sympy
    Certificate(CertificateOptions),
}

#[derive(Args)]
pub(super) struct CompletionsOptions {
    /// The shell
    #[arg(value_enum)]
    pub(super) shell: clap_complete::Shell,
}

#[derive(Args)]
pub(super) struct SchemaOptions {
    /// Of what
    #[arg(value_enum, value_name = "NAME", default_value_t = SchemaName::Check)]
    pub(super) of: SchemaName,
}

#[derive(Clone, Copy, ValueEnum)]
pub(super) enum SchemaName {
    /// The verdicts of `check --format json`
    Check,
    /// The transforms of `solve --format json`
    Solve,
    /// Model files, for editors
    Model,
}

#[derive(Args)]
pub(super) struct CertificateOptions {
    /// The model file; `-` reads standard input
    pub(super) model: PathBuf,
    /// Write the script to this file instead of standard output
    #[arg(short, long, value_name = "FILE.py")]
    pub(super) output: Option<PathBuf>,
}

#[derive(Args)]
pub(super) struct ReportOptions {
    /// The model file; `-` reads standard input
    pub(super) model: PathBuf,
    /// Write the page to this file instead of standard output
    #[arg(short, long, value_name = "FILE.html")]
    pub(super) output: Option<PathBuf>,
}

#[derive(Args)]
pub(super) struct GenerateOptions {
    /// The model files to check and emit as Rust; `-` reads standard input
    #[arg(required = true, value_name = "MODEL")]
    pub(super) models: Vec<PathBuf>,
    /// Write the Rust code to this file instead of standard output; for several models, to this folder
    #[arg(short, long, value_name = "FILE")]
    pub(super) output: Option<PathBuf>,
    /// Write a crate to this folder instead, which builds the observer of one model as a static library with a C header,
    /// with files for make and `CMake`, and an example
    #[arg(long, value_name = "DIR", conflicts_with = "output")]
    pub(super) c: Option<PathBuf>,
    /// The floating-point type of the emitted code
    #[arg(long, value_parser = scalars(), default_value = Scalar::default().name())]
    pub(super) scalar: Scalar,
}

/// The floating-point types, by name.
fn scalars() -> impl TypedValueParser<Value = Scalar> {
    let names = PossibleValuesParser::new(Scalar::ALL.map(Scalar::name));
    names.map(|name| Scalar::from_name(&name).unwrap_or_default())
}

#[derive(Args)]
pub(super) struct CheckOptions {
    /// The model files; `-` reads standard input
    #[arg(required = true, value_name = "MODEL")]
    pub(super) models: Vec<PathBuf>,
    /// As text for people, or as one line of JSON for each model
    #[arg(long, value_enum, default_value_t = Format::Human)]
    pub(super) format: Format,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    Human,
    Json,
}

#[derive(Args)]
pub(super) struct SolveOptions {
    /// The model file; `-` reads standard input
    pub(super) model: PathBuf,
    /// Search for transforms with this cascade; `any` is what the model asks for, or either
    #[arg(long, value_enum, default_value_t = ClassName::Any)]
    pub(super) class: ClassName,
    /// As text for people, or as one line of JSON
    #[arg(long, value_enum, default_value_t = Format::Human)]
    pub(super) format: Format,
    /// Write the model with the best transform that was found to this file; `-` is standard output
    #[arg(short, long, value_name = "NEW.yaml")]
    pub(super) output: Option<PathBuf>,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum ClassName {
    /// z' = h(y, u)
    Pebo,
    /// z' = Lambda(y, u) z + h(y, u)
    Gpebo,
    /// Either
    Any,
}

impl ClassName {
    /// The name as models write it; nothing for either.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Pebo => "pebo",
            Self::Gpebo => "gpebo",
            Self::Any => "",
        }
    }
}

#[derive(Args)]
pub(super) struct SimulateOptions {
    /// The model file, with a `simulation` section; `-` reads standard input
    pub(super) model: PathBuf,
    /// Draw the figure into this SVG file; of many runs, the median of each error and the band of 10 to 90 %
    #[arg(long, value_name = "FILE.svg")]
    pub(super) plot: Option<PathBuf>,
    /// Write the time series into this CSV file; `-` is standard output. Of many runs, quantiles of the errors
    #[arg(long, value_name = "FILE.csv")]
    pub(super) csv: Option<PathBuf>,
    /// Seconds between rows of the output; by default a thousandth of the duration
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    pub(super) every: Option<f64>,
    /// The sampling period, instead of the model file's
    #[arg(long, value_name = "SECONDS", allow_negative_numbers = true)]
    pub(super) step: Option<f64>,
    /// The seed of all chance (noise, jitter, dropped samples), 1 by default: the same seed gives the same run
    #[arg(long, value_name = "N")]
    pub(super) seed: Option<u64>,
    /// Run it so many times, with the seed and those after it, and show how the errors are spread
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=10_000))]
    pub(super) runs: Option<u64>,
    /// Set a parameter, or what stands under a key of the model file, such as `simulation.noise.v2`, as if the file
    /// said so; can be given several times
    #[arg(long, value_name = "NAME=VALUE")]
    pub(super) set: Vec<String>,
    /// Whose estimates the control law uses: observer, truth, or a baseline's name
    #[arg(long, value_name = "NAME")]
    pub(super) feedback: Option<String>,
}

#[derive(Args)]
pub(super) struct ReplayOptions {
    /// The model file, perhaps with a `recording` section that says what the columns mean; `-` reads standard input
    pub(super) model: PathBuf,
    /// The recording: CSV with the names of the columns in its first line; `-` reads standard input
    #[arg(long, value_name = "LOG.csv")]
    pub(super) data: PathBuf,
    /// Set a parameter, or what stands under a key of the model file, such as `simulation.noise.v2`, as if the file
    /// said so; can be given several times
    #[arg(long, value_name = "NAME=VALUE")]
    pub(super) set: Vec<String>,
    /// Write the estimates, and their errors where the state was measured, into this CSV file; `-` is standard output
    #[arg(short = 'o', long, value_name = "OUT.csv", visible_alias = "output")]
    pub(super) csv: Option<PathBuf>,
    /// Draw the figure into this SVG file
    #[arg(long, value_name = "FILE.svg")]
    pub(super) plot: Option<PathBuf>,
    /// Find the standard deviations of sensors and disturbances that make the first rows most likely, run the observer
    /// with them, and print its section `observer`; `--fit=R,v` finds the parameter R and the delay of the output v too
    #[arg(long, value_name = "NAME,..", num_args = 0..=1, require_equals = true, default_missing_value = "")]
    pub(super) fit: Option<String>,
}

#[derive(Args)]
pub(super) struct ExplainOptions {
    /// A code as diagnostics show it, such as cascade-refuted
    pub(super) code: String,
}
