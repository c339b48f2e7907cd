//! Runs the program over a folder of meshes and judges every layout: `cargo run --release --example mass -- FOLDER OUT.tsv`.
//!
//! `.ci/meshes FOLDER` fetches public meshes. Each mesh is flattened by a process of its own, with one thread and limits
//! of processor time and memory. The judge of the tests looks at the written file; the program's own verdict is only
//! compared with it. `OUT.tsv` gets a row a mesh; meshes that it lists already are skipped. A table follows on standard
//! output.
//!
//! | option | meaning | default |
//! |---|---|---|
//! | `--program FILE` | program to run | the one beside this example |
//! | `--sample N` | so many of the meshes, spread over the folder | all |
//! | `--jobs N` | processes at once | 2 |
//! | `--limit SECONDS` | most processor time of a mesh | 60 |
//! | `--memory MIB` | most memory of a run | 4096 |
//! | `--against OLD.tsv` | earlier run to compare with | none |
//! | `--check` | check the layouts of OBJ files, of any program, instead of flattening | off |
//! | `--strict` | exit status 1 on a panic or a disagreement | off |
//! | `-- ARGUMENTS` | arguments of `flatten` | `--repair all --cut auto --distortion 4.1` |

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs::{self, OpenOptions};
use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use freebound_testkit::judge::{Judgement, judge_obj};
use serde_json::Value;

type Outcome<T> = Result<T, Box<dyn std::error::Error>>;

/// Endings of mesh files.
const ENDINGS: [&str; 5] = ["obj", "off", "ply", "stl", "glb"];

/// Arguments of the runs unless others are given.
const USUAL: [&str; 6] = ["--repair", "all", "--cut", "auto", "--distortion", "4.1"];

/// Exit status of a shell whose program was stopped at the limit of processor time: 128 and the signal SIGXCPU.
const OUT_OF_TIME: i32 = 152;

/// Bounds of the energies in the table.
const ENERGIES: [f64; 4] = [4.2, 8.0, 20.0, 100.0];

/// Ratio of energies, and of seconds, that counts as a change between two runs.
const CHANGE: [f64; 2] = [1.05, 2.0];

/// Seconds below which a change of the time is noise.
const NOISE: f64 = 2.0;

/// Exit status of a shell whose program was killed after its longest time: 128 and the signal SIGKILL.
const STOPPED: i32 = 137;

/// Longest time of a run in terms of its processor time.
const WAITING: u64 = 20;

/// Names of the columns.
const COLUMNS: [&str; 14] = [
    "file", "exit", "seconds", "memory", "faces", "charts", "repairs", "cut", "energy", "planar", "judged", "agrees",
    "kind", "message",
];

fn main() -> Outcome<ExitCode> {
    let options = Options::parse(std::env::args().skip(1))?;
    let mut files: Vec<PathBuf> =
        fs::read_dir(&options.folder)?.map(|entry| Ok(entry?.path())).collect::<Outcome<_>>()?;
    let is_mesh = |path: &PathBuf| ENDINGS.iter().any(|ending| path.extension().is_some_and(|own| own == *ending));
    files.retain(is_mesh);
    files.sort();
    if let Some(sample) = options.sample {
        let step = (files.len() / sample.max(1)).max(1);
        files = files.into_iter().step_by(step).take(sample).collect();
    }
    let done: BTreeSet<String> = rows_of(&options.out).unwrap_or_default().into_keys().collect();
    let left: Vec<&PathBuf> = files.iter().filter(|file| !done.contains(&name_of(file))).collect();
    let out = Mutex::new(OpenOptions::new().create(true).append(true).open(&options.out)?);
    let next = AtomicUsize::new(0);
    let work = || -> Result<(), String> {
        while let Some(file) = left.get(next.fetch_add(1, Ordering::Relaxed)) {
            let row = Row::of(&options, file).map_err(|error| format!("{}: {error}", file.display()))?;
            let mut out = out.lock().map_err(|error| error.to_string())?;
            writeln!(out, "{}", row.line()).and_then(|()| out.flush()).map_err(|error| error.to_string())?;
        }
        Ok(())
    };
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..options.jobs).map(|_| scope.spawn(work)).collect();
        workers.into_iter().try_for_each(|worker| worker.join().map_err(|_| "a worker panicked".to_owned())?)
    })?;
    let rows = rows_of(&options.out)?;
    println!("{}", table(&rows));
    if let Some(before) = &options.against {
        println!("{}", comparison(&rows_of(before)?, &rows));
    }
    let is_bad = |row: &Row| row.kind == "panic" || row.exit == "timeout" || row.agrees == "no";
    let bad: Vec<&String> = rows.iter().filter(|(_, row)| is_bad(row)).map(|(name, _)| name).collect();
    for name in &bad {
        println!("look at {name}: {}", rows[*name].line().replace('\t', " | "));
    }
    let fails = rows.values().any(|row| row.kind == "panic" || row.agrees == "no");
    Ok(ExitCode::from(u8::from(options.strict && fails)))
}

