//! Record of one mesh of a batch: a line on standard output, and a file beside the result.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::files::BatchFile;
use freebound_io::{FileStamp, WriteError, write_atomically};

/// End of the name of a record.
const ENDING: &str = ".freebound.json";

/// Record of one mesh. Field names are part of the interface.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub(super) struct Record {
    /// Path of the mesh.
    pub(super) input: PathBuf,
    /// Path of the result. Absent if there is none.
    pub(super) output: Option<PathBuf>,
    /// End of the run.
    pub(super) status: Status,
    /// Exit status of the command. Absent if a signal ended it.
    pub(super) exit_status: Option<u8>,
    /// Verdict, or the reason why there is no result.
    pub(super) message: String,
    /// Duration of the run, seconds.
    pub(super) seconds: f64,
    /// Number of triangles.
    pub(super) faces: Option<u64>,
    /// Number of charts.
    pub(super) charts: Option<u64>,
    /// Largest mean symmetric Dirichlet energy of a chart; 4 is an isometric map.
    pub(super) energy: Option<f64>,
    /// Peak memory of the run, bytes.
    pub(super) peak_memory_bytes: Option<u64>,
    /// SHA-256 of the mesh. Absent if it cannot be read.
    pub(super) input_sha256: Option<String>,
    /// SHA-256 of the result.
    pub(super) output_sha256: Option<String>,
    /// Command and its options.
    pub(super) options: Vec<String>,
    /// SHA-256 of the files that options name.
    pub(super) option_files: BTreeMap<String, String>,
    /// Version of the program.
    pub(super) freebound: String,
    /// True if the result is that of an earlier run.
    #[serde(default)]
    pub(super) resumed: bool,
}

/// End of the run of one mesh, from the best to the worst.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Status {
    /// Planar and proved, constraints met.
    Proved,
    /// Not planar, a constraint not met, or the method failed.
    NotProved,
    /// The mesh cannot be used.
    Refused,
    /// An internal or system error, or a signal.
    Failed,
}

/// Command of a batch with its options, and the files that they name.
#[derive(Clone, Debug, Default)]
pub(super) struct BatchOptions {
    /// Command and options.
    pub(super) words: Vec<String>,
    /// SHA-256 of each file that an option names.
    pub(super) files: BTreeMap<String, String>,
}

impl BatchOptions {
    /// Options of these words. The value of an option is a word, or the end of a word behind `=` or `:`.
    pub(super) fn of(words: &[OsString]) -> Self {
        let words: Vec<String> = words.iter().map(|word| word.to_string_lossy().into_owned()).collect();
        let values = |word: &String| {
            let ends = ['=', ':'].map(|sign| word.split_once(sign).map(|(_, end)| end.to_owned()));
            std::iter::once(word.clone()).chain(ends.into_iter().flatten()).collect::<Vec<_>>()
        };
        let files = words.iter().flat_map(values).filter(|value| Path::new(value).is_file());
        let files = files.filter_map(|file| Some((file.clone(), FileStamp::read(Path::new(&file)).ok()?.sha256)));
        Self { files: files.collect(), words }
    }
}

impl Record {
    /// Path of the record of a mesh.
    pub(super) fn path(file: &BatchFile) -> PathBuf {
        let mut name = file.output.clone().into_os_string();
        name.push(ENDING);
        name.into()
    }

    /// Record of an earlier run, if mesh, options, version and result have not changed. A mesh with files of its own is
    /// run again.
    pub(super) fn kept(file: &BatchFile, options: &BatchOptions, input: Option<&str>) -> Option<Self> {
        let has_files = file.input.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("gltf"));
        let text = fs::read(Self::path(file)).ok().filter(|_| !has_files)?;
        let record: Self = serde_json::from_slice(&text).ok()?;
        let has_options = record.options == options.words && record.option_files == options.files;
        let is_of_run = has_options && record.freebound == env!("CARGO_PKG_VERSION");
        let is_of_input = input.is_some() && record.input_sha256.as_deref() == input;
        let is_whole = match &record.output_sha256 {
            Some(digest) => FileStamp::read(&file.output).is_ok_and(|stamp| stamp.sha256 == *digest),
            None => true,
        };
        let is_final = record.status != Status::Failed;
        let output = record.output.as_ref().map(|_| file.output.clone());
        let is_kept = is_of_run && is_of_input && is_whole && is_final;
        is_kept.then_some(Self { input: file.input.clone(), output, resumed: true, ..record })
    }

    /// Writes the record beside the result.
    pub(super) fn write(&self, file: &BatchFile) -> Result<(), WriteError> {
        write_atomically(&Self::path(file), |out| Ok(serde_json::to_writer(out, self)?))
    }

    /// Takes over the numbers of a report.
    pub(super) fn read_report(&mut self, path: &Path) {
        let Some(report) = fs::read(path).ok().and_then(|text| serde_json::from_slice::<Value>(&text).ok()) else {
            return;
        };
        self.faces = report["mesh"]["faces"].as_u64();
        let energy = |of: &Value| of["distortion"]["symmetric_dirichlet"]["mean"].as_f64();
        if let Some(charts) = report["charts"].as_array() {
            self.charts = Some(charts.len() as u64);
            self.energy = charts.iter().filter_map(energy).reduce(f64::max);
        } else {
            self.charts = self.faces.map(|_| 1);
            self.energy = energy(&report);
        }
        self.peak_memory_bytes = report["peak_memory_bytes"].as_u64();
        if let Some(message) = report["error"]["message"].as_str() {
            message.clone_into(&mut self.message);
        }
    }
}
