//! Surfaces flattened with filled holes. Each result without its filling is checked against the verdict on charts,
//! which ignores fillings but checks every loop.

use freebound_testkit::surfaces::without_faces;
use std::collections::BTreeSet;

use freebound_core::flatten::{Ending, Flattener, Step};
use freebound_core::mesh::{
    DiskMesh, FIRST_HOLE, HoleTreatment, PolygonMesh, Preparation, Repair, Repaired, Repairs, TriMesh, VertexId,
    diagnose, parts,
};
use freebound_core::problem::{
    Control, Embedding, Family, Method, NamedOption as _, Pin, Pins, Settings, SolveError, Stage,
};
use freebound_core::verify::{AtlasVerdict, atlas_verdict, distortion, verdict};
use glam::{DVec2, DVec3};

use freebound_testkit::{Random, band, disk, grid, quad_sheet};

fn filled(mesh: &PolygonMesh) -> (Repaired, DiskMesh) {
    let repaired = Preparation::default().repaired(mesh);
    let disk = DiskMesh::try_from(repaired.triangulate()).unwrap_or_else(|faults| panic!("{faults}"));
    (repaired, disk)
}

/// Number of filled holes.
fn count(repaired: &Repaired) -> usize {
    repaired.done().iter().find(|done| done.repair == Repair::FillHoles).map_or(0, |done| done.count)
}

/// Verdict on the map without the filling.
fn peeled(repaired: &Repaired, embedding: &Embedding) -> AtlasVerdict {
    let mesh = repaired.polygons().triangulate();
    let charts = parts(&mesh).unwrap_or_else(|faults| panic!("{faults}"));
    assert_eq!(charts.len(), 1);
    assert_eq!(charts[0].loops().len(), 1 + count(repaired));
    atlas_verdict(&charts, embedding)
}

/// Sheet of quads with some inner quads removed.
fn holed_sheet(random: &mut Random, side: u32, roughness: f64) -> PolygonMesh {
    let sheet = quad_sheet(side, side, roughness, random);
    loop {
        let left_out: BTreeSet<usize> = (0..=random.below(side))
            .map(|_| (1 + random.below(side - 2)) * side + 1 + random.below(side - 2))
            .map(|face| face as usize)
            .collect();
        let mesh = without_faces(&sheet, |face| left_out.contains(&face));
        if DiskMesh::try_from(Preparation::default().repaired(&mesh).triangulate()).is_ok() {
            return mesh;
        }
    }
}

fn steps_of(mesh: &DiskMesh, settings: Settings, pins: &Pins) -> Result<(Vec<Step>, Ending), SolveError> {
    let mut steps = Vec::new();
    let mut ladder = Flattener::new(settings, pins.clone());
    let ending = ladder.finish(mesh, Control::unattended(), |step| steps.push(step))?;
    Ok((steps, ending))
}

#[test]
fn an_embedding_is_planar_where_its_surface_is_proved_by_its_loops_and_only_there() {
    let mut random = Random(11);
    let (mut planar, mut folded) = (0, 0);
    for case in 0..600 {
        let mesh = holed_sheet(&mut random, 4 + case % 3, 0.0);
        let (repaired, disk) = filled(&mesh);
        let disturb = f64::from(random.below(6)) * 0.3;
        let mirror = if random.below(4) == 0 { DVec2::new(-1.0, 1.0) } else { DVec2::ONE };
        let mut place = |p: &DVec3| mirror * (p.truncate() + disturb * DVec2::new(random.unit(), random.unit()));
        let embedding: Embedding = disk.mesh().positions.iter().map(&mut place).collect();
        let (found, expected) = (verdict(&disk, &embedding), peeled(&repaired, &embedding));
        assert_eq!(found.planar, expected.planar, "case {case}: {} and {}", found.summary(), expected.summary());
        assert_eq!(found.planar_in_f32, expected.planar_in_f32, "case {case}");
        assert_eq!(found.mirrored, expected.charts[0].mirrored, "case {case}");
        assert_eq!(found.flipped_faces, expected.charts[0].flipped_faces, "case {case}");
        planar += usize::from(found.planar);
        folded += usize::from(found.planar && !found.is_one_to_one());
    }
    assert!((100..500).contains(&planar) && folded > 10, "all occur: {planar}, {folded} with a folded filling");
}

