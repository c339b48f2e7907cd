//! Memory figures of the operating system (Linux; unknown elsewhere), and memory sizes as text.

/// Units of memory, each with its power of two.
const UNITS: [(&str, u32); 6] = [("KiB", 10), ("MiB", 20), ("GiB", 30), ("TiB", 40), ("PiB", 50), ("EiB", 60)];

/// Peak memory of this process so far. Known on Linux only.
pub fn peak_memory_bytes() -> Option<u64> {
    bytes_in("/proc/self/status", "VmHWM:")
}

/// Total memory of the machine. Known on Linux only.
pub fn machine_memory_bytes() -> Option<u64> {
    bytes_in("/proc/meminfo", "MemTotal:")
}

/// Value of a line of a system file: a name, a number, and `kB`, here units of 1024 bytes.
fn bytes_in(file: &str, name: &str) -> Option<u64> {
    let text = std::fs::read_to_string(file).ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}

/// Text for a number of bytes, in the largest unit that they fill.
pub fn bytes_in_words(bytes: u64) -> String {
    match UNITS.iter().rev().find(|&&(_, power)| bytes >> power > 0) {
        Some((unit, power)) => format!("{:.1} {unit}", bytes as f64 / (1_u64 << power) as f64),
        None => format!("{bytes} bytes"),
    }
}
