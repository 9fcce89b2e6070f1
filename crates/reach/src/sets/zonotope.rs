/// A zonotope {c + Σ β_l g_l : |β_l| <= 1} with centre c and generators g_l.
#[derive(Debug, Clone, PartialEq)]
pub struct Zonotope {
    centre: Vec<f64>,
    /// Row-major, one row of N entries per generator.
    generators: Vec<f64>,
}

impl Zonotope {
    pub(crate) fn new(centre: Vec<f64>, generators: Vec<f64>) -> Self {
        Self { centre, generators }
    }

    /// Returns the centre, N entries.
    pub fn centre(&self) -> &[f64] {
        &self.centre
    }

    /// Iterates over the generators, N entries each.
    pub fn generators(&self) -> impl ExactSizeIterator<Item = &[f64]> {
        self.generators.chunks_exact(self.centre.len().max(1))
    }

    /// Returns the vertices of the projection on the plane of states i and j, counter-clockwise,
    /// for figures.
    ///
    /// # Guarantee
    ///
    /// None beyond rounding to nearest: the vertices of the exact projection differ by about 1e-16
    /// times the number of generators.
    pub fn polygon(&self, i: usize, j: usize) -> Vec<[f64; 2]> {
        // Generators that point upward, sorted by angle, are the edges of one half of the boundary.
        let upward =
            |g: &[f64]| if (g[j], g[i]) < (0.0, 0.0) { [-g[i], -g[j]] } else { [g[i], g[j]] };
        let mut edges: Vec<[f64; 2]> =
            self.generators().map(upward).filter(|g| *g != [0.0; 2]).collect();
        edges.sort_by(|g, h| g[1].atan2(g[0]).total_cmp(&h[1].atan2(h[0])));
        let total = edges.iter().fold([0.0; 2], |sum, g| [sum[0] + g[0], sum[1] + g[1]]);
        let mut vertex = [self.centre[i] - total[0], self.centre[j] - total[1]];
        let mut vertices = Vec::with_capacity(2 * edges.len());
        for sign in [1.0, -1.0] {
            for g in &edges {
                vertices.push(vertex);
                vertex = [vertex[0] + sign * 2.0 * g[0], vertex[1] + sign * 2.0 * g[1]];
            }
        }
        vertices
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polygon_has_its_vertices_in_counter_clockwise_order() {
        let zonotope =
            Zonotope::new(vec![1.0, 9.0, 2.0], vec![1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 1.0, 7.0, 1.0]);
        let expected = [[-1.0, 0.0], [1.0, 0.0], [3.0, 2.0], [3.0, 4.0], [1.0, 4.0], [-1.0, 2.0]];
        assert_eq!(zonotope.polygon(0, 2), expected);
        assert_eq!(zonotope.generators().len(), 3);
    }
}
