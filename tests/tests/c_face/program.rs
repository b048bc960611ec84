//! The crates, built as a C project builds them: make, gcc and g++ with all warnings as errors. What the examples print
//! is what the Rust observers estimate.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::{LazyLock, Mutex, PoisonError};

use pebo_gen::CProject;
use pebo_gen::emit::Scalar;

use super::{file, project, workspace};

/// C and C++ with all warnings.
const LANGUAGES: [(&str, &str, &str); 2] = [("gcc", "c", "-std=c99"), ("g++", "c++", "-std=c++17")];
const WARNINGS: [&str; 7] =
    ["-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Wdouble-promotion", "-Werror"];

/// The folder for what is built, which later runs find again.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("c_face").join(name);
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// What a command prints; it has to succeed.
fn run(command: &mut Command) -> String {
    let program = command.get_program().to_string_lossy().into_owned();
    let output = command.stdin(Stdio::null()).output();
    let output = output.unwrap_or_else(|error| panic!("{program}, which this test needs, does not run: {error}"));
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    assert!(output.status.success(), "{command:?}\n{}{}", text(&output.stdout), text(&output.stderr));
    text(&output.stdout)
}

/// Each header by itself and twice, all in one program, in both languages.
pub(crate) fn check_headers(headers: &[&(String, String)]) {
    let folder = folder("headers");
    let mut all = String::new();
    for (path, text) in headers {
        let name = path.trim_start_matches("include/");
        std::fs::write(folder.join(name), text).expect("a file");
        writeln!(all, "#include \"{name}\"\n#include \"{name}\"").expect("a string");
    }
    std::fs::write(folder.join("all.c"), all).expect("a file");
    for (compiler, language, standard) in LANGUAGES {
        let mut command = Command::new(compiler);
        command.args(["-x", language, standard, "-fsyntax-only"]).args(WARNINGS).arg("all.c").current_dir(&folder);
        run(&mut command);
    }
}

/// A crate that was built: its folder, with the library and the example.
struct Built {
    folder: PathBuf,
    name: &'static str,
}

impl Built {
    fn of(name: &'static str, project: &CProject) -> Self {
        let folder = folder(name);
        for (path, text) in &project.files {
            let path = folder.join(path);
            std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
            // What has not changed is not built again.
            if std::fs::read_to_string(&path).ok().as_ref() != Some(text) {
                std::fs::write(path, text).expect("a file");
            }
        }
        // The versions of the workspace, which are on this machine.
        std::fs::copy(workspace("Cargo.lock"), folder.join("Cargo.lock")).expect("a lock file");
        let mut make = Command::new("make");
        make.args(["example", "BUILD=../build", concat!("CARGO=", env!("CARGO"))]).current_dir(&folder);
        make.arg(format!("PEBO_RUNTIME={}", workspace("pebo-runtime").display()));
        run(make.env("CARGO_NET_OFFLINE", "true").env_remove("CARGO_TARGET_DIR").env_remove("RUSTFLAGS"));
        Self { folder, name }
    }

    fn library(&self) -> PathBuf {
        self.folder.join(format!("../build/host/lib{}_observer.a", self.name))
    }

    /// Compiles a C program with the library and those of other crates, in a language, and runs it.
    fn program(&self, text: &str, (compiler, language, standard): (&str, &str, &str), others: &[&Self]) -> String {
        // Programs of one crate share a place.
        static ONE: Mutex<()> = Mutex::new(());
        let _one = ONE.lock().unwrap_or_else(PoisonError::into_inner);
        let source = self.folder.join("program.c");
        std::fs::write(&source, text).expect("a file");
        let program = self.folder.join("program");
        let mut command = Command::new(compiler);
        command.args(["-x", language, standard]).args(WARNINGS);
        let crates: Vec<&Self> = std::iter::once(self).chain(others.iter().copied()).collect();
        for one in &crates {
            command.arg("-I").arg(one.folder.join("include"));
        }
        command.arg(&source).args(["-x", "none"]).args(crates.into_iter().map(Self::library));
        command.args(["-lpthread", "-ldl", "-lm", "-o"]);
        run(command.arg(&program));
        run(&mut Command::new(&program))
    }

