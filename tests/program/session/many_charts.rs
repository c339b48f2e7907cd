//! Charts of a mesh: the faces, corners and vertices of each.

use std::collections::BTreeSet;

use freebound::session::Model;
use freebound_core::mesh::{Charts, DiskMesh, HoleTreatment, PolygonMesh, Preparation, VertexId};

use freebound_testkit::many_parts::{disks, interleaved, surfaces};
use freebound_testkit::{Entry, Random, corpus_disks, corpus_test, data_disks, grid};

fn with_all_repairs(source: &PolygonMesh) -> Charts {
    Charts::of(Preparation::default().with_all_repairs().repaired(source)).expect("all parts become disks")
}

/// Asserts that every corner of the given mesh is one corner of one chart, at its own position, and that faces stay
/// whole.
#[track_caller]
fn assert_partition(source: &PolygonMesh, charts: &Charts) {
    let mut seen = vec![false; source.corners.len()];
    let mut first_faces = Vec::new();
    for number in 0..charts.count() {
        let chart = charts.chart(number);
        let polygons = chart.repaired.polygons();
        assert_eq!(polygons.face_count(), charts.faces(number).len());
        for corner in 0..polygons.corners.len() {
            let of = chart.repaired.corner_of(corner);
            assert!(!std::mem::replace(&mut seen[of], true), "corner {of} is in two charts");
            let [here, there] =
                [(polygons, corner), (source, of)].map(|(mesh, at)| mesh.positions[mesh.corners[at].index()]);
            assert_eq!(here, there);
        }
        let triangles = chart.repaired.triangulate();
        let file_faces = triangles.polygon_of.clone().expect("each face has its number in the file");
        first_faces.push(file_faces[0]);
        for face in 0..polygons.face_count() {
            let corners: BTreeSet<usize> = polygons.corner_range(face).map(|at| chart.repaired.corner_of(at)).collect();
            let of = (0..source.face_count()).find(|&f| source.corner_range(f).eq(corners.iter().copied()));
            let of = of.unwrap_or_else(|| panic!("{corners:?} are the corners of no face"));
            assert!(file_faces.contains(&u32::try_from(of).expect("few")));
        }
        DiskMesh::try_from(triangles).unwrap_or_else(|faults| panic!("chart {number}: {faults}"));
        assert_vertices(charts, number);
    }
    assert!(seen.iter().all(|&is_seen| is_seen), "every corner is in a chart");
    assert!(first_faces.is_sorted(), "{first_faces:?}");
}

/// Asserts that the vertex numbers of a chart and of the whole map to each other.
#[track_caller]
fn assert_vertices(charts: &Charts, number: usize) {
    let chart = charts.chart(number);
    let whole = charts.whole().polygons();
    assert!(chart.vertex_of.is_sorted_by(|a, b| a < b));
    for (own, &of) in chart.vertex_of.iter().enumerate() {
        assert_eq!(chart.repaired.polygons().positions[own], whole.positions[of.index()]);
        assert_eq!(chart.vertex_at(of), Some(VertexId::from_index(own)));
        assert_eq!(charts.chart_of_vertex(of), Some(number));
    }
    let others = (0..whole.positions.len()).map(VertexId::from_index).filter(|v| !chart.vertex_of.contains(v));
    assert!(others.into_iter().all(|vertex| chart.vertex_at(vertex).is_none()));
}

#[test]
fn disks_whose_faces_are_mixed_are_a_chart_each() {
    for seed in 0..20 {
        let mut random = Random(seed);
        let parts = disks(&mut random);
        let source = interleaved(&parts, &mut random);
        let charts = Charts::of(Preparation::default().repaired(&source)).expect("disks");
        assert_partition(&source, &charts);
        let mut found: Vec<usize> = (0..charts.count()).map(|chart| charts.faces(chart).len()).collect();
        let mut expected: Vec<usize> = parts.iter().map(PolygonMesh::face_count).collect();
        assert_eq!(charts.faces(charts.largest()).len(), *expected.iter().max().expect("some"));
        found.sort_unstable();
        expected.sort_unstable();
        assert_eq!(found, expected);
    }
}

