//! Greedy colouring of constraints.

use std::ops::Range;

/// Constraints at one vertex that get a colour each; what is beyond shares the last.
const COLOURS: u32 = 63;

/// Reorders `items` so that neighbours in the sweep share no vertex: each takes the
/// smallest colour still free at all its vertices, then a stable sort by colour.
///
/// A sweep in the order of the mesh's rings carries waves along the rings, which gain
/// energy; the coloured order does not, and it is faster because no constraint waits
/// for the result of the one before. Answers with the runs that share no vertex.
pub fn by_colour<T: Copy, const N: usize>(
    items: &mut [T],
    vertex_count: usize,
    vertices: impl Fn(&T) -> [usize; N],
) -> Vec<Range<usize>> {
    let mut taken: Vec<u64> = vec![0; vertex_count];
    let mut coloured: Vec<(u32, T)> = items
        .iter()
        .map(|item| {
            let ends = vertices(item);
            let used = ends.iter().fold(0, |used, v| used | taken[*v]);
            let colour = used.trailing_ones().min(COLOURS);
            ends.iter().for_each(|v| taken[*v] |= 1 << colour);
            (colour, *item)
        })
        .collect();
    coloured.sort_by_key(|(colour, _)| *colour);
    let mut runs: Vec<Range<usize>> = Vec::new();
    let mut last = None;
    for (index, (slot, (colour, item))) in items.iter_mut().zip(coloured).enumerate() {
        *slot = item;
        match runs.last_mut() {
            Some(run) if last == Some(colour) && colour < COLOURS => run.end = index + 1,
            _ => runs.push(index..index + 1),
        }
        last = Some(colour);
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::by_colour;

    #[test]
    fn neighbours_in_a_chain_are_swept_apart() {
        let mut chain: Vec<[usize; 2]> = (0..6).map(|i| [i, i + 1]).collect();
        let runs = by_colour(&mut chain, 7, |e| *e);
        assert_eq!(runs, [0..3, 3..6]);
        assert_eq!(chain, [[0, 1], [2, 3], [4, 5], [1, 2], [3, 4], [5, 6]]);
    }
}
