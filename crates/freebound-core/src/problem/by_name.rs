//! Serde for named options: read and written by name.

use std::fmt;
use std::marker::PhantomData;

use serde::de::{Deserialize, Deserializer, Error, Unexpected, Visitor};
use serde::ser::{Serialize, Serializer};

use super::{BoundaryShape, Family, Growth, Method, NamedOption, Spacing, Treatment};

/// Visitor that reads an option by its name. An error arises at the name, so that its message has the right line.
struct ByName<C>(PhantomData<C>);

impl<C: NamedOption> Visitor<'_> for ByName<C> {
    type Value = C;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "one of {}", C::names())
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<C, E> {
        C::named(text).ok_or_else(|| E::invalid_value(Unexpected::Str(text), &self))
    }
}

/// Implements serde by name for options.
macro_rules! stand_by_name {
    ($($choice:ty),+) => {$(
        impl Serialize for $choice {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str(&self.written())
            }
        }

        impl<'de> Deserialize<'de> for $choice {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                deserializer.deserialize_str(ByName(PhantomData))
            }
        }
    )+};
}

stand_by_name!(Method, BoundaryShape, Spacing, Family, Treatment, Growth);
