//! Integration tests of the readers and writers, one binary.

mod contacts;
mod crowded;
mod exports;
mod faults;
mod formats;
mod grippers;
mod odd_files;
mod scene_files;
mod shapes;
mod things;
mod write;

/// The folder of shared data, when the environment names it.
#[allow(clippy::print_stderr)]
fn shared() -> Option<std::path::PathBuf> {
    let folder = std::env::var_os("SUPERSURFACE_SHARED").map(std::path::PathBuf::from);
    if folder.is_none() {
        eprintln!("SUPERSURFACE_SHARED is not set: this test over shared data did nothing");
    }
    folder
}
