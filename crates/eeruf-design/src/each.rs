//! A value of a ring file: one for all sensors, or a list with one for each.

use core::fmt;
use core::marker::PhantomData;

use serde::Deserialize;
use serde::de::{Deserializer, Error, IntoDeserializer, SeqAccess, Visitor};

/// One value for all sensors, or one for each.
#[derive(Clone, Debug, PartialEq)]
pub enum Each<T> {
    /// One value for all.
    All(T),
    /// One value for each sensor, in order.
    Of(Vec<T>),
}

impl<T: Copy> Each<T> {
    /// The value of each of this many sensors; `what` is the key.
    pub(crate) fn list(&self, what: &str, sensors: usize) -> Result<Vec<T>, String> {
        match self {
            Self::All(one) => Ok(vec![*one; sensors]),
            Self::Of(list) if list.len() == sensors => Ok(list.clone()),
            Self::Of(list) => Err(format!(
                "{what}: {} values; expected one for all, or one for each of {sensors} sensors",
                list.len()
            )),
        }
    }

    /// Returns true if the value is a list.
    pub(crate) fn is_list(&self) -> bool {
        matches!(self, Self::Of(_))
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Each<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(EachVisitor(PhantomData))
    }
}

struct EachVisitor<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for EachVisitor<T> {
    type Value = Each<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, or a list of one for each sensor")
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Each<T>, E> {
        T::deserialize(value.into_deserializer()).map(Each::All)
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Each<T>, E> {
        T::deserialize(value.into_deserializer()).map(Each::All)
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Each<T>, E> {
        T::deserialize(value.into_deserializer()).map(Each::All)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Each<T>, A::Error> {
        let mut list = Vec::new();
        while let Some(item) = items.next_element()? {
            list.push(item);
        }
        Ok(Each::Of(list))
    }
}
