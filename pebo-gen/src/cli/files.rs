//! Reading and writing: a file is written whole or not at all; a device or a pipe is written to directly.

use std::fs::File;
use std::io::{BufWriter, Read as _, Seek as _, Stdout, Write};
use std::path::{Path, PathBuf};

use crate::analysis::Class;
use crate::source::{Code, Diagnostic, SIZE_LIMIT, Source, Span};
use crate::{Answer, Request, Solution, Tape};
use tempfile::NamedTempFile;

use super::standard::{self, reason};
use super::terminal;

/// The answer on a model file, with the text that its diagnostics refer to.
pub(super) fn answer(path: &Path, request: Request) -> (Source, Answer) {
    answer_with(path, &[], request)
}

/// The same with settings of the call.
pub(super) fn answer_with(path: &Path, settings: &[String], request: Request) -> (Source, Answer) {
    let stem = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    match read_with(path, settings) {
        Ok(source) => {
            let answer = crate::answer(&source, &request.named(stem));
            (source, answer)
        }
        Err(unread) => {
            let (source, diagnostic) = *unread;
            let answer = Answer::of_unread(&stem, vec![diagnostic], &source);
            (source, answer)
        }
    }
}

/// The transforms of a model file's plant, with the text that its diagnostics refer to.
pub(super) fn solve(path: &Path, class: Option<Class>, request: Request) -> (Source, Solution) {
    let stem = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    match read(path) {
        Ok(source) => {
            let solution = crate::solve(&source, class, &request.named(stem));
            (source, solution)
        }
        Err(unread) => {
            let (source, diagnostic) = *unread;
            let solution = Solution::of_unread(&stem, vec![diagnostic], &source);
            (source, solution)
        }
    }
}

/// The answer on a model file with settings of the call, and on a recording, with the text that its diagnostics refer
/// to.
pub(super) fn replay(path: &Path, settings: &[String], request: Request, tape: Tape<'_>) -> (Source, Answer) {
    let stem = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    match read_with(path, settings) {
        Ok(source) => {
            let answer = crate::replay(&source, &request.named(stem), tape);
            (source, answer)
        }
        Err(unread) => {
            let (source, diagnostic) = *unread;
            let answer = Answer::of_unread(&stem, vec![diagnostic], &source);
            (source, answer)
        }
    }
}

/// Reads a model file, or standard input for `-`; the error comes with a source to show it beside.
fn read(path: &Path) -> Result<Source, Box<(Source, Diagnostic)>> {
    let name = if is_standard(path) { "standard input".to_owned() } else { path.display().to_string() };
    let bytes = bytes_of(path).map_err(|error| {
        let message = format!("cannot read {name}: {}", reason(&error));
        let diagnostic =
            Diagnostic::error(Code::CannotRead, Span::NOWHERE, message).help("check the path and the permissions");
        Box::new((Source::unread(&name), diagnostic))
    })?;
    Source::from_bytes(&name, bytes).map_err(|diagnostic| Box::new((Source::unread(&name), diagnostic)))
}

/// The same with settings of the call.
pub(super) fn read_with(path: &Path, settings: &[String]) -> Result<Source, Box<(Source, Diagnostic)>> {
    let unset = |diagnostic| Box::new((Source::unread(path.display().to_string()), diagnostic));
    read(path)?.set(settings).map_err(unset)
}

/// At most the longest model, and one byte more so that the reader sees that it is too long.
fn bytes_of(path: &Path) -> std::io::Result<Vec<u8>> {
    let limit = u64::try_from(SIZE_LIMIT).unwrap_or(u64::MAX).saturating_add(1);
    let mut bytes = Vec::new();
    if is_standard(path) {
        std::io::stdin().lock().take(limit).read_to_end(&mut bytes)?;
    } else {
        File::open(path)?.take(limit).read_to_end(&mut bytes)?;
    }
    Ok(bytes)
}

/// Writes the summary of a run, to standard error where the table of the run goes to standard output.
pub(super) fn summarise(text: &str, table: Option<&Path>) -> Result<(), Diagnostic> {
    if table.is_some_and(is_standard) {
        terminal::say(text);
        return Ok(());
    }
    standard::write(text.as_bytes())
}

/// Writes a file beside its path and moves it there, or to standard output for `-`. A device or a named pipe is written
/// to directly: to replace `/dev/null` by a file would harm the whole system.
pub(super) fn write(path: &Path, text: &str) -> Result<(), Diagnostic> {
    if is_standard(path) {
        return standard::write(text.as_bytes());
    }
    let written = target(path).and_then(|target| match target {
        Target::Stream(mut to) => to.write_all(text.as_bytes()),
        Target::File(place) => replace(&place, text),
    });
    written.map_err(|error| unwritten(path, &error))
}

