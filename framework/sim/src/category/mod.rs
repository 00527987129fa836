//! Object categories: generators of every instance that a category has.

pub mod cap;