#[test]
fn a_hole_that_crosses_itself_alone_is_named() {
    // A square ring around a square: its inner loop is pulled through itself, and no face flips.
    let ring = without_faces(&quads(3), |face| face == 4);
    let (repaired, disk) = filled(&ring);
    let mut embedding: Embedding = disk.mesh().positions.iter().map(|p| p.truncate()).collect();
    assert!(verdict(&disk, &embedding).planar);
    let inner = [5, 6, 10, 9].map(VertexId::new);
    assert_eq!(disk.mesh().holes()[0].rim, inner, "counter-clockwise around the hole, the lowest first");
    // The two lower corners swap with the upper ones: the hole turns inside out, and some faces with it.
    for v in inner {
        embedding[v].y = 3.0 - embedding[v].y;
    }
    let found = verdict(&disk, &embedding);
    assert_eq!((found.crossed_holes, found.planar), (vec![VertexId::new(5)], false));
    assert!(!peeled(&repaired, &embedding).planar);
}

/// Flat sheet of unit quads.
fn quads(side: u32) -> PolygonMesh {
    let mut mesh = quad_sheet(side, side, 0.0, &mut Random(1));
    mesh.positions.iter_mut().for_each(|p| p.z = 0.0);
    mesh
}

#[test]
fn every_method_flattens_sheets_with_random_holes() {
    let mut random = Random(5);
    for case in 0..12 {
        let mesh = holed_sheet(&mut random, 6 + case % 4, 0.1);
        let (repaired, disk) = filled(&mesh);
        assert!(count(&repaired) > 0);
        for method in Method::ALL.iter().cloned() {
            let settings = Settings { relax_rounds: Some(1), ..Settings::new(method.clone(), Family::default()) };
            let (steps, _) =
                steps_of(&disk, settings, &Pins::new()).unwrap_or_else(|error| panic!("{method:?}: {error}"));
            for step in &steps {
                let of = step.candidate.mesh(&disk);
                assert_eq!(
                    of.mesh().real_face_count(),
                    disk.mesh().real_face_count(),
                    "new vertices are not asked for"
                );
                let proof = peeled(&repaired, &step.candidate.solution.embedding);
                let concave = step.candidate.refinement.is_some();
                assert!(step.verdict.planar == proof.planar || concave, "case {case}, {method:?}: {}", proof.summary());
            }
            if method == Method::Auto || method.is_one_to_one() {
                assert!(steps.last().unwrap().verdict.planar, "case {case}, {method:?}");
            }
        }
    }
}

#[test]
fn a_flat_plate_keeps_its_shape_whatever_the_shape_of_its_holes() {
    // A C-shaped hole and a square one.
    let c = [22, 23, 24, 25, 32, 42, 52, 53, 54, 55];
    let mesh = without_faces(&quads(10), |face| c.contains(&face) || face == 77);
    let (repaired, disk) = filled(&mesh);
    assert_eq!(count(&repaired), 2);
    for family in [Family::Conformal, Family::MeanValue] {
        let (steps, _) = steps_of(&disk, Settings::new(Method::Natural, family), &Pins::new()).unwrap();
        let summary = distortion(&disk, &steps[0].candidate.solution.embedding).summary;
        assert!(summary.angle.max < 1.0 + 1e-9 && summary.area.max < 1.0 + 1e-9, "{family:?}: {summary:?}");
        assert!(steps[0].verdict.planar);
    }
}

#[test]
fn a_slit_is_filled_with_faces_that_have_an_area() {
    // Two edges of a sheet opened: the loop around them encloses no area.
    let mut mesh = grid(6, 6);
    let slit = [16, 17, 18, 19].map(VertexId::new);
    let copies: Vec<VertexId> = (0..2).map(|k| VertexId::from_index(mesh.vertex_count() + k)).collect();
    mesh.positions.extend([17, 18].map(|v: usize| mesh.positions[v]));
    for corners in &mut mesh.triangles {
        let is_above = corners.iter().any(|v| v.index() > 20);
        for corner in corners.iter_mut().filter(|_| is_above) {
            *corner = if *corner == slit[1] {
                copies[0]
            } else if *corner == slit[2] {
                copies[1]
            } else {
                *corner
            };
        }
    }
    let (repaired, disk) = filled(&PolygonMesh::from(&mesh));
    assert_eq!((count(&repaired), disk.mollification()), (1, 0.0));
    let (steps, _) = steps_of(&disk, Settings::default(), &Pins::new()).unwrap();
    assert!(steps.last().unwrap().verdict.planar);
    assert!(peeled(&repaired, &steps.last().unwrap().candidate.solution.embedding).planar);
}

