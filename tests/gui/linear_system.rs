//! Linear system of a step in files: read back, solved by another method, and compared with the embedding.

use faer::Mat;
use faer::linalg::solvers::{Solve as _, SolveLstsq as _};
use freebound::session::{Action, Severity};
use freebound_core::mesh::VertexId;
use freebound_core::problem::{BoundaryShape, Family, Method, Settings, Treatment};

use crate::harness::{Window, sheet};

/// Numbers of a Matrix Market file after its comments: those of the first line, then the rest.
fn numbers(text: &str, head: &str) -> (Vec<usize>, Vec<Vec<f64>>) {
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some(head));
    let mut lines = lines.filter(|line| !line.starts_with('%'));
    let sizes = lines.next().expect("sizes").split(' ').map(|word| word.parse().unwrap()).collect();
    let rest = lines.map(|line| line.split(' ').map(|word| word.parse().unwrap()).collect()).collect();
    (sizes, rest)
}

/// Vertices of a list in the comments.
fn list(text: &str, title: &str) -> Vec<usize> {
    let mut lines = text.lines().skip_while(|line| !line.starts_with(&format!("% {title}:")));
    let first = lines.next().expect("the list").split_once(": ").expect("vertices").1.to_owned();
    let rest = lines.take_while(|line| line.starts_with("%   ")).map(|line| line[3..].to_owned());
    let words: Vec<String> = std::iter::once(first).chain(rest).collect();
    let range = |word: &str| {
        let (low, high) = word.split_once('-').unwrap_or((word, word));
        low.parse::<usize>().unwrap()..=high.parse::<usize>().unwrap()
    };
    words.join(" ").split_whitespace().flat_map(range).collect()
}

/// Positions that the written system gives, by vertex.
fn solved(window: &mut Window) -> (Vec<usize>, Vec<[f64; 2]>) {
    window.menu(&["File", "Export", "Steps and curves", "Linear system of this step…"]);
    window.click("Export");
    window.settle();
    let read = |name: &str| std::fs::read_to_string(window.path(name)).unwrap();
    let matrix = read("sheet-matrix.mtx");
    let (sizes, entries) = numbers(&matrix, "%%MatrixMarket matrix coordinate real general");
    let (of_right, right) = numbers(&read("sheet-matrix-rhs.mtx"), "%%MatrixMarket matrix array real general");
    assert_eq!((entries.len(), right.len()), (sizes[2], 2 * sizes[0]));
    assert_eq!(of_right, [sizes[0], 2]);
    let mut a = Mat::<f64>::zeros(sizes[0], sizes[1]);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "indices that the file counts from 1")]
    for entry in &entries {
        a[(entry[0] as usize - 1, entry[1] as usize - 1)] += entry[2];
    }
    let b = Mat::from_fn(sizes[0], 2, |row, column| right[column * sizes[0] + row][0]);
    let x = if sizes[0] == sizes[1] { a.partial_piv_lu().solve(&b) } else { a.qr().solve_lstsq(&b) };
    let columns = list(&matrix, "Columns, in order");
    let half = columns.len();
    for name in ["sheet-matrix.mtx", "sheet-matrix-rhs.mtx"] {
        std::fs::remove_file(window.path(name)).unwrap();
    }
    let is_coupled = sizes[1] == 2 * half;
    if is_coupled {
        for k in 0..half {
            assert!((x[(k, 1)] + x[(half + k, 0)]).abs() < 1e-8, "the second column is the map turned");
        }
    }
    let at = |k: usize| if is_coupled { [x[(k, 0)], x[(half + k, 0)]] } else { [x[(k, 0)], x[(k, 1)]] };
    (columns.clone(), (0..half).map(at).collect())
}

fn assert_solves(window: &mut Window, count: usize, what: &str) {
    let embedding = window.embedding();
    let (columns, positions) = solved(window);
    assert_eq!(columns.len(), count, "{what}");
    for (vertex, [u, v]) in columns.into_iter().zip(positions) {
        let at = embedding[VertexId::from_index(vertex)];
        assert!((at.x - u).abs() + (at.y - v).abs() < 1e-7, "{what}: vertex {vertex}: {at} and {u} {v}");
    }
}

#[test]
fn a_dense_solver_finds_the_embedding_from_the_written_system() {
    let mesh = sheet(6, 0.3);
    let count = mesh.positions.len();
    let mut window = Window::with_mesh("sheet.obj", &mesh);
    let corners = [0, 6, 42].map(VertexId::new).to_vec();
    for (method, family) in [(Method::Natural, Family::MeanValue), (Method::Natural, Family::Conformal)] {
        let settings = Settings::new(method, family);
        window.editor_mut().session.handle(Action::SetSettings(settings));
        window.settle();
        // Two pins fix the similarity; their equations are left out.
        assert_solves(&mut window, count - 2, "natural");
    }
    let convex = Settings::new(Method::Convex(BoundaryShape::Circle), Family::MeanValue);
    window.editor_mut().session.handle(Action::SetSettings(convex));
    window.settle();
    assert_solves(&mut window, 25, "convex");
    let least =
        Settings { treatment: Some(Treatment::LeastSquares), ..Settings::new(Method::Natural, Family::MeanValue) };
    window.editor_mut().session.handle(Action::SetSettings(least));
    window.editor_mut().session.handle(Action::Fix(corners));
    window.settle();
    assert_solves(&mut window, count - 3, "least squares");
    window.editor_mut().session.handle(Action::Step);
    window.settle();
    assert_solves(&mut window, count - 3, "iteration");
}

#[test]
fn a_step_without_a_linear_system_says_so_with_a_remedy() {
    let mut window = Window::with_mesh("sheet.obj", &sheet(6, 0.3));
    window.editor_mut().session.handle(Action::SetSettings(Settings::new(Method::Slim, Family::Conformal)));
    window.settle();
    window.menu(&["File", "Export", "Steps and curves", "Linear system of this step…"]);
    window.click("Export");
    assert!(!window.path("sheet-matrix.mtx").exists());
    let message = &window.editor().session.messages()[0];
    assert_eq!(message.severity, Severity::Error);
}
