//! Serialises arrays of any length; serde itself has a few fixed lengths only.

use core::fmt;
use core::marker::PhantomData;

use serde::de::{Error, SeqAccess, Visitor};
use serde::ser::SerializeTuple;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Writes the elements as a tuple.
pub(crate) fn serialize<T: Serialize, const N: usize, W: Serializer>(
    array: &[T; N],
    serializer: W,
) -> Result<W::Ok, W::Error> {
    let mut tuple = serializer.serialize_tuple(N)?;
    for element in array {
        tuple.serialize_element(element)?;
    }
    tuple.end()
}

/// Reads exactly `N` elements.
pub(crate) fn deserialize<'de, T: Deserialize<'de> + Copy, const N: usize, R: Deserializer<'de>>(
    deserializer: R,
) -> Result<[T; N], R::Error> {
    const { assert!(N > 0, "nothing is written for an array without elements") };
    deserializer.deserialize_tuple(N, Elements(PhantomData))
}

struct Elements<T, const N: usize>(PhantomData<T>);

impl<'de, T: Deserialize<'de> + Copy, const N: usize> Visitor<'de> for Elements<T, N> {
    type Value = [T; N];

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{N} elements")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<Self::Value, A::Error> {
        let first = elements.next_element()?.ok_or_else(|| Error::invalid_length(0, &self))?;
        let mut array = [first; N];
        for (index, slot) in array.iter_mut().enumerate().skip(1) {
            *slot = elements.next_element()?.ok_or_else(|| Error::invalid_length(index, &self))?;
        }
        Ok(array)
    }
}
