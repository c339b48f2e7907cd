//! Numbers of OBJ lines as text.

use std::io::{self, Write};

/// Writes a line without its line end.
pub(crate) fn write_numbers<'a>(
    out: &mut impl Write,
    keyword: &[u8],
    numbers: impl IntoIterator<Item = &'a f64>,
) -> io::Result<()> {
    out.write_all(keyword)?;
    for number in numbers {
        write!(out, " {number:?}")?;
    }
    Ok(())
}

/// Appends decimal digits. Several times faster than `write!`, which matters because most of a file is indices.
pub(crate) fn push_index(line: &mut Vec<u8>, index: u64) {
    let begin = line.len();
    let mut rest = index;
    loop {
        line.push(b'0' + u8::try_from(rest % 10).expect("a digit"));
        rest /= 10;
        if rest == 0 {
            break;
        }
    }
    line[begin..].reverse();
}
