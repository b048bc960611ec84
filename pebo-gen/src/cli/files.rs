//! Reading and writing: a file is written whole or not at all.

use std::io::{Read as _, Write as _};
use std::path::Path;

use pebo_gen::Derived;
use pebo_gen::source::{Code, Diagnostic, SIZE_LIMIT, Source, Span};

use super::arguments::Limit;
use super::{Ending, standard, terminal};

/// Reads a model file, or standard input for `-`; the error comes with a source to show it beside.
pub(super) fn read(path: &Path) -> Result<Source, Box<(Source, Diagnostic)>> {
    let name = if is_standard(path) { "standard input".to_owned() } else { path.display().to_string() };
    let bytes = bytes_of(path).map_err(|error| {
        let message = format!("cannot read {name}: {}", reason(&error));
        let diagnostic =
            Diagnostic::error(Code::CannotRead, Span::NOWHERE, message).help("check the path and the permissions");
        Box::new((Source::unread(&name), diagnostic))
    })?;
    Source::from_bytes(&name, bytes).map_err(|diagnostic| Box::new((Source::unread(&name), diagnostic)))
}

/// Reads and derives a model; what is wrong with it is reported.
pub(super) fn derive(path: &Path, limit: Limit) -> Result<(Source, Derived), Ending> {
    let source = match read(path) {
        Ok(source) => source,
        Err(unread) => {
            let (source, diagnostic) = *unread;
            terminal::report(&[diagnostic], &source);
            return Err(Ending::Malformed);
        }
    };
    match pebo_gen::derive_within(&source, limit.budget()) {
        Ok(derived) => Ok((source, derived)),
        Err(diagnostics) => {
            terminal::report(&diagnostics, &source);
            Err(Ending::of_unread(&diagnostics))
        }
    }
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

/// Writes a file beside its place and moves it there, or to standard output for `-`.
pub(super) fn write(path: &Path, text: &str) -> Result<(), Diagnostic> {
    if is_standard(path) {
        return standard::write(text.as_bytes());
    }
    replace(path, text).map_err(|error| {
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

/// The operating system's reason, without the number it puts behind it.
pub(super) fn reason(error: &std::io::Error) -> String {
    let text = error.to_string();
    let plain = text.split(" (os error").next().unwrap_or(&text);
    let mut letters = plain.chars();
    letters.next().map(|first| first.to_lowercase().chain(letters).collect()).unwrap_or_default()
}
