//! Files that are read, and files that go somewhere: none may replace another.

use std::path::{Path, PathBuf};

use crate::exit::Failure;

/// The places that are taken by inputs and outputs.
pub(crate) struct Places(Vec<PathBuf>);

impl Places {
    /// Files that are read; `-` is none.
    pub(crate) fn read<'a>(files: impl IntoIterator<Item = &'a Path>) -> Self {
        Self(files.into_iter().filter(|p| *p != Path::new("-")).map(place).collect())
    }

    /// Takes the place of an output. Fails when the file is read, or another output goes there.
    pub(crate) fn take(&mut self, option: &str, file: &Path) -> Result<(), Failure> {
        let place = place(file);
        // devices and pipes may take more than one
        if self.0.contains(&place) && (place.is_file() || !place.exists()) {
            let file = file.display();
            let problem =
                format!("{option} {file}: the file is read, or another output goes there");
            return Err(Failure::usage(problem));
        }
        self.0.push(place);
        Ok(())
    }
}

/// Where a path leads, through all links; its file may not be there yet.
fn place(path: &Path) -> PathBuf {
    let folder = path.parent().filter(|f| !f.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let new = || Some(folder.canonicalize().ok()?.join(path.file_name()?));
    path.canonicalize().ok().or_else(new).unwrap_or_else(|| path.to_owned())
}
