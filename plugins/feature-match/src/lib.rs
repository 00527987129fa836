//! Pose transfer by features (method: Eq. 8 and 9): the canonical gripper pose whose
//! surroundings on the new instance look to the encoding as the demonstrated ones did.
//!
//! A free search over all six dimensions makes a grasp worse: along a visor's edge and in
//! rotation the features are nearly flat, and lower loss there is noise. So the search is
//! held to a small grid where corresponding poses of a category differ (the canonical cube
//! is centred on the bounding box, which leaves height), weighed by a prior, read softly,
//! and laid onto the observed sheet where that was seen.

mod config;
mod feature_match;
mod grid;
mod matching;
mod search;

pub use feature_match::FeatureMatch;