/// Options of the run.
struct Options {
    folder: PathBuf,
    out: PathBuf,
    program: PathBuf,
    sample: Option<usize>,
    jobs: usize,
    /// Most processor time of a run, seconds.
    limit: u64,
    /// Most memory of a run, MiB.
    memory: u64,
    against: Option<PathBuf>,
    strict: bool,
    /// True if layouts are checked and nothing is flattened.
    checks: bool,
    arguments: Vec<String>,
}

impl Options {
    fn parse(mut words: impl Iterator<Item = String>) -> Outcome<Self> {
        let beside = std::env::current_exe()?;
        let program = beside.ancestors().nth(2).ok_or("no folder of the program")?.join("freebound");
        let mut own = Self {
            folder: words.next().ok_or("name a folder of meshes")?.into(),
            out: words.next().ok_or("name a file for the rows")?.into(),
            program,
            sample: None,
            jobs: 2,
            limit: 60,
            memory: 4096,
            against: None,
            strict: false,
            checks: false,
            arguments: USUAL.map(str::to_owned).to_vec(),
        };
        while let Some(word) = words.next() {
            let mut value = || words.next().ok_or_else(|| format!("{word} needs a value"));
            match word.as_str() {
                "--program" => own.program = value()?.into(),
                "--sample" => own.sample = Some(value()?.parse()?),
                "--jobs" => own.jobs = value()?.parse()?,
                "--limit" => own.limit = value()?.parse()?,
                "--memory" => own.memory = value()?.parse()?,
                "--against" => own.against = Some(value()?.into()),
                "--strict" => own.strict = true,
                "--check" => own.checks = true,
                "--" => own.arguments = words.by_ref().collect(),
                other => return Err(format!("unknown option {other}").into()),
            }
        }
        Ok(own)
    }
}

/// Result of one mesh.
#[derive(Clone, Debug, Default)]
struct Row {
    file: String,
    /// Exit status, or `timeout`.
    exit: String,
    /// Processor time.
    seconds: f64,
    /// Peak memory, MiB.
    memory: f64,
    faces: u64,
    charts: usize,
    /// Number of kinds of repairs.
    repairs: usize,
    /// Number of cut edges.
    cut: u64,
    /// Largest mean symmetric Dirichlet energy of a chart.
    energy: f64,
    /// Verdict of the program: `yes`, `no`, or empty.
    planar: String,
    /// Verdict of the judge: `yes`, `no`, or empty.
    judged: String,
    /// `no` if the verdicts contradict each other.
    agrees: String,
    /// Kind of the error, or `panic`.
    kind: String,
    /// Last line on standard error.
    message: String,
}

impl Row {
    /// Flattens a mesh and judges the result.
    fn of(options: &Options, file: &Path) -> Outcome<Self> {
        let folder = tempfile::tempdir()?;
        let [out, report] = ["out.obj", "report.json"].map(|name| folder.path().join(name));
        let judged = if options.checks { file } else { &out };
        let ended = run(options, file, &out, &report)?;
        let report: Value =
            fs::read_to_string(report).ok().and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default();
        let mut row = Self { file: name_of(file), exit: ended.exit, seconds: ended.seconds, ..Self::default() };
        row.take(&report);
        let is_panic = ended.errors.contains("panicked");
        if is_panic {
            row.kind = "panic".into();
        }
        row.message =
            ended.errors.trim().lines().last().unwrap_or_default().replace('\t', " ").chars().take(160).collect();
        if let (Ok(text), "0" | "4") = (fs::read_to_string(judged), row.exit.as_str()) {
            let judgement = judge_obj(&text)?;
            row.compare(&judgement, &report);
        }
        Ok(row)
    }

