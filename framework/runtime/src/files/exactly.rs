//! Lists of a certain length.

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::Error;
use serde::{Deserialize, Deserializer};
use std::borrow::Cow;

/// Exactly `N` values. An array would be filled with the first `N` of a longer list, and nobody
/// would be told of the rest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Exactly<T, const N: usize>(pub(super) [T; N]);

impl<'de, T: Deserialize<'de>, const N: usize> Deserialize<'de> for Exactly<T, N> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let values = Vec::<T>::deserialize(from)?;
        let length = values.len();
        let wanted = || D::Error::custom(format!("a list of {length} values, expected {N}"));
        values.try_into().map(Self).map_err(|_| wanted())
    }
}

impl<T: JsonSchema, const N: usize> JsonSchema for Exactly<T, N>
where
    [T; N]: JsonSchema,
{
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        <[T; N]>::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        <[T; N]>::json_schema(generator)
    }
}
