//! Edges and hinges of a triangle mesh.

use std::collections::BTreeMap;

/// An edge with the triangles on it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edge {
    /// Its vertices, ascending.
    pub ends: [usize; 2],
    /// The adjoining triangles: one on a border, two inside, more where sheets meet.
    pub triangles: Vec<usize>,
}

impl Edge {
    /// Whether the sheet ends here.
    pub fn is_border(&self) -> bool {
        self.triangles.len() == 1
    }
}

/// Every edge once, ascending by its vertices.
pub fn edges(triangles: &[[u32; 3]]) -> Vec<Edge> {
    let mut found: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
    for (index, t) in triangles.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (t[k] as usize, t[(k + 1) % 3] as usize);
            found.entry([a.min(b), a.max(b)]).or_default().push(index);
        }
    }
    found.into_iter().map(|(ends, triangles)| Edge { ends, triangles }).collect()
}

/// The corner of `triangle` that is not on the edge `ends`.
pub fn opposite(triangle: &[u32; 3], ends: [usize; 2]) -> usize {
    let [a, b, c] = triangle.map(|v| v as usize);
    if !ends.contains(&a) {
        a
    } else if !ends.contains(&b) {
        b
    } else {
        c
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_triangles_share_one_edge() {
        let triangles = [[0, 1, 2], [2, 1, 3]];
        let edges = edges(&triangles);
        assert_eq!(edges.len(), 5);
        let inner: Vec<_> = edges.iter().filter(|e| !e.is_border()).collect();
        assert_eq!(inner.len(), 1);
        assert_eq!(inner[0].ends, [1, 2]);
        assert_eq!(opposite(&triangles[0], [1, 2]), 0);
        assert_eq!(opposite(&triangles[1], [1, 2]), 3);
    }
}