    /// Takes over what the report says.
    fn take(&mut self, report: &Value) {
        self.memory = report["peak_memory_bytes"].as_f64().unwrap_or_default() / f64::from(1 << 20);
        self.faces = report["mesh"]["faces"].as_u64().unwrap_or_default();
        let repairs = report["mesh"]["repairs"].as_array().cloned().unwrap_or_default();
        self.repairs = repairs.len();
        let is_cut = |repair: &&Value| repair["repair"] == "cut" || repair["repair"] == "cut-seams";
        self.cut = repairs.iter().filter(is_cut).filter_map(|repair| repair["count"].as_u64()).sum();
        let charts = report["charts"].as_array().cloned().unwrap_or_else(|| vec![report.clone()]);
        self.charts = charts.len();
        let energies = charts.iter().filter_map(|chart| chart["distortion"]["symmetric_dirichlet"]["mean"].as_f64());
        self.energy = energies.fold(0.0, f64::max);
        report["error"]["kind"].as_str().unwrap_or_default().clone_into(&mut self.kind);
        let verdicts = [&report["layout"], &report["atlas"], &report["verdict"]];
        let verdict = verdicts.into_iter().find(|verdict| verdict.is_object()).unwrap_or(&Value::Null);
        self.planar = verdict["planar"].as_bool().map(yes_or_no).unwrap_or_default();
    }

    /// Compares the program with the judge. A polygon that is concave in the plane contradicts the program's verdict
    /// alone: the judge accepts any simple polygon.
    fn compare(&mut self, judgement: &Judgement, report: &Value) {
        self.judged = yes_or_no(judgement.is_planar());
        let has_any = |verdict: &Value| verdict["concave_polygons"].as_array().is_some_and(|all| !all.is_empty());
        let charts = report["atlas"]["charts"].as_array().cloned().unwrap_or_default();
        let findings = report["layout"]["findings"].as_array().cloned().unwrap_or_default();
        let is_concave = has_any(&report["verdict"])
            || charts.iter().any(has_any)
            || findings.iter().any(|finding| finding["code"] == "concave-polygon");
        let agrees = self.planar == self.judged || (self.planar == "no" && is_concave);
        self.agrees = yes_or_no(agrees);
        if !agrees {
            self.message = format!("{judgement:?}");
        }
    }

    fn line(&self) -> String {
        let Self { file, exit, seconds, memory, faces, charts, repairs, cut, energy, .. } = self;
        let Self { planar, judged, agrees, kind, message, .. } = self;
        format!(
            "{file}\t{exit}\t{seconds:.2}\t{memory:.0}\t{faces}\t{charts}\t{repairs}\t{cut}\t{energy:.4}\t{planar}\t{judged}\t{agrees}\t{kind}\t{message}"
        )
    }

    fn parse(line: &str) -> Option<Self> {
        let words: Vec<&str> = line.split('\t').collect();
        let text = |column: &str| {
            let place = COLUMNS.iter().position(|name| *name == column)?;
            words.get(place).map(|word| (*word).to_owned())
        };
        let number = |column: &str| text(column)?.parse::<f64>().ok();
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "counts")]
        let count = |column: &str| number(column).map(|x| x as u64);
        let size = |column: &str| usize::try_from(count(column)?).ok();
        Some(Self {
            file: text("file")?,
            exit: text("exit")?,
            seconds: number("seconds")?,
            memory: number("memory")?,
            faces: count("faces")?,
            charts: size("charts")?,
            repairs: size("repairs")?,
            cut: count("cut")?,
            energy: number("energy")?,
            planar: text("planar")?,
            judged: text("judged")?,
            agrees: text("agrees")?,
            kind: text("kind")?,
            message: text("message")?,
        })
    }
}

fn yes_or_no(is_so: bool) -> String {
    if is_so { "yes" } else { "no" }.to_owned()
}