#[test]
fn closed_surfaces_and_handles_are_cut_to_a_chart_each() {
    for seed in 0..10 {
        let mut random = Random(seed);
        let parts = surfaces(&mut random);
        let source = interleaved(&parts, &mut random);
        assert_eq!(Charts::of(Preparation::default().repaired(&source)), None, "seed {seed}: nothing is cut unasked");
        let charts = with_all_repairs(&source);
        assert_partition(&source, &charts);
        assert_eq!(charts.count(), parts.len());
    }
}

#[test]
fn faces_turned_around_give_the_same_charts() {
    let mut random = Random(4);
    let parts = surfaces(&mut random);
    let source = interleaved(&parts, &mut random);
    let turned = source.turned();
    let form = Preparation { faces_turned: true, ..Preparation::default().with_all_repairs() };
    let charts = Charts::of(form.repaired(&turned)).expect("disks");
    assert_partition(&turned, &charts);
    let as_given = with_all_repairs(&source);
    for number in 0..charts.count() {
        assert_eq!(charts.chart(number).vertex_of, as_given.chart(number).vertex_of);
    }
}

#[test]
fn a_mesh_of_one_part_or_with_a_part_that_is_no_disk_has_no_charts() {
    let one = PolygonMesh::from(&grid(3, 3));
    assert_eq!(Charts::of(Preparation::default().with_all_repairs().repaired(&one)), None);
    let mut ring = grid(3, 3);
    ring.triangles.drain(8..10);
    let two = interleaved(&[one, (&ring).into()], &mut Random(1));
    let unfilled = Preparation { holes: HoleTreatment::Cut, ..Preparation::default() };
    assert_eq!(Charts::of(unfilled.repaired(&two)), None);
    assert_eq!(Charts::of(Preparation { cut: true, ..unfilled }.repaired(&two)).expect("cut").count(), 2);
    assert_eq!(Charts::of(Preparation::default().repaired(&two)).expect("filled").count(), 2);
    assert_eq!(with_all_repairs(&two).count(), 2);
}

#[test]
fn a_vertex_of_no_face_belongs_to_no_chart() {
    let mut source = interleaved(&[(&grid(2, 2)).into(), (&grid(1, 3)).into()], &mut Random(1));
    source.positions.push(glam::DVec3::ONE);
    let charts = Charts::of(Preparation::default().repaired(&source)).expect("disks");
    assert_eq!(charts.chart_of_vertex(VertexId::from_index(source.positions.len() - 1)), None);
    assert_eq!(charts.chart_of_vertex(VertexId::new(0xffff)), None);
}

fn assert_a_disk_stays_as_it_is_whatever_may_be_repaired(disks: Vec<Entry>) {
    for entry in disks {
        let [as_given, with_all_repairs] = [Preparation::default(), Preparation::default().with_all_repairs()]
            .map(|form| Model::read(&entry.path, form).unwrap_or_else(|error| panic!("{}: {error}", entry.file)));
        for model in [&as_given, &with_all_repairs] {
            assert!(model.prepared.repaired.is_none() && model.prepared.chart.is_none(), "{}", entry.file);
        }
        let [disk, other] = [&as_given, &with_all_repairs].map(|model| model.disk().expect("a disk"));
        assert_eq!(disk.mesh(), other.mesh(), "{}", entry.file);
    }
}

#[test]
fn a_disk_stays_as_it_is_whatever_may_be_repaired() {
    assert_a_disk_stays_as_it_is_whatever_may_be_repaired(data_disks());
}

corpus_test! {
    fn a_disk_stays_as_it_is_whatever_may_be_repaired_in_the_corpus() {
        assert_a_disk_stays_as_it_is_whatever_may_be_repaired(corpus_disks());
    }
}
