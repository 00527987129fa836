//! Messages of a clearance that is lent.

use super::{Remote, anything};
use crate::abi::callee::{Callee, not_answered, unanswered};
use crate::abi::cells::{Put, Reader, Take, fields, malformed, message};
use crate::abi::methods::Method;
use crate::{Clearance, Contact, PluginError, Proximity};
use nalgebra::{Unit, Vector3};

fields!(Contact { bodies, distance_m, wanted_m });

impl Put for Proximity {
    fn put(&self, to: &mut Vec<u64>) {
        self.margin_m.put(to);
        self.normal.into_inner().put(to);
        self.carriers.put(to);
    }
}

impl Take for Proximity {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        let (margin_m, normal) = <(f64, Vector3<f64>)>::take(from)?;
        if (normal.norm() - 1.0).abs() > 1e-6 {
            return Err(malformed("a normal is not of unit length".into()));
        }
        Ok(Self { margin_m, normal: Unit::new_unchecked(normal), carriers: Take::take(from)? })
    }
}

impl<C: Callee> Clearance for Remote<C> {
    fn contact(&self, q: &[f64]) -> Option<Contact> {
        self.ask(Method::Contact, &message(&[&q]), &[], anything)
            .unwrap_or_else(|error| unanswered(error))
    }

    fn proximities(&self, q: &[f64], within_m: f64, found: &mut Vec<Proximity>) {
        *found = self
            .ask(Method::Proximities, &message(&[&q, &within_m]), &[], anything)
            .unwrap_or_else(|error| unanswered(error));
    }
}

/// A clearance that is lent.
pub(super) struct ClearanceCallee<'a>(pub(super) &'a dyn Clearance);

impl Callee for ClearanceCallee<'_> {
    fn call(
        &self,
        method: Method,
        request: &[u64],
        _: &[&dyn Callee],
    ) -> Result<Vec<u64>, PluginError> {
        match method {
            Method::Contact => {
                let q: Vec<f64> = Reader::whole(request)?;
                Ok(message(&[&self.0.contact(&q)]))
            }
            Method::Proximities => {
                let (q, within_m): (Vec<f64>, f64) = Reader::whole(request)?;
                let mut found = Vec::new();
                self.0.proximities(&q, within_m, &mut found);
                Ok(message(&[&found]))
            }
            other => Err(not_answered(other)),
        }
    }
}
