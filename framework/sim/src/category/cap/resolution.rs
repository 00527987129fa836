//! How finely a cap is meshed.

/// Vertices of a cap's mesh, as counts along crown and brim. Two resolutions of one cap have
/// the same outlines; only their samples differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Resolution {
    rings: usize,
    brim_rows: usize,
}

impl Resolution {
    /// About 270 vertices.
    pub const COARSE: Self = Self { rings: 8, brim_rows: 3 };
    /// About 490 vertices: what data, training and runs use.
    pub const STANDARD: Self = Self { rings: 11, brim_rows: 5 };
    /// About 1,000 vertices.
    pub const FINE: Self = Self { rings: 16, brim_rows: 7 };
    /// About 2,000 vertices.
    pub const FINEST: Self = Self { rings: 23, brim_rows: 10 };

    /// A crown of `rings` rings from apex to hem (4 to 64) and a brim of `brim_rows` rows
    /// beyond the hem (2 to 32); `None` outside these.
    pub fn new(rings: usize, brim_rows: usize) -> Option<Self> {
        let meshable = (4..=64).contains(&rings) && (2..=32).contains(&brim_rows);
        meshable.then_some(Self { rings, brim_rows })
    }

    /// Rings of the crown's disc; the last is the hem.
    pub const fn rings(self) -> usize {
        self.rings
    }

    /// Rows of brim vertices beyond the hem.
    pub const fn brim_rows(self) -> usize {
        self.brim_rows
    }

    /// Vertices of the hem.
    pub const fn hem(self) -> usize {
        6 * self.rings
    }

    /// Index of hem vertex `j`, counted from the front towards the left, any integer.
    pub fn hem_vertex(self, j: isize) -> usize {
        first_of_ring(self.rings) + j.rem_euclid(self.hem() as isize) as usize
    }
}

impl Default for Resolution {
    fn default() -> Self {
        Self::STANDARD
    }
}

/// Index of the first vertex of `ring`; ring `k` of the disc has `6 k` vertices.
pub const fn first_of_ring(ring: usize) -> usize {
    if ring == 0 { 0 } else { 1 + 3 * ring * (ring - 1) }
}