#[test]
fn whatever_the_holes_of_a_rough_surface_filling_them_makes_a_disk() {
    // Rims far from flat, with surface edges that join vertices of one rim.
    let mut random = Random(41);
    let mut filled_count = 0;
    for case in 0..200 {
        let mut sheet = grid(8, 8);
        for p in &mut sheet.positions {
            *p += DVec3::new(random.unit(), random.unit(), 3.0 * random.unit());
        }
        let left_out: BTreeSet<usize> = (0..9).map(|_| random.index(sheet.face_count())).collect();
        let mesh = without_faces(&PolygonMesh::from(&sheet), |face| left_out.contains(&face));
        if diagnose(&mesh.triangulate()).component_count > 1 {
            continue;
        }
        let (repaired, disk) = filled(&mesh);
        assert_eq!(disk.mesh().holes().len(), count(&repaired), "case {case}");
        assert_eq!(disk.real_vertex_count(), repaired.polygons().positions.len(), "case {case}");
        filled_count += count(&repaired);
    }
    assert!(filled_count > 100);
}

#[test]
fn the_longest_loop_is_the_outer_one() {
    // A ring whose inner loop has more edges, in a larger outer triangle.
    let (repaired, disk) = filled(&PolygonMesh::from(&band(9, 0)));
    assert_eq!(count(&repaired), 1);
    let rim: BTreeSet<VertexId> = disk.mesh().holes()[0].rim.iter().copied().collect();
    let outer: BTreeSet<VertexId> = disk.boundary_loop().iter().copied().collect();
    assert!(rim.is_disjoint(&outer) && rim.len() == 9 && outer.len() == 9);
    let length = |of: &BTreeSet<VertexId>| -> f64 { of.iter().map(|&v| disk.position(v).truncate().length()).sum() };
    assert!(length(&outer) >= length(&rim));
}

#[test]
fn holes_stay_where_nothing_may_be_repaired_or_they_are_to_be_cut_and_where_there_are_handles() {
    let ring = PolygonMesh::from(&band(8, 0));
    let none = Preparation { repair: Repairs::NONE, ..Preparation::default() };
    let cut = Preparation { holes: HoleTreatment::Cut, ..Preparation::default() };
    for form in [none, cut] {
        assert_eq!(form.repaired(&ring).done(), [], "{form:?}");
        let opened = Preparation { cut: true, ..form.clone() }.repaired(&ring);
        assert!(opened.flattens() && opened.done()[0].repair == Repair::Cut, "{form:?}");
    }
    let fill_and_cut = Preparation { cut: true, ..Preparation::default() }.repaired(&ring);
    assert_eq!(fill_and_cut.done().iter().map(|done| done.repair).collect::<Vec<_>>(), [Repair::FillHoles]);
}

#[test]
fn a_surface_that_is_turned_around_has_the_same_filling_turned() {
    let mesh = holed_sheet(&mut Random(3), 7, 0.1);
    let form = Preparation { faces_turned: true, ..Preparation::default() };
    let turned = form.repaired(&mesh.turned());
    let (repaired, disk) = filled(&mesh);
    assert_eq!(turned.triangulate().positions, repaired.triangulate().positions, "vertices keep their numbers");
    let other = DiskMesh::try_from(turned.triangulate()).unwrap();
    assert_eq!(other.mesh().holes().len(), disk.mesh().holes().len());
}

#[test]
fn what_fills_holes_is_no_part_of_areas_and_distortion() {
    let mesh = holed_sheet(&mut Random(9), 8, 0.1);
    let (_, disk) = filled(&mesh);
    let (steps, _) = steps_of(&disk, Settings::default(), &Pins::new()).unwrap();
    let embedding = &steps.last().unwrap().candidate.solution.embedding;
    let found = distortion(&disk, embedding);
    assert_eq!(found.faces.len(), disk.mesh().real_face_count());
    // Moving the filling changes no measure.
    let mut moved = embedding.clone();
    for vertex in disk.virtual_vertices() {
        moved[vertex] += DVec2::splat(0.01);
    }
    assert_eq!(distortion(&disk, &moved), found);
    let area = |face| {
        let [a, b, c] = embedding.corners(&disk, face);
        0.5 * (b - a).perp_dot(c - a)
    };
    let (flat, surface): (f64, f64) = (disk.real_faces().map(area).sum(), mesh.triangulate().area());
    assert!((flat / surface - 1.0).abs() < 1e-9, "the size of the surface: {flat} for {surface}");
}

#[test]
fn relaxing_lowers_the_distortion_of_a_sheet_with_holes_and_keeps_it_proved() {
    let mesh = holed_sheet(&mut Random(17), 8, 0.2);
    let (repaired, disk) = filled(&mesh);
    let settings = Settings { relax_rounds: Some(8), ..Settings::default() };
    let (steps, _) = steps_of(&disk, settings, &Pins::new()).unwrap();
    let energy = |step: &Step| step.candidate.progress.unwrap().energy;
    let relaxed: Vec<&Step> = steps.iter().filter(|step| step.candidate.stage == Stage::Relax).collect();
    assert!(!relaxed.is_empty());
    assert!(relaxed.windows(2).all(|pair| energy(pair[1]) <= energy(pair[0])));
    assert!(relaxed.iter().all(|step| peeled(&repaired, &step.candidate.solution.embedding).planar));
    // The reported energy is that of the surface: the area-weighted mean of the faces' distortion.
    let last = relaxed[relaxed.len() - 1];
    let told = distortion(&disk, &last.candidate.solution.embedding).summary.symmetric_dirichlet.mean;
    assert!((energy(last) / told - 1.0).abs() < 1e-3, "{} and {told}", energy(last));
}

