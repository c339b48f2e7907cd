//! Fields of a project file that not every text or number fits. They are checked while they are read, so that a fault is
//! told with the line of its field.

use std::fmt;
use std::marker::PhantomData;
use std::str::FromStr as _;

use serde::de::{Error, Unexpected, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::solver::{Choice, Family, Hold};

/// A family by its name.
#[derive(Clone, Default)]
pub(super) struct RawFamily(pub(super) Family);

impl Serialize for RawFamily {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(&self.0)
    }
}

impl<'de> Deserialize<'de> for RawFamily {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_str(FamilyVisitor)
    }
}

struct FamilyVisitor;

impl Visitor<'_> for FamilyVisitor {
    type Value = RawFamily;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the name of a family")
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<RawFamily, E> {
        let family = Family::from_str(text);
        family.map(RawFamily).map_err(|choice| E::custom(format!("\"{text}\" is no family: {choice}")))
    }
}

/// One of a few choices by its name.
#[derive(Clone, Copy, Default)]
pub(super) struct RawChoice<C>(pub(super) C);

impl<C: Choice> Serialize for RawChoice<C> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.0.name())
    }
}

impl<'de, C: Choice> Deserialize<'de> for RawChoice<C> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_str(ChoiceVisitor(PhantomData))
    }
}

struct ChoiceVisitor<C>(PhantomData<C>);

impl<C: Choice> Visitor<'_> for ChoiceVisitor<C> {
    type Value = RawChoice<C>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<&str> = C::ALL.iter().map(|choice| choice.name()).collect();
        write!(f, "one of {}", names.join(", "))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<RawChoice<C>, E> {
        C::named(text).map(RawChoice).ok_or_else(|| E::invalid_value(Unexpected::Str(text), &self))
    }
}

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
        match Hold::Weighted(weight).invalid_weight() {
            Some(_) => Err(E::custom(format!("the weight {weight} is not positive"))),
            None => Ok(RawWeight(weight)),
        }
    }

    fn visit_u64<E: Error>(self, weight: u64) -> Result<RawWeight, E> {
        self.visit_f64(weight as f64)
    }

    fn visit_i64<E: Error>(self, weight: i64) -> Result<RawWeight, E> {
        self.visit_f64(weight as f64)
    }
}
