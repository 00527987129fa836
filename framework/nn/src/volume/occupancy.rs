//! Which voxels a cloud touches.

/// The voxels that hold the points of a batch of clouds; of all voxels only these count.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Occupancy {
    side: usize,
    batch: usize,
    voxels: Vec<u32>,
    owners: Vec<u32>,
}

impl Occupancy {
    /// Sorts the points of each cloud, in cube coordinates, into the voxels of its own grid
    /// of `side` voxels an edge; a point outside the cube counts for the nearest one.
    pub fn new(clouds: &[&[[f32; 3]]], side: usize) -> Self {
        let cell = |v: f32| ((v * side as f32) as usize).min(side.saturating_sub(1));
        let row = |b: usize, p: &[f32; 3]| {
            ((b * side + cell(p[2])) * side + cell(p[1])) * side + cell(p[0])
        };
        let rows: Vec<u32> = clouds
            .iter()
            .enumerate()
            .flat_map(|(b, cloud)| cloud.iter().map(move |p| row(b, p) as u32))
            .collect();
        let mut voxels = rows.clone();
        voxels.sort_unstable();
        voxels.dedup();
        let owners = rows.iter().map(|r| voxels.partition_point(|v| v < r) as u32).collect();
        Self { side, batch: clouds.len(), voxels, owners }
    }

    /// Voxels along an edge of a grid.
    pub fn side(&self) -> usize {
        self.side
    }

    /// Number of grids.
    pub fn batch(&self) -> usize {
        self.batch
    }

    /// Row in the stacked grids of each of the V occupied voxels, ascending.
    pub fn voxels(&self) -> &[u32] {
        &self.voxels
    }

    /// For each point, in the order given, the index of its voxel in [`Self::voxels`].
    pub fn owners(&self) -> &[u32] {
        &self.owners
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_fall_into_the_voxels_of_their_own_grid() {
        let first = [[0.1, 0.1, 0.1], [0.9, 0.1, 0.6], [0.2, 0.2, 0.2], [-3.0, 0.0, 9.0]];
        let second = [[0.9, 0.1, 0.6]];
        let occupancy = Occupancy::new(&[&first, &second], 2);
        assert_eq!(occupancy.voxels(), [0, 4, 5, 13]);
        assert_eq!(occupancy.owners(), [0, 2, 0, 1, 3]);
    }
}
