//! Encodings: from a canonical cloud to features at any point of the canonical cube.
//!
//! [`Nse`] is the paper's neural spatial encoding: a volume of learnt features under an
//! implicit network trained on winding numbers. [`NearestFeature`] is the paper's "without
//! NSE": the perception's own features, interpolated.

mod encoding;
mod error;
mod evaluation;
mod grasp_prior;
mod input;
mod lesson;
mod nearest_feature;
mod network;
mod perceived;
mod plugin;
pub mod reconstruction;
mod supervision;
mod surface;
mod training;

#[cfg(test)]
mod test_caps;
#[cfg(test)]
mod test_clouds;

pub use encoding::{Nse, NseField};
pub use error::NseError;
pub use evaluation::{Figures, evaluate, record};
pub use grasp_prior::GraspSpread;
pub use input::{Input, OWN_COLUMNS};
pub use nearest_feature::NearestFeature;
pub use perceived::{Perceive, Progress};
pub use plugin::{NearestFeatureConfig, NseConfig, build, build_nearest_feature};
pub use supervision::Supervision;
pub use training::{TrainPlan, train};
