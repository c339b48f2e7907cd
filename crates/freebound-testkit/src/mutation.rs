//! Mutations of whole mesh files that know the structure of their formats: numbers and indices of text, words of binary
//! files, lines, JSON of glTF containers whose lengths are kept right.

use freebound_core::geom::Random;
use serde_json::{Value, json};

use crate::glb::glb_of;

/// Numbers that readers get wrong: limits of integers and floats, and text that is almost a number.
const NUMBERS: [&str; 26] = [
    "0",
    "-0",
    "1",
    "-1",
    "2",
    "3",
    "255",
    "256",
    "65535",
    "65536",
    "2147483647",
    "-2147483648",
    "4294967295",
    "4294967296",
    "18446744073709551616",
    "1e-320",
    "1e308",
    "-1e308",
    "1e39",
    "1e999",
    "nan",
    "inf",
    "-inf",
    "0x10",
    "1.",
    "1e",
];

/// Words of 32 bits that readers get wrong: counts, indices, and floats that are infinite, no numbers, or tiny.
const WORDS: [u32; 14] = [
    0,
    1,
    2,
    3,
    0x7f,
    0xff,
    0xffff,
    0x7fff_ffff,
    0x8000_0000,
    0xffff_ffff,
    0x7f80_0000,
    0x7fc0_0000,
    0x0000_0001,
    0x7f7f_ffff,
];

/// Changes a file once to eight times. `seed` decides everything.
pub fn mutated(file: &[u8], seed: u64) -> Vec<u8> {
    let mut random = Random(seed);
    let mut bytes = file.to_vec();
    for _ in 0..=random.below(8) {
        bytes = match container(&bytes) {
            Some((json, binary)) if random.below(4) > 0 => container_mutated(json, binary, &mut random),
            _ if is_text(&bytes) => text_mutated(&bytes, &mut random),
            _ => binary_mutated(bytes, &mut random),
        };
    }
    bytes
}

fn is_text(bytes: &[u8]) -> bool {
    !bytes.contains(&0) && std::str::from_utf8(bytes).is_ok()
}

/// JSON and binary chunk of a GLB file.
fn container(bytes: &[u8]) -> Option<(Value, Vec<u8>)> {
    let word = |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?) as usize);
    if bytes.get(..4)? != b"glTF" {
        return None;
    }
    let length = word(12)?;
    let json = serde_json::from_slice(bytes.get(20..20_usize.checked_add(length)?)?).ok()?;
    let begin = 20 + length;
    let binary = word(begin).and_then(|length| bytes.get(begin + 8..begin.checked_add(8 + length)?));
    Some((json, binary.unwrap_or_default().to_vec()))
}

fn container_mutated(mut json: Value, mut binary: Vec<u8>, random: &mut Random) -> Vec<u8> {
    if random.below(3) == 0 {
        binary = binary_mutated(binary, random);
    } else {
        let count = count_of(&json);
        let mut place = random.index(count.max(1));
        mutate_value(&mut json, &mut place, random);
    }
    glb_of(&json, &binary)
}

/// Number of values within a JSON value, itself included.
fn count_of(json: &Value) -> usize {
    1 + match json {
        Value::Array(all) => all.iter().map(count_of).sum(),
        Value::Object(fields) => fields.values().map(count_of).sum(),
        _ => 0,
    }
}

/// Changes the value at a place, counted in depth-first order.
fn mutate_value(json: &mut Value, place: &mut usize, random: &mut Random) -> bool {
    if *place == 0 {
        *json = other_value(json, random);
        return true;
    }
    *place -= 1;
    match json {
        Value::Array(all) => all.iter_mut().any(|inner| mutate_value(inner, place, random)),
        Value::Object(fields) => fields.values_mut().any(|inner| mutate_value(inner, place, random)),
        _ => false,
    }
}

