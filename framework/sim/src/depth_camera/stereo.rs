//! What the second imager of a stereo camera sees of what the first one sees.

use crate::raster::Raster;

/// Disparities that differ by less are of one surface, pixels.
const SAME_SURFACE_PX: f64 = 1.0;

/// The view of the imager that stands one baseline along the camera's x axis. Depth is
/// reported for the first imager; where the second one sees something else, or nothing,
/// there is none: a band along the image's left side, `f B / Z` wide, and a shadow along
/// the left side of whatever stands in front, as wide as the disparities differ (Intel,
/// D400 series datasheet, "invalid depth band" and "occlusion").
pub struct SecondImager {
    /// Largest disparity in each pixel, row by row; zero where nothing is seen.
    disparity_px: Vec<f64>,
    width: usize,
    /// Focal length times baseline, pixel metres.
    scale: f64,
}

impl SecondImager {
    /// What it sees of `truth`, from `baseline_m` beside the first.
    pub fn look(truth: &Raster, baseline_m: f64) -> Self {
        let width = truth.intrinsics.width;
        let mut disparity_px = vec![0.0; truth.hits.len()];
        let scale = truth.intrinsics.fx * baseline_m;
        for (pixel, hit) in truth.hits.iter().enumerate() {
            let Some(hit) = hit else { continue };
            let disparity = scale / hit.depth_m;
            if let Some(column) = shifted(pixel % width, disparity) {
                let seen = &mut disparity_px[pixel - pixel % width + column];
                *seen = disparity.max(*seen);
            }
        }
        Self { disparity_px, width, scale }
    }

    /// Whether it sees what pixel `(column, row)` of the first imager sees at `depth_m`.
    /// The neighbours of its pixel count too: a surface that it sees stretched has gaps.
    pub fn sees(&self, column: usize, row: usize, depth_m: f64) -> bool {
        let disparity = self.scale / depth_m;
        shifted(column, disparity).is_some_and(|there| {
            let line = &self.disparity_px[row * self.width..][..self.width];
            let around = &line[there.saturating_sub(1)..(there + 2).min(self.width)];
            around.iter().all(|other| *other < disparity + SAME_SURFACE_PX)
        })
    }
}

/// The column at which the second imager has what the first has at `column`.
fn shifted(column: usize, disparity_px: f64) -> Option<usize> {
    let there = (column as f64 - disparity_px).round();
    (there >= 0.0).then_some(there as usize)
}
