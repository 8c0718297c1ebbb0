//! Where outputs go: links and pipes are written through, plain files are replaced whole.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::symlink;
use std::path::PathBuf;

use supersurface_io::write_labels;

/// A new folder of this test's own.
fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("supersurface-{name}-{}", std::process::id()));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

#[test]
fn a_link_stays_a_link_and_its_target_is_written() {
    let folder = folder("links");
    let [target, link, dangling, special] =
        ["target.npy", "link.npy", "dangling.npy", "special"].map(|n| folder.join(n));
    fs::write(&target, [7; 4096]).unwrap();
    symlink(&target, &link).unwrap();
    symlink("made.npy", &dangling).unwrap();
    symlink("/dev/null", &special).unwrap();
    for file in [&link, &dangling, &special] {
        write_labels(file, &[1, 2, 3]).unwrap();
        assert!(fs::symlink_metadata(file).unwrap().is_symlink(), "{}", file.display());
    }
    let written = fs::read(&target).unwrap();
    assert_eq!(written.len() % 64, 12, "nothing of the old content is left");
    assert_eq!(fs::read(folder.join("made.npy")).unwrap(), written);
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 5, "nothing else is left");
    fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_pipe_is_written_through() {
    let folder = folder("pipe");
    let pipe = folder.join("pipe");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let from = pipe.clone();
    let reader = std::thread::spawn(move || fs::read(from).unwrap());
    write_labels(&pipe, &[5]).unwrap();
    assert!(reader.join().unwrap().starts_with(b"\x93NUMPY"));
    fs::remove_dir_all(&folder).unwrap();
}
