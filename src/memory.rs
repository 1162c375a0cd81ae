//! Whether the machine can hold what is asked for, before hours are spent on it.

use std::fs;
use std::path::Path;

use protocols::InputError;
use renderer::ImageRequest;

/// Refuses an image that needs more memory than is free; `scene` is only named in the error.
///
/// On a system that does not say what is free (no `/proc/meminfo`) nothing is refused.
pub(crate) fn check(scene: &Path, request: &ImageRequest) -> Result<(), InputError> {
    let meminfo = fs::read_to_string("/proc/meminfo").unwrap_or_default();
    match available_bytes(&meminfo) {
        Some(available) if request.memory_bytes() > available => {
            let gigabytes = |bytes: u64| format!("{:.1} GB", bytes as f64 / 1e9);
            let found = format!(
                "an image that takes about {}",
                gigabytes(request.memory_bytes())
            );
            let expected = format!("no more than the {} that are free", gigabytes(available));
            let remedy = "ask for fewer rays or pixels";
            Err(InputError::new(scene, found, expected)
                .at("memory")
                .remedy(remedy))
        }
        _ => Ok(()),
    }
}

fn available_bytes(meminfo: &str) -> Option<u64> {
    let line = meminfo
        .lines()
        .find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kib: u64 = line.split_whitespace().next()?.parse().ok()?;
    kib.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The form of proc(5): a name, kibibytes, `kB`.
    #[test]
    fn the_free_memory_is_read_from_its_line() {
        let meminfo = "MemTotal:  24000000 kB\nMemFree:   100 kB\nMemAvailable:   23000000 kB\n";
        assert_eq!(available_bytes(meminfo), Some(23_552_000_000));
        for wrong in [
            "",
            "MemAvailable:",
            "MemAvailable: many kB",
            "MemAvailable: -1 kB",
        ] {
            assert_eq!(available_bytes(wrong), None, "{wrong}");
        }
    }
}
