//! Alignments: the similarity that carries one set of points onto another although some
//! of the pairs are wrong (method: Eq. 6).
//!
//! [`Procrustes`] starts from the least-squares fit and serves where at most half of the
//! pairs is wrong; [`Ransac`] starts from the best of many fits to three pairs and
//! serves where the least-squares fit is already lost. Both end in the same reweighting.
//!
//! `cargo build --release -p seeone-procrustes --example procrustes` builds the first as a
//! dynamic library, `target/release/examples/libprocrustes.so`, whose answers are the linked
//! plugin's to the bit.

mod closed_form;
mod procrustes;
mod ransac;
mod reweighting;

pub use procrustes::Procrustes;
pub use ransac::Ransac;
pub use reweighting::Reweighting;
