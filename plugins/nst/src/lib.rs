//! NST: from observed points to where they lie in the canonical state of the category.
//!
//! Two networks of one architecture. The *coarse* one sees the cloud as it lies (gravity
//! up, turned to the camera's azimuth) and tells `|x|`, `y` and `z`: left and right of a
//! mirror-symmetric object cannot be told apart before its pose is known. A robust fit of
//! those makes a pose, with `x = y x z`; the *refiner* sees the cloud in that pose and
//! tells all three coordinates, in three passes. Beside the points both are told how the cloud
//! was seen ([`stance`]).
//!
//! Left out of the paper's method: the contrastive loss (Eq. 2). Measured, it slowed
//! learning at the number of samples that a small machine affords.

pub mod alignment;
pub mod augment;
pub mod batch;
pub mod dataset;
pub mod evaluate;
pub mod examples;
pub mod inference;
pub mod network;
pub mod plugin;
pub mod readout;
pub mod round;
pub mod stance;
pub mod training;
pub mod units;

pub use evaluate::{Figures, evaluate};
pub use inference::{Effort, Nst, NstError, Perceived};
pub use plugin::{NstPerception, build, build_one_pass};
pub use training::{NstTrainError, Report, Stage, StageProgress, TrainPlan, record, train};
