//! Fuzz targets: each module takes random input and panics if a promise is broken.
//!
//! The targets in `fuzz_targets` only call these functions, so that an ordinary test can replay a finding. Targets for
//! file formats take whole files, so that any file of the repository can be a seed.

#[cfg(feature = "c")]
pub mod c;
pub mod filter;
pub mod flow;
#[cfg(feature = "logs")]
pub mod logs;
#[cfg(feature = "scenes")]
pub mod maps;
pub mod ring;
#[cfg(feature = "scenes")]
pub mod scenes;
#[cfg(feature = "schedules")]
pub mod schedules;

/// Asserts that an error in a file takes one line.
#[allow(dead_code)]
fn one_line(error: &str) {
    assert!(!error.is_empty() && !error.contains('\n'), "{error:?}");
}

/// Returns this process's folder for files that are read by path; in memory if possible.
#[allow(dead_code)]
fn folder() -> std::path::PathBuf {
    let memory = std::path::Path::new("/dev/shm");
    let parent = if memory.is_dir() { memory.to_owned() } else { std::env::temp_dir() };
    let folder = parent.join(format!("eeruf-fuzz-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder can be made");
    folder
}