fn name_of(file: &Path) -> String {
    file.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// End of a process.
struct Ended {
    exit: String,
    /// Processor time.
    seconds: f64,
    errors: String,
}

/// Flattens a mesh in a process with limits of processor time and memory. Both are limits of the shell, so that other
/// processes of a busy machine change nothing.
fn run(options: &Options, file: &Path, out: &Path, report: &Path) -> Outcome<Ended> {
    let [errors, times] = [tempfile::NamedTempFile::new()?, tempfile::NamedTempFile::new()?];
    let Options { limit, memory, .. } = options;
    let limits = format!("ulimit -S -t {limit} && ulimit -c 0 && ulimit -v {} || exit 125", memory * 1024);
    // A process that waits for ever uses no processor time.
    let run = format!("timeout -s KILL {} \"$0\" \"$@\"", WAITING * limit);
    let script = format!("times=$1; shift; {limits}; {run}; status=$?; times >\"$times\"; exit $status");
    let mut command = Command::new("sh");
    command.args(["-c", &script]).arg(&options.program).arg(times.path());
    if options.checks {
        command.arg("check").arg(file);
    } else {
        command.arg("flatten").arg(file).args(["--threads", "1", "-o"]).arg(out).args(&options.arguments);
    }
    command.arg("--report").arg(report);
    command.env("RAYON_NUM_THREADS", "1");
    let status = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(errors.reopen()?).status()?;
    let exit = match status.code() {
        Some(OUT_OF_TIME | STOPPED) => "timeout".to_owned(),
        Some(code) => code.to_string(),
        None => status.to_string(),
    };
    let seconds = processor_time(&fs::read_to_string(times.path())?).unwrap_or_default();
    let mut bytes = Vec::new();
    errors.reopen()?.read_to_end(&mut bytes)?;
    Ok(Ended { exit, seconds, errors: String::from_utf8_lossy(&bytes).into_owned() })
}

/// Seconds of the children of a shell, by what its command `times` prints: `1m2.5s 0m0.25s` on the second line.
fn processor_time(text: &str) -> Option<f64> {
    let seconds = |word: &str| {
        let (minutes, seconds) = word.trim_end_matches('s').split_once('m')?;
        Some(minutes.parse::<f64>().ok()? * 60.0 + seconds.parse::<f64>().ok()?)
    };
    text.lines().nth(1)?.split_whitespace().map(seconds).sum()
}

/// Rows of a file, by the names of the meshes.
fn rows_of(path: &Path) -> Outcome<BTreeMap<String, Row>> {
    let text = fs::read_to_string(path)?;
    Ok(text.lines().filter_map(Row::parse).map(|row| (row.file.clone(), row)).collect())
}

/// Table of all rows, in Markdown.
fn table(rows: &BTreeMap<String, Row>) -> String {
    let count = |is_counted: &dyn Fn(&Row) -> bool| rows.values().filter(|row| is_counted(row)).count();
    let mut seconds: Vec<f64> = rows.values().map(|row| row.seconds).collect();
    seconds.sort_by(f64::total_cmp);
    let memory = rows.values().map(|row| row.memory).fold(0.0, f64::max);
    let at = |share: f64| {
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "an index")]
        let place = (share * seconds.len().saturating_sub(1) as f64) as usize;
        seconds.get(place).copied().unwrap_or_default()
    };
    let mut text = String::from("| | meshes |\n|---|--:|\n");
    let mut line = |what: &str, value: String| writeln!(text, "| {what} | {value} |").expect("text grows");
    line("read", (rows.len() - count(&|row| row.exit == "3")).to_string());
    line("refused by name", count(&|row| row.exit == "3").to_string());
    line("repaired", count(&|row| row.repairs > 0).to_string());
    line("cut", count(&|row| row.cut > 0).to_string());
    line("planar, proved and judged", count(&|row| row.exit == "0" && row.judged == "yes").to_string());
    line("not planar", count(&|row| row.exit == "4").to_string());
    line("longer than the limit", count(&|row| row.exit == "timeout").to_string());
    let usual = ["0", "3", "4", "timeout"];
    line("other ends", count(&|row| !usual.contains(&row.exit.as_str())).to_string());
    line("panics", count(&|row| row.kind == "panic").to_string());
    line("verdict and judge disagree", count(&|row| row.agrees == "no").to_string());
    for bound in ENERGIES {
        line(&format!("a chart above energy {bound}"), count(&|row| row.energy > bound).to_string());
    }
    line("processor seconds: median, 95 %, longest", format!("{:.2}, {:.2}, {:.2}", at(0.5), at(0.95), at(1.0)));
    line("most memory, MiB", format!("{memory:.0}"));
    text
}

/// Meshes whose results differ between two runs.
fn comparison(before: &BTreeMap<String, Row>, after: &BTreeMap<String, Row>) -> String {
    let mut text = String::new();
    let mut common = 0;
    for (name, row) in after {
        let Some(old) = before.get(name) else { continue };
        common += 1;
        let [energy, time] = CHANGE;
        let grows = |a: f64, b: f64, by: f64| a > 0.0 && b > 0.0 && (a / b > by || b / a > by);
        let mut what = Vec::new();
        if old.exit != row.exit {
            what.push(format!("exit {} was {}", row.exit, old.exit));
        }
        if grows(old.energy, row.energy, energy) {
            what.push(format!("energy {:.3} was {:.3}", row.energy, old.energy));
        }
        if old.seconds.max(row.seconds) > NOISE && grows(old.seconds, row.seconds, time) {
            what.push(format!("{:.1} s was {:.1} s", row.seconds, old.seconds));
        }
        if !what.is_empty() {
            writeln!(text, "{name}: {}", what.join(", ")).expect("text grows");
        }
    }
    format!("{common} meshes in both runs\n{text}")
}
