//! Where the ladder ends: `cargo bench --bench ladder`.
//!
//! `auto` on the twenty disks of `../shared/corpus`, each from twenty random pairs of boundary pins and three families:
//! 1200 runs. One line a mesh: how many ended planar on which rung, how many steps that took, and the time.
//!
//! `cargo bench --bench ladder -- PAIRS [NAME]` takes so many pairs, on meshes whose name contains NAME, and with
//! `trace` behind it prints every step.

mod common;

use std::fs;
use std::path::Path;
use std::time::Instant;

use freebound::io::read_mesh;
use freebound::mesh::DiskMesh;
use freebound::solver::{Control, Family, Method, Pins, Run, Settings, Step};
use glam::DVec2;

use common::arguments;
use common::machine::print_machine;
use common::sheet::Random;
use common::table::Table;

const PAIRS: usize = 20;

const FAMILIES: [Family; 3] = [Family::Conformal, Family::MeanValue, Family::Wachspress];

/// How the runs on one mesh ended.
#[derive(Default)]
struct Count {
    natural: usize,
    iterate: usize,
    again: usize,
    virtual_free: usize,
    virtual_bent: usize,
    not_planar: usize,
    steps: usize,
    most_steps: usize,
}

fn main() {
    print_machine();
    let arguments = arguments();
    let pairs = arguments.first().and_then(|text| text.parse().ok()).unwrap_or(PAIRS);
    let wanted = arguments.get(1).cloned().unwrap_or_default();
    let trace = arguments.iter().any(|argument| argument == "trace");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/corpus");
    let Ok(entries) = fs::read_dir(&folder) else {
        return println!("nothing to do: there is no corpus at {}", folder.display());
    };
    let mut meshes: Vec<_> = entries.flatten().map(|entry| entry.path()).collect();
    meshes.retain(|path| path.extension().is_some_and(|e| e == "obj"));
    meshes.retain(|path| path.to_string_lossy().contains(&wanted));
    meshes.sort_by_key(|path| fs::metadata(path).map_or(0, |data| data.len()));
    let mut table = Table::new(
        "auto: runs by the rung they ended planar on",
        &[
            "mesh",
            "runs",
            "natural",
            "iterate",
            "started again",
            "virtual boundary, free",
            "convex",
            "not planar",
            "steps",
            "most",
            "s a run",
        ],
    );
    for path in meshes {
        let polygons = read_mesh(&path).expect("a readable mesh").polygons;
        let mesh = DiskMesh::try_from(polygons.triangulate()).expect("a disk");
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let start = Instant::now();
        let mut count = Count::default();
        let mut random = Random(0x1add_e200);
        for pair in 0..pairs {
            let pins = random_pins(&mesh, &mut random);
            for family in FAMILIES {
                if trace {
                    println!("{name} pair {pair} {family}");
                }
                run_one(&mesh, family, &pins, trace, &mut count);
            }
        }
        let runs = pairs * FAMILIES.len();
        let cells = [
            runs,
            count.natural,
            count.iterate,
            count.again,
            count.virtual_free,
            count.virtual_bent,
            count.not_planar,
            count.steps,
            count.most_steps,
        ];
        let [a, b, c, d, e, f, g, h, i] = cells.map(|cell| cell.to_string());
        let row = [name, a, b, c, d, e, f, g, h, i, format!("{:.2}", start.elapsed().as_secs_f64() / runs as f64)];
        println!("{}", row.join("  "));
        table.row(row);
    }
    table.print();
}

/// Two different vertices of the boundary, at their distance in space.
fn random_pins(mesh: &DiskMesh, random: &mut Random) -> Pins {
    let boundary = mesh.boundary_loop();
    let mut pick = || boundary[(random.unit() * boundary.len() as f64) as usize % boundary.len()];
    let first = pick();
    let second = loop {
        let second = pick();
        if second != first {
            break second;
        }
    };
    let distance = mesh.position(first).distance(mesh.position(second));
    Pins::from([(first, DVec2::ZERO), (second, DVec2::new(distance, 0.0))])
}

fn run_one(mesh: &DiskMesh, family: Family, pins: &Pins, trace: bool, count: &mut Count) {
    let mut run = Run::new(Settings::new(Method::Auto, family), pins.clone());
    let (mut last, mut started_again): (Option<Step>, bool) = (None, false);
    let outcome = run.finish(mesh, Control::unattended(), |step| {
        if trace {
            println!(
                "  {} {} flipped {} crossings {} overwound {} turning {:?} move {:?} residual {:.1e} eq {:.1e} bounded {} replaced {} bent {} {:.3}s {}",
                step.index, step.rung.name(), step.verdict.flipped_faces.len(), step.verdict.boundary_crossings.len(),
                step.verdict.overwound_vertices.len(), step.verdict.turning_number, step.max_move, step.solution.residual,
                step.solution.equation_residual, step.solution.bounded_corners, step.solution.replaced_pivots, step.bent_vertices,
                step.seconds(), step.note.as_deref().unwrap_or_default(),
            );
        }
        started_again |= step.rung == Method::Natural && (step.index > 0 || step.note.is_some());
        last = Some(step);
    });
    let Some(last) = last else {
        println!("  error {:?}", outcome);
        count.not_planar += 1;
        return;
    };
    count.steps += last.index + 1;
    count.most_steps = count.most_steps.max(last.index + 1);
    let place = match last.rung {
        _ if !last.verdict.planar => {
            println!("  not planar: {family} {pins:?} {:?} {outcome:?}", last.verdict.summary());
            &mut count.not_planar
        }
        Method::Natural | Method::Iterate if started_again => &mut count.again,
        Method::Natural => &mut count.natural,
        Method::Iterate => &mut count.iterate,
        _ if last.bent_vertices == 0 => &mut count.virtual_free,
        _ => &mut count.virtual_bent,
    };
    *place += 1;
}