fn other_value(json: &Value, random: &mut Random) -> Value {
    let special = NUMBERS[random.index(NUMBERS.len())];
    match (json, random.below(5)) {
        (Value::Number(number), 0) => number.as_i64().map_or(json!(null), |number| json!(number + 1)),
        (Value::Number(_), 1) => json!(random.below(40)),
        (Value::Number(_), _) => serde_json::from_str(special).unwrap_or(json!(-1)),
        (Value::Array(all), 0 | 1) if !all.is_empty() => {
            let mut fewer = all.clone();
            fewer.remove(random.index(all.len()));
            json!(fewer)
        }
        (Value::Array(all), 2 | 3) if !all.is_empty() => {
            let mut more = all.clone();
            more.push(all[random.index(all.len())].clone());
            json!(more)
        }
        (Value::Object(fields), 0..=3) if !fields.is_empty() => {
            let mut fewer = fields.clone();
            let name = fields.keys().nth(random.index(fields.len())).cloned().unwrap_or_default();
            fewer.remove(&name);
            json!(fewer)
        }
        (Value::String(text), 0) => json!(format!("{text}{text}")),
        (_, 0) => json!([]),
        (_, 1) => json!({}),
        (_, 2) => json!(special),
        (_, 3) => json!(null),
        _ => json!(random.below(1000)),
    }
}

fn text_mutated(bytes: &[u8], random: &mut Random) -> Vec<u8> {
    let mut lines: Vec<Vec<u8>> = bytes.split(|&byte| byte == b'\n').map(<[u8]>::to_vec).collect();
    let (at, other) = (random.index(lines.len()), random.index(lines.len()));
    match random.below(10) {
        0 => drop(lines.remove(at)),
        1 => lines.insert(at, lines[other].clone()),
        2 => lines.swap(at, other),
        3 => lines.truncate(at + 1),
        4 => lines[at] = byte_mutated(std::mem::take(&mut lines[at]), random),
        _ => lines[at] = word_mutated(&lines[at], random),
    }
    lines.join(&b'\n')
}

/// Line with one of its words changed. Parts between slashes count as words.
fn word_mutated(line: &[u8], random: &mut Random) -> Vec<u8> {
    let is_gap = |byte: &u8| byte.is_ascii_whitespace() || *byte == b'/';
    let mut words: Vec<Vec<u8>> = line.chunk_by(|a, b| is_gap(a) == is_gap(b)).map(<[u8]>::to_vec).collect();
    if words.is_empty() {
        return NUMBERS[random.index(NUMBERS.len())].into();
    }
    let (at, other) = (random.index(words.len()), random.index(words.len()));
    match random.below(6) {
        0 => drop(words.remove(at)),
        1 => words.insert(at, words[other].clone()),
        2 => words.swap(at, other),
        3 => words[at] = random.below(50).to_string().into(),
        _ => words[at] = NUMBERS[random.index(NUMBERS.len())].into(),
    }
    words.concat()
}

fn byte_mutated(mut bytes: Vec<u8>, random: &mut Random) -> Vec<u8> {
    let byte = u8::try_from(random.below(256)).expect("a byte");
    match (bytes.is_empty(), random.below(3)) {
        (true, _) => bytes.push(byte),
        (false, 0) => drop(bytes.remove(random.index(bytes.len()))),
        (false, 1) => bytes.insert(random.index(bytes.len()), byte),
        _ => {
            let at = random.index(bytes.len());
            bytes[at] = byte;
        }
    }
    bytes
}

fn binary_mutated(mut bytes: Vec<u8>, random: &mut Random) -> Vec<u8> {
    if bytes.len() < 8 {
        return byte_mutated(bytes, random);
    }
    match random.below(8) {
        0 => bytes.truncate(random.index(bytes.len())),
        1 => {
            let at = random.index(bytes.len());
            let end = (at + 1 + random.index(16)).min(bytes.len());
            bytes.drain(at..end);
        }
        2 => {
            let at = random.index(bytes.len());
            let end = (at + 1 + random.index(16)).min(bytes.len());
            let copy = bytes[at..end].to_vec();
            bytes.splice(at..at, copy);
        }
        3 | 4 => bytes = byte_mutated(bytes, random),
        _ => {
            // Headers are text or counts: their words are hit as often as all others.
            let most = if random.below(2) == 0 { bytes.len() } else { bytes.len().min(128) };
            let at = random.index(most - 4);
            let word = WORDS[random.index(WORDS.len())];
            let word = if random.below(2) == 0 { word.to_le_bytes() } else { word.to_be_bytes() };
            bytes[at..at + 4].copy_from_slice(&word);
        }
    }
    bytes
}
