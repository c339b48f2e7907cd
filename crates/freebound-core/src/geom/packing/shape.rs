//! Shapes of charts: closed loops in the plane, filled by the rule of non-zero winding.

use glam::DVec2;

use crate::geom::convex_hull;

/// Shape of a chart: the points around which its loops wind.
///
/// Boundary loops of a planar chart (outer loop counter-clockwise, holes clockwise) give the chart without its holes.
/// A chart that overlaps itself is given by its triangles, each as a counter-clockwise loop.
/// Points on a loop belong to the shape, so a loop can be a point or a segment.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartShape {
    /// Vertices of each loop, in units shared by all charts. The last vertex joins the first.
    loops: Vec<Vec<DVec2>>,
}

impl ChartShape {
    /// Shape of closed loops. Empty loops are ignored; a shape without vertices is a point at the origin.
    ///
    /// # Panics
    ///
    /// If a coordinate is infinite or not a number.
    pub fn new(loops: Vec<Vec<DVec2>>) -> Self {
        assert!(loops.iter().flatten().all(|vertex| vertex.is_finite()), "vertices of shapes are finite");
        let mut loops: Vec<Vec<DVec2>> = loops.into_iter().filter(|points| !points.is_empty()).collect();
        if loops.is_empty() {
            loops.push(vec![DVec2::ZERO]);
        }
        Self { loops }
    }

    /// Shape covered by triangles of either orientation, which may overlap.
    ///
    /// # Panics
    ///
    /// If a coordinate is infinite or not a number.
    pub fn of_triangles(triangles: impl IntoIterator<Item = [DVec2; 3]>) -> Self {
        let ordered = |[a, b, c]: [DVec2; 3]| if (b - a).perp_dot(c - a) < 0.0 { vec![a, c, b] } else { vec![a, b, c] };
        Self::new(triangles.into_iter().map(ordered).collect())
    }

    /// Vertices of all loops.
    pub fn vertices(&self) -> impl Iterator<Item = DVec2> {
        self.loops.iter().flatten().copied()
    }

    /// Edges of all loops. A loop of one vertex has one edge of length zero.
    pub fn edges(&self) -> impl Iterator<Item = [DVec2; 2]> {
        self.loops.iter().flat_map(|points| {
            let ends = points.iter().cycle().skip(1);
            points.iter().zip(ends).map(|(&from, &to)| [from, to])
        })
    }

    /// Area: the sum of the signed areas of all loops, without its sign.
    pub(crate) fn area(&self) -> f64 {
        let of_loop = |points: &Vec<DVec2>| {
            let from_first = points.windows(2).map(|pair| (pair[0] - points[0]).perp_dot(pair[1] - points[0]));
            from_first.sum::<f64>() / 2.0
        };
        self.loops.iter().map(of_loop).sum::<f64>().abs()
    }

    /// Corners of the convex hull, counter-clockwise. All vertices if the hull has no corners.
    pub(crate) fn hull(&self) -> Vec<DVec2> {
        let points: Vec<DVec2> = self.vertices().collect();
        let corners = convex_hull(&points);
        if corners.is_empty() { points } else { corners.into_iter().map(|corner| points[corner]).collect() }
    }
}
