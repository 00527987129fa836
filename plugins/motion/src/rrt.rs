//! RRT-Connect (Kuffner and LaValle 2000) in joint space.

use seeone_core::random::{Generator, uniform};

/// Length of an extension, radians.
const EXTENSION_RAD: f64 = 0.5;

/// A search of a box of joint positions.
pub(crate) struct Search<'a> {
    /// Smallest and largest position of each joint, radians.
    pub(crate) bounds: &'a [(f64, f64)],
    /// Whether the straight line between two postures is free.
    pub(crate) free: &'a dyn Fn(&[f64], &[f64]) -> bool,
    /// Most extensions.
    pub(crate) extensions: usize,
}

struct Tree {
    nodes: Vec<(Vec<f64>, usize)>,
}

impl Search<'_> {
    /// A free path of straight lines from `start` to `goal`, both themselves free.
    pub(crate) fn connect(
        &self,
        start: &[f64],
        goal: &[f64],
        rng: &mut Generator,
    ) -> Option<Vec<Vec<f64>>> {
        let mut trees = [Tree::new(start), Tree::new(goal)];
        let mut extensions = 0;
        let mut growing = 0;
        while extensions < self.extensions {
            let sample: Vec<f64> =
                self.bounds.iter().map(|(low, high)| uniform(rng, *low, *high)).collect();
            extensions += 1;
            if let Some(new) = self.extend(&mut trees[growing], &sample) {
                let target = trees[growing].nodes[new].0.clone();
                let other = &mut trees[1 - growing];
                while let Some(node) = self.extend(other, &target) {
                    extensions += 1;
                    if other.nodes[node].0 == target {
                        let mut halves = [Vec::new(), Vec::new()];
                        halves[growing] = trees[growing].branch(new);
                        halves[1 - growing] = trees[1 - growing].branch(node);
                        let [mut path, back] = halves;
                        path.reverse();
                        path.extend(back.into_iter().skip(1));
                        return Some(path);
                    }
                }
            }
            growing = 1 - growing;
        }
        None
    }

    /// Grows `tree` by one extension towards `target` and gives the new node.
    fn extend(&self, tree: &mut Tree, target: &[f64]) -> Option<usize> {
        let (nearest, length) = tree.nearest(target);
        let from = &tree.nodes[nearest].0;
        let to = if length <= EXTENSION_RAD {
            target.to_vec()
        } else {
            let share = EXTENSION_RAD / length;
            from.iter().zip(target).map(|(a, b)| a + share * (b - a)).collect()
        };
        (length > 0.0 && (self.free)(from, &to)).then(|| {
            tree.nodes.push((to, nearest));
            tree.nodes.len() - 1
        })
    }
}

impl Tree {
    fn new(root: &[f64]) -> Self {
        Self { nodes: vec![(root.to_vec(), 0)] }
    }

    fn nearest(&self, target: &[f64]) -> (usize, f64) {
        let distances = self.nodes.iter().map(|(node, _)| distance(node, target));
        let nearest = distances.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
        nearest.unwrap_or((0, 0.0))
    }

    /// The nodes from `node` back to the root.
    fn branch(&self, mut node: usize) -> Vec<Vec<f64>> {
        let mut path = vec![self.nodes[node].0.clone()];
        while node != 0 {
            node = self.nodes[node].1;
            path.push(self.nodes[node].0.clone());
        }
        path
    }
}

/// Length of a straight line in joint space, radians.
pub(crate) fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use seeone_core::random::generator;

    /// A wall across a square with a gap at the top.
    fn free(a: &[f64], b: &[f64]) -> bool {
        (0..=50).all(|k| {
            let share = f64::from(k) / 50.0;
            let (x, y) = (a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]));
            x.abs() > 0.1 || y > 1.5
        })
    }

    #[test]
    fn finds_the_gap_from_start_to_goal_and_the_same_one_again() {
        let bounds = [(-2.0, 2.0); 2];
        let search = Search { bounds: &bounds, free: &free, extensions: 2000 };
        let find = |seed| search.connect(&[-1.0, 0.0], &[1.0, 0.0], &mut generator(seed, "rrt"));
        let path = find(1).expect("a path");
        assert_eq!(
            (path[0].as_slice(), path[path.len() - 1].as_slice()),
            (&[-1.0, 0.0][..], &[1.0, 0.0][..])
        );
        assert!(path.windows(2).all(|pair| free(&pair[0], &pair[1])));
        assert_eq!(find(1), find(1));
        let closed = Search { bounds: &[(-2.0, 2.0), (-2.0, 1.4)], free: &free, extensions: 300 };
        assert_eq!(closed.connect(&[-1.0, 0.0], &[1.0, 0.0], &mut generator(1, "rrt")), None);
    }
}
