//! `serde` for [`Schedule`]: the keys of a schedule file, `period_us`, `t_lag_us`, `t_wait_a_us`, `t_wait_b_us`, .. .
//!
//! The requirements that a schedule was verified for are not written: verify it again after reading.

use core::fmt;
use core::marker::PhantomData;

use ::serde::de::{Deserialize, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use ::serde::ser::{Serialize, SerializeStruct, Serializer};

use super::{MAX_PHASES, Phase, Schedule};
use crate::time::Micros;

const PERIOD: &str = "period_us";
const LAGS: &str = "t_lag_us";
const WAITS: [&str; MAX_PHASES] = [
    "t_wait_a_us",
    "t_wait_b_us",
    "t_wait_c_us",
    "t_wait_d_us",
    "t_wait_e_us",
    "t_wait_f_us",
    "t_wait_g_us",
    "t_wait_h_us",
];

impl<const K: usize, const M: usize> Serialize for Schedule<K, M> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut fields = serializer.serialize_struct("Schedule", 2 + M)?;
        fields.serialize_field(PERIOD, &self.period())?;
        fields.serialize_field(LAGS, self.t_lag())?;
        for (phase, name) in WAITS.into_iter().enumerate().take(M) {
            // At most eight.
            fields.serialize_field(name, self.t_wait(Phase(phase as u8)))?;
        }
        fields.end()
    }
}

impl<'de, const K: usize, const M: usize> Deserialize<'de> for Schedule<K, M> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        const FIELDS: [&str; 2 + MAX_PHASES] = {
            let [a, b, c, d, e, f, g, h] = WAITS;
            [PERIOD, LAGS, a, b, c, d, e, f, g, h]
        };
        let fields = FIELDS.get(..2 + M).unwrap_or(&FIELDS);
        deserializer.deserialize_struct("Schedule", fields, Fields::<K, M>)
    }
}

/// Reads a schedule, by names or in order.
struct Fields<const K: usize, const M: usize>;

impl<'de, const K: usize, const M: usize> Visitor<'de> for Fields<K, M> {
    type Value = Schedule<K, M>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a schedule: {PERIOD}, {LAGS} and {M} times waits, {} and so on", WAITS[0])
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Schedule<K, M>, A::Error> {
        let missing = |place| A::Error::invalid_length(place, &self);
        let period = seq.next_element()?.ok_or_else(|| missing(0))?;
        let lags = seq.next_element()?.ok_or_else(|| missing(1))?;
        let mut waits = [const { None }; M];
        for (phase, waits) in waits.iter_mut().enumerate() {
            *waits = Some(seq.next_element()?.ok_or_else(|| missing(2 + phase))?);
        }
        schedule(period, &lags, &waits)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Schedule<K, M>, A::Error> {
        let (mut period, mut lags, mut waits) = (None, None, [const { None }; M]);
        while let Some(Key::<M>(name)) = map.next_key()? {
            let twice = match name {
                PERIOD => period.replace(map.next_value()?).is_some(),
                LAGS => lags.replace(map.next_value()?).is_some(),
                _ => match WAITS.iter().position(|wait| *wait == name).and_then(|phase| waits.get_mut(phase)) {
                    Some(waits) => waits.replace(map.next_value()?).is_some(),
                    // Unreachable: `Key` knows no others.
                    None => false,
                },
            };
            if twice {
                return Err(A::Error::duplicate_field(name));
            }
        }
        let period = period.ok_or_else(|| A::Error::missing_field(PERIOD))?;
        let lags = lags.ok_or_else(|| A::Error::missing_field(LAGS))?;
        for (waits, name) in waits.iter().zip(WAITS) {
            if waits.is_none() {
                return Err(A::Error::missing_field(name));
            }
        }
        schedule(period, &lags, &waits)
    }
}

fn schedule<E: Error, const K: usize, const M: usize>(
    period: Micros,
    lags: &Times<K>,
    waits: &[Option<Times<K>>; M],
) -> Result<Schedule<K, M>, E> {
    let waits = waits.each_ref().map(|waits| waits.as_ref().map_or(&[][..], Times::used));
    Schedule::from_slices(period, lags.used(), waits).map_err(E::custom)
}

/// The name of a field of a schedule of `M` phases.
struct Key<const M: usize>(&'static str);

impl<'de, const M: usize> Deserialize<'de> for Key<M> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Name<const M: usize>;
        impl<const M: usize> Visitor<'_> for Name<M> {
            type Value = Key<M>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "a field of a schedule of {M} phases")
            }

            fn visit_str<E: Error>(self, name: &str) -> Result<Key<M>, E> {
                let known = [PERIOD, LAGS].into_iter().chain(WAITS.into_iter().take(M)).find(|known| *known == name);
                known.map(Key).ok_or_else(|| E::invalid_value(::serde::de::Unexpected::Str(name), &self))
            }
        }
        deserializer.deserialize_identifier(Name::<M>)
    }
}

/// Deserializer of up to `K` times.
struct Times<const K: usize> {
    times: [Micros; K],
    length: usize,
}

impl<const K: usize> Times<K> {
    fn used(&self) -> &[Micros] {
        self.times.get(..self.length).unwrap_or(&self.times)
    }
}

impl<'de, const K: usize> Deserialize<'de> for Times<K> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Numbers<const K: usize>(PhantomData<[Micros; K]>);
        impl<'de, const K: usize> Visitor<'de> for Numbers<K> {
            type Value = Times<K>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "up to {K} times in microseconds")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Times<K>, A::Error> {
                let mut read = Times { times: [Micros::ZERO; K], length: 0 };
                while let Some(time) = seq.next_element()? {
                    match read.times.get_mut(read.length) {
                        Some(place) => *place = time,
                        None => return Err(A::Error::invalid_length(K + 1, &self)),
                    }
                    read.length += 1;
                }
                Ok(read)
            }
        }
        deserializer.deserialize_seq(Numbers(PhantomData))
    }
}
