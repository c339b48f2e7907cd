//! Fields of a project file that not every number fits. They are checked while they are read, so that a fault is told
//! with the line of its field.

use std::fmt;

use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::solver::Hold;

/// A weight: a positive number.
#[derive(Clone, Copy)]
pub(super) struct RawWeight(pub(super) f64);

impl Serialize for RawWeight {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_f64(self.0)
    }
}

impl<'de> Deserialize<'de> for RawWeight {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_f64(WeightVisitor)
    }
}

struct WeightVisitor;

impl Visitor<'_> for WeightVisitor {
    type Value = RawWeight;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a weight")
    }

    fn visit_f64<E: Error>(self, weight: f64) -> Result<RawWeight, E> {
        let is_weight = Hold::Weighted(weight).is_valid();
        is_weight.then_some(RawWeight(weight)).ok_or_else(|| E::custom(format!("the weight {weight} is not positive")))
    }

    fn visit_u64<E: Error>(self, weight: u64) -> Result<RawWeight, E> {
        self.visit_f64(weight as f64)
    }

    fn visit_i64<E: Error>(self, weight: i64) -> Result<RawWeight, E> {
        self.visit_f64(weight as f64)
    }
}