/// Writes files into a folder, which is made: each by its path in it and its text. None gets its name before all are
/// written.
pub(super) fn write_all(folder: &Path, files: &[(String, String)]) -> Result<(), Diagnostic> {
    if folder.is_file() {
        let message = format!("cannot write {}: it is a file, and a folder is expected", folder.display());
        return Err(
            Diagnostic::error(Code::CannotWrite, Span::NOWHERE, message).help("name a folder, or remove the file")
        );
    }
    let mut written = Vec::new();
    for (path, text) in files {
        let path = folder.join(path);
        let whole = || {
            std::fs::create_dir_all(self::folder(&path))?;
            let mut file = NamedTempFile::new_in(self::folder(&path))?;
            file.write_all(text.as_bytes())?;
            Ok(file)
        };
        let file = whole().map_err(|error| unwritten(&path, &error))?;
        written.push((path, file));
    }
    written.into_iter().try_for_each(|(path, file)| put(file, &path).map_err(|error| unwritten(&path, &error)))
}

/// The target of a path.
enum Target {
    /// A device or a pipe, opened.
    Stream(File),
    /// A file, which is replaced when another is whole.
    File(PathBuf),
}

fn target(path: &Path) -> std::io::Result<Target> {
    match std::fs::metadata(path) {
        Ok(old) if !old.is_file() => File::options().write(true).open(path).map(Target::Stream),
        // A link is kept: its target is replaced.
        Ok(_) => path.canonicalize().map(Target::File),
        Err(_) => Ok(Target::File(path.to_owned())),
    }
}

/// A file that is written part by part, and is there when it is whole; or standard output for `-`. It has no name while
/// it grows, so that nothing is left of it if the program is ended.
pub(super) enum GrowingFile {
    Named(PathBuf, BufWriter<File>),
    Stream(PathBuf, BufWriter<File>),
    Standard(BufWriter<Stdout>),
}

impl GrowingFile {
    pub(super) fn create(path: &Path) -> Result<Self, Diagnostic> {
        if is_standard(path) {
            return Ok(Self::Standard(BufWriter::new(std::io::stdout())));
        }
        let created = target(path).and_then(|target| match target {
            Target::Stream(to) => Ok(Self::Stream(path.to_owned(), BufWriter::new(to))),
            Target::File(place) => {
                let file = tempfile::tempfile_in(folder(&place))?;
                Ok(Self::Named(place, BufWriter::new(file)))
            }
        });
        created.map_err(|error| unwritten(path, &error))
    }

    /// Nothing more will be written.
    pub(super) fn finish(self) -> Result<(), Diagnostic> {
        match self {
            Self::Named(path, file) => {
                let whole = file.into_inner().map_err(std::io::IntoInnerError::into_error);
                whole.and_then(|file| name(file, &path)).map_err(|error| unwritten(&path, &error))
            }
            Self::Stream(path, mut to) => to.flush().map_err(|error| unwritten(&path, &error)),
            Self::Standard(mut output) => match output.flush() {
                Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(standard::unwritten(&error)),
                _ => Ok(()),
            },
        }
    }
}

impl Write for GrowingFile {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        match self {
            Self::Named(_, file) | Self::Stream(_, file) => file.write(bytes),
            // A reader that went away is no error of ours.
            Self::Standard(output) => match output.write(bytes) {
                Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(bytes.len()),
                written => written,
            },
        }
    }

    fn flush(&mut self) -> std::io::Result<()> {
        match self {
            Self::Named(_, file) | Self::Stream(_, file) => file.flush(),
            Self::Standard(output) => output.flush(),
        }
    }
}

fn unwritten(path: &Path, error: &std::io::Error) -> Diagnostic {
    let message = format!("cannot write {}: {}", path.display(), reason(error));
    Diagnostic::error(Code::CannotWrite, Span::NOWHERE, message)
        .help("check that the folder exists and can be written to")
}

fn replace(path: &Path, text: &str) -> std::io::Result<()> {
    let mut file = NamedTempFile::new_in(folder(path))?;
    file.write_all(text.as_bytes())?;
    put(file, path)
}

/// Moves the content of a file without a name to a path.
fn name(mut file: File, path: &Path) -> std::io::Result<()> {
    file.rewind()?;
    let mut named = NamedTempFile::new_in(folder(path))?;
    std::io::copy(&mut file, named.as_file_mut())?;
    put(named, path)
}

fn folder(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Gives a whole file its name.
fn put(file: NamedTempFile, path: &Path) -> std::io::Result<()> {
    file.as_file().sync_all()?;
    #[cfg(unix)]
    {
        // A temporary file is private; a generated one is as readable as any file its author makes.
        use std::os::unix::fs::PermissionsExt as _;
        let mode = std::fs::metadata(path).map_or(0o644, |old| old.permissions().mode());
        file.as_file().set_permissions(std::fs::Permissions::from_mode(mode))?;
    }
    file.persist(path).map_err(|error| error.error)?;
    Ok(())
}

/// The diagnostic for the name of a figure in another format than SVG.
pub(super) fn not_a_figure(path: &Path) -> Option<Diagnostic> {
    let ending = path.extension()?.to_string_lossy().into_owned();
    if ending.eq_ignore_ascii_case("svg") {
        return None;
    }
    let message = format!("{} asks for a figure as {ending}, which is not written", path.display());
    let help = format!("write {}, which other programs turn into {ending}", path.with_extension("svg").display());
    Some(Diagnostic::error(Code::FigureFormat, Span::NOWHERE, message).help(help))
}

pub(super) fn is_standard(path: &Path) -> bool {
    path == Path::new("-")
}
