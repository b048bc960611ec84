//! The memory that a header sets aside, beside the size of what goes there.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use pebo_gen::emit::Scalar;
use pebo_gen::source::Source;
use pebo_gen::{Answer, CProject, Request, derive};
use tests::emitted::SIZES;

use super::{program, source};

/// The bytes that the header sets aside.
fn bytes(project: &CProject) -> usize {
    let header = project.files.iter().find(|file| file.0.starts_with("include/")).expect("a header");
    let words = header.1.lines().find_map(|line| line.strip_prefix("#define ")?.split_once("_WORDS "));
    8 * words.expect("a number of words").1.parse::<usize>().expect("a number")
}

/// The bytes hold the observer, its tag and the start of its extension, and are not many more.
fn compare(name: &str, bytes: usize, observer: usize) {
    assert!(bytes >= observer + 16, "{name}: {bytes} bytes for {observer}");
    assert!(10 * bytes <= 13 * observer + 640, "{name}: {bytes} bytes for {observer}");
}

fn projects(path: &Path) -> Vec<(Scalar, Option<CProject>)> {
    let source: Source = source(path, &[]);
    let derived = derive(&source).expect("a model of the project");
    let project = |scalar| Answer::on(&derived, &source, &Request::new().emit(scalar).c_project()).c_project;
    Scalar::ALL.into_iter().map(|scalar| (scalar, project(scalar))).collect()
}

/// All models that have an observer have a face; and their headers are taken together by C and C++.
#[test]
fn every_observer_has_room_and_every_header_compiles() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths: Vec<PathBuf> = Vec::new();
    for folder in ["../models", "models"] {
        let entries = std::fs::read_dir(here.join(folder)).expect("a folder of models");
        paths.extend(entries.flatten().map(|e| e.path()).filter(|p| p.extension().is_some_and(|e| e == "yaml")));
    }
    paths.sort();
    let halves = paths.chunks(paths.len().div_ceil(2));
    let found: Vec<(String, Scalar, Option<CProject>)> = std::thread::scope(|scope| {
        let of = |path: &PathBuf| {
            let name = path.file_stem().expect("a file").to_string_lossy().into_owned();
            projects(path).into_iter().map(move |(scalar, project)| (name.clone(), scalar, project))
        };
        let threads: Vec<_> =
            halves.map(|half| scope.spawn(move || half.iter().flat_map(of).collect::<Vec<_>>())).collect();
        threads.into_iter().flat_map(|thread| thread.join().expect("models of the project")).collect()
    });
    let sizes: BTreeMap<(&str, &str), usize> =
        SIZES.iter().map(|&(name, scalar, size)| ((name, scalar), size)).collect();
    let mut headers = Vec::new();
    for (name, scalar, project) in &found {
        let size = sizes.get(&(name.as_str(), scalar.name()));
        assert_eq!(project.is_some(), size.is_some(), "{name}");
        if let (Some(project), Some(size)) = (project, size) {
            compare(&format!("{name} in {}", scalar.name()), bytes(project), *size);
            if *scalar == Scalar::F64 {
                headers.extend(project.files.iter().filter(|file| file.0.starts_with("include/")));
            }
        }
    }
    assert!(headers.len() > 30, "only {} headers", headers.len());
    program::check_headers(&headers);
}

macro_rules! estimators {
    ($($name:ident: $file:literal,)+) => {$(
        mod $name {
            #[pebo_macros::pebo_model($file)]
            pub(crate) mod plant {}
        }
    )+

        /// The models of the project do not use every estimator.
        #[test]
        fn every_estimator_has_room() {
            $({
                let (_, project) = projects(&Path::new(env!("CARGO_MANIFEST_DIR")).join($file)).swap_remove(0);
                compare($file, bytes(&project.expect($file)), size_of::<$name::plant::Tuned>());
            })+
        }
    };
}

estimators! {
    gradient_by_window: "tests/settings/gradient_by_window.yaml",
    normalised_gradient: "tests/settings/normalised_gradient.yaml",
    least_squares: "tests/settings/least_squares.yaml",
    drem: "tests/settings/drem.yaml",
    finite_time_drem: "tests/settings/finite_time_drem.yaml",
    gradient_drem: "tests/settings/gradient_drem.yaml",
    least_squares_drem: "tests/settings/least_squares_drem.yaml",
}
