//! Reading and writing: a file is written whole or not at all; a device or a pipe is written to where it stands.

use std::io::{Read as _, Write as _};
use std::path::Path;

use pebo_gen::analysis::Class;
use pebo_gen::source::{Code, Diagnostic, SIZE_LIMIT, Source, Span};
use pebo_gen::{Answer, Ask, Solution};

use super::standard::{self, reason};

/// The answer on a model file, with the text that its diagnostics are about.
pub(super) fn answer(path: &Path, ask: Ask) -> (Source, Answer) {
    let stem = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    match read(path) {
        Ok(source) => {
            let answer = pebo_gen::answer(&source, &ask.named(stem));
            (source, answer)
        }
        Err(unread) => {
            let (source, diagnostic) = *unread;
            let answer = Answer::of_unread(&stem, vec![diagnostic], &source);
            (source, answer)
        }
    }
}

/// The transforms of a model file's plant, with the text that its diagnostics are about.
pub(super) fn solve(path: &Path, class: Option<Class>, ask: Ask) -> (Source, Solution) {
    let stem = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    match read(path) {
        Ok(source) => {
            let solution = pebo_gen::solve(&source, class, &ask.named(stem));
            (source, solution)
        }
        Err(unread) => {
            let (source, diagnostic) = *unread;
            let solution = Solution::of_unread(&stem, vec![diagnostic], &source);
            (source, solution)
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

/// At most what a model can have, and one byte more so that the reader sees that it is too much.
fn bytes_of(path: &Path) -> std::io::Result<Vec<u8>> {
    let limit = u64::try_from(SIZE_LIMIT).unwrap_or(u64::MAX).saturating_add(1);
    let mut bytes = Vec::new();
    if is_standard(path) {
        std::io::stdin().lock().take(limit).read_to_end(&mut bytes)?;
    } else {
        std::fs::File::open(path)?.take(limit).read_to_end(&mut bytes)?;
    }
    Ok(bytes)
}

/// Writes a file beside its place and moves it there, or to standard output for `-`. What is no file, as a device or a
/// named pipe, is written to: to put a file in the place of `/dev/null` would harm the whole system.
pub(super) fn write(path: &Path, text: &str) -> Result<(), Diagnostic> {
    if is_standard(path) {
        return standard::write(text.as_bytes());
    }
    let written = match std::fs::metadata(path) {
        Ok(old) if !old.is_file() => {
            std::fs::File::options().write(true).open(path).and_then(|mut to| to.write_all(text.as_bytes()))
        }
        // A link stays one: what it leads to is replaced.
        Ok(_) => path.canonicalize().and_then(|place| replace(&place, text)),
        Err(_) => replace(path, text),
    };
    written.map_err(|error| {
        let message = format!("cannot write {}: {}", path.display(), reason(&error));
        Diagnostic::error(Code::CannotWrite, Span::NOWHERE, message)
            .help("check that the folder exists and can be written to")
    })
}

fn replace(path: &Path, text: &str) -> std::io::Result<()> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut file = tempfile::NamedTempFile::new_in(folder)?;
    file.write_all(text.as_bytes())?;
    file.as_file().sync_all()?;
    #[cfg(unix)]
    {
        // A temporary file is private; what is generated is as readable as any file its author makes.
        use std::os::unix::fs::PermissionsExt as _;
        let mode = std::fs::metadata(path).map_or(0o644, |old| old.permissions().mode());
        file.as_file().set_permissions(std::fs::Permissions::from_mode(mode))?;
    }
    file.persist(path).map_err(|error| error.error)?;
    Ok(())
}

pub(super) fn is_standard(path: &Path) -> bool {
    path == Path::new("-")
}