    /// What the example prints, as make built it, and as either language does.
    fn example(&self, project: &CProject) -> Vec<Vec<f64>> {
        let made = run(&mut Command::new(self.folder.join(format!("../build/host/{}_example", self.name))));
        for language in LANGUAGES {
            assert_eq!(self.program(file(project, "example/main.c"), language, &[]), made, "{language:?}");
        }
        made.lines().map(estimates).collect()
    }
}

/// The numbers with all their digits of a line.
fn estimates(line: &str) -> Vec<f64> {
    assert!(!line.contains("fault"), "{line}");
    let number = |part: &str| part.split(')').next().and_then(|text| text.parse().ok());
    line.split('(').skip(1).map(|part| number(part).unwrap_or_else(|| panic!("{line}"))).collect()
}

/// The samples of an example: each line of the table as its numbers.
fn samples(project: &CProject) -> Vec<Vec<f64>> {
    let text = file(project, "example/main.c");
    let table = text.split("samples[] = {\n").nth(1).and_then(|rest| rest.split("\n};").next()).expect("a table");
    let number = |text: &str| text.trim_end_matches('f').parse().unwrap_or_else(|_| panic!("{text} is no number"));
    let row = |line: &str| line.split([' ', '{', '}', ',']).filter(|part| !part.is_empty()).map(number).collect();
    table.lines().map(row).collect()
}

/// The crates that the tests share: two of shipped models, and a cart with a gate and limits in single precision.
static CRATES: LazyLock<[(CProject, Built); 3]> = LazyLock::new(|| {
    let settings = ["observer.gate=30", "observer.limits={p: [-100, 100], F: [-50, 50]}", "observer.gap=1"];
    let built = |name, path, settings: &[&str], scalar| {
        let project = project(path, settings, scalar);
        let built = Built::of(name, &project);
        (project, built)
    };
    [
        built("cuk", "models/cuk.yaml", &[], Scalar::F64),
        built("dc_motor", "models/dc_motor.yaml", &[], Scalar::F64),
        built("cart", "tests/models/cart.yaml", &settings, Scalar::F32),
    ]
});

macro_rules! same_as_in_rust {
    ($($test:ident: $module:ident::$model:ident, $place:literal;)+) => {$(
        #[test]
        fn $test() {
            use pebo_runtime::Real;
            use pebo_runtime::nalgebra::SVector;
            use tests::emitted::$module::{$model, NU, NX, NY, Parameters};
            let (project, built) = &CRATES[$place];
            let (printed, samples) = (built.example(project), samples(project));
            assert_eq!((samples.len(), printed.len()), (40, 40));
            let mut observer = $model::observer(&Parameters::default()).expect("the settings of the model");
            for (sample, printed) in samples.iter().zip(&printed) {
                assert_eq!((sample.len(), printed.len()), (1 + NY + NU, NX));
                let y = SVector::<_, NY>::from_fn(|i, _| Real::from_f64(sample[1 + i]));
                let u = SVector::<_, NU>::from_fn(|i, _| Real::from_f64(sample[1 + NY + i]));
                let x = SVector::<_, NX>::from(observer.step(y, u, Real::from_f64(sample[0])).expect("a good sample"));
                // In single precision the digits are those of a number that is rounded to it.
                let mut read = x;
                read.iter_mut().zip(printed).for_each(|(read, printed)| *read = Real::from_f64(*printed));
                let bits = |value| Real::to_f64(value).to_bits();
                assert_eq!(x.map(bits), read.map(bits), "{x} {read}");
            }
            // The samples are not all alike.
            assert_ne!(printed[0], printed[39]);
        }
    )+};
}

same_as_in_rust! {
    plain_with_parameters: cuk_f64::Cuk, 0;
    generalised_by_least_squares: dc_motor_f64::DcMotor, 1;
    known_numbers_with_a_gate_and_limits: cart_f32::Cart, 2;
}

/// What a C program gets that makes mistakes: the fault, and an observer as before.
#[test]
fn mistakes_of_a_program_are_faults() {
    for language in LANGUAGES {
        let said = CRATES[2].1.program(include_str!("mistakes.c"), language, &[]);
        assert_eq!(said, "as expected\n", "{language:?}");
    }
}

/// Two libraries go into one program, and neither takes an observer of the other.
#[test]
fn two_models_are_in_one_program() {
    let [(_, cuk), (_, motor), _] = &*CRATES;
    let text = include_str!("two_models.c");
    for language in LANGUAGES {
        assert_eq!(cuk.program(text, language, &[motor]), "as expected\n", "{language:?}");
    }
}
