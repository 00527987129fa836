//! Messages of kind `encoding`, and of the fields that are lent.

use super::{Remote, anything};
use crate::abi::callee::{Callee, not_answered, unanswered};
use crate::abi::cells::{Reader, fields, message};
use crate::abi::methods::Method;
use crate::{CanonicalCloud, Encoding, Features, Field, PluginError};
use nalgebra::Point3;
use std::collections::BTreeMap;

/// The number of a field that is lent by itself.
const LENT: u64 = 0;

/// Points to ask a field about.
struct Query {
    field: u64,
    points: Vec<Point3<f64>>,
}

fields!(Query { field, points });
fields!(Features { width, values });

impl<C: Callee + Clone + 'static> Encoding for Remote<C> {
    fn encode(&mut self, cloud: &CanonicalCloud) -> Result<Box<dyn Field>, PluginError> {
        let number: u64 = self.ask(Method::Encode, &message(&[cloud]), &[], anything)?;
        let owner = Remote::new(self.callee.clone(), None);
        Ok(Box::new(OwnedField(RemoteField { owner, number })))
    }
}

/// A field on the other side, by its number there.
pub(in crate::abi) struct RemoteField<C: Callee> {
    owner: Remote<C>,
    number: u64,
}

impl<C: Callee> RemoteField<C> {
    /// A field that was lent.
    pub(in crate::abi) fn lent(callee: C) -> Self {
        Self { owner: Remote::new(callee, None), number: LENT }
    }
}

impl<C: Callee> Field for RemoteField<C> {
    fn features(&self, queries: &[Point3<f64>]) -> Features {
        let request = message(&[&self.number, &queries]);
        let sound = |features: &Features| features.check(queries.len());
        self.owner
            .ask(Method::Features, &request, &[], sound)
            .unwrap_or_else(|error| unanswered(error))
    }

    fn winding(&self, queries: &[Point3<f64>]) -> Option<Vec<f64>> {
        let request = message(&[&self.number, &queries]);
        let sound = |winding: &Option<Vec<f64>>| match winding {
            Some(numbers) if numbers.len() != queries.len() => {
                Err(format!("{} winding numbers for {} points", numbers.len(), queries.len()))
            }
            Some(numbers) if !numbers.iter().all(|v| v.is_finite()) => {
                Err("a winding number is not finite".into())
            }
            _ => Ok(()),
        };
        self.owner
            .ask(Method::Winding, &request, &[], sound)
            .unwrap_or_else(|error| unanswered(error))
    }
}

/// A field that its encoding keeps until it is dropped here.
struct OwnedField<C: Callee>(RemoteField<C>);

impl<C: Callee> Field for OwnedField<C> {
    fn features(&self, queries: &[Point3<f64>]) -> Features {
        self.0.features(queries)
    }

    fn winding(&self, queries: &[Point3<f64>]) -> Option<Vec<f64>> {
        self.0.winding(queries)
    }
}

impl<C: Callee> Drop for OwnedField<C> {
    fn drop(&mut self) {
        let RemoteField { owner, number } = &self.0;
        // An encoding that cannot even forget is told of when it is next asked.
        let _: Result<(), _> = owner.ask(Method::Forget, &message(&[number]), &[], anything);
    }
}

/// A field that is lent.
pub(in crate::abi) struct FieldCallee<'a>(pub(in crate::abi) &'a dyn Field);

impl Callee for FieldCallee<'_> {
    fn call(
        &self,
        method: Method,
        request: &[u64],
        _: &[&dyn Callee],
    ) -> Result<Vec<u64>, PluginError> {
        let query = match method {
            Method::Features | Method::Winding => Reader::whole::<Query>(request)?,
            other => return Err(not_answered(other)),
        };
        Ok(asked(self.0, method, &query))
    }
}

fn asked(field: &dyn Field, method: Method, query: &Query) -> Vec<u64> {
    match method {
        Method::Winding => message(&[&field.winding(&query.points)]),
        _ => message(&[&field.features(&query.points)]),
    }
}

/// An encoding with the fields that it made and nobody has forgotten.
pub(in crate::abi) struct Fields {
    encoding: Box<dyn Encoding>,
    made: u64,
    fields: BTreeMap<u64, Box<dyn Field>>,
}

impl Fields {
    pub(in crate::abi) fn new(encoding: Box<dyn Encoding>) -> Self {
        Self { encoding, made: LENT, fields: BTreeMap::new() }
    }

    /// Answers with the encoding or one of its fields.
    pub(in crate::abi) fn served(
        &mut self,
        method: Method,
        request: &[u64],
    ) -> Result<Vec<u64>, PluginError> {
        let unknown = |number| PluginError::Internal(format!("there is no field {number}"));
        match method {
            Method::Encode => {
                let field = self.encoding.encode(&Reader::whole(request)?)?;
                self.made += 1;
                self.fields.insert(self.made, field);
                Ok(message(&[&self.made]))
            }
            Method::Features | Method::Winding => {
                let query: Query = Reader::whole(request)?;
                let field = self.fields.get(&query.field).ok_or_else(|| unknown(query.field))?;
                Ok(asked(field.as_ref(), method, &query))
            }
            Method::Forget => {
                let number = Reader::whole(request)?;
                self.fields.remove(&number).ok_or_else(|| unknown(number))?;
                Ok(Vec::new())
            }
            other => Err(not_answered(other)),
        }
    }
}