/// Pins that rotate the vertices around a hole by a third of a full turn. The corners of the sheet of 6 × 6 quads
/// stay.
fn hole_turned(disk: &DiskMesh) -> Pins {
    let hole = &disk.mesh().holes()[0];
    let middle = hole.rim.iter().map(|&v| disk.position(v).truncate()).sum::<DVec2>() / hole.rim.len() as f64;
    let turn = DVec2::from_angle(2.1);
    let around = hole.rim.iter().map(|&v| (v, middle + turn.rotate(disk.position(v).truncate() - middle)));
    let corners = [0, 6, 42, 48].map(VertexId::new).map(|v| (v, disk.position(v).truncate()));
    around.chain(corners).map(|(v, z)| (v, Pin::hard(z))).collect()
}

#[test]
fn constraints_around_holes_are_met_with_new_vertices_where_that_takes_some() {
    let mesh = without_faces(&quads(6), |face| [14, 15, 20].contains(&face));
    let (_, disk) = filled(&mesh);
    let pins = hole_turned(&disk);
    for method in [Method::Auto, Method::Matchmaker] {
        let (steps, ending) = steps_of(&disk, Settings::new(method.clone(), Family::default()), &pins).unwrap();
        let last = steps.last().unwrap();
        assert_eq!((ending, last.unmet()), (Ending::Planar, Vec::new()), "{method:?}");
        let of = last.candidate.mesh(&disk);
        // Surface of the refinement alone: faces of the file only.
        let surface = TriMesh { triangles: of.mesh().real_triangles().to_vec(), polygon_of: None, ..of.mesh().clone() };
        let charts = parts(&surface).unwrap();
        assert!(atlas_verdict(&charts, &last.candidate.solution.embedding).planar, "{method:?}");
        assert_eq!(charts[0].loops().len(), 2);
        let polygons = of.mesh().polygon_of.as_ref().unwrap();
        assert!(polygons[surface.face_count()..].iter().all(|&number| number == FIRST_HOLE));
    }
}

#[test]
fn whichever_of_equally_long_ways_rounding_takes_constraints_around_a_hole_end_planar() {
    // Many edges of the sheet have equal length, so rounding decides the order of the paths. Some quads may stay
    // concave when relaxation ends, and are cut.
    let mut cut = 0;
    for seed in 0..24 {
        let mut random = Random(seed);
        let mut sheet = quads(6);
        for p in &mut sheet.positions {
            let mut last_bits = || 1.0 + 1e-15 * random.between(-1.0, 1.0);
            *p *= DVec3::new(last_bits(), last_bits(), 1.0);
        }
        let (_, disk) = filled(&without_faces(&sheet, |face| [14, 15, 20].contains(&face)));
        let settings = Settings::new(Method::Matchmaker, Family::default());
        let (steps, ending) = steps_of(&disk, settings, &hole_turned(&disk)).unwrap();
        let last = steps.last().unwrap();
        assert_eq!((ending, last.unmet()), (Ending::Planar, Vec::new()), "seed {seed}");
        assert!(last.verdict.planar && last.verdict.concave_polygons.is_empty(), "seed {seed}");
        cut += usize::from(steps.iter().any(|step| step.candidate.stage == Stage::Cut));
    }
    assert!(cut > 0, "some seeds need it");
}

#[test]
fn a_vertex_that_only_fills_a_hole_cannot_be_pinned() {
    let (repaired, disk) = filled(&without_faces(&quads(3), |face| face == 4));
    let middle = disk.virtual_vertices()[0];
    assert_eq!(middle.index(), repaired.polygons().positions.len());
    let pins = Pins::from([(middle, Pin::hard(DVec2::ZERO))]);
    let error = steps_of(&disk, Settings::default(), &pins).unwrap_err();
    assert_eq!(error, SolveError::NoSuchVertex { vertex: middle, count: 16 });
}

#[test]
fn a_disk_has_no_filling() {
    let disk = disk(grid(4, 4));
    assert_eq!((disk.real_vertex_count(), disk.mesh().real_face_count()), (25, 32));
    assert!(disk.mesh().holes().is_empty() && disk.virtual_vertices().is_empty());
}
