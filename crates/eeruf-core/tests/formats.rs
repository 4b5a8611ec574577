//! The formats of other crates, if their features are on: `serde` and `defmt`.
#![cfg(any(feature = "serde", feature = "defmt"))]

#[cfg(feature = "serde")]
mod schedules_as_serde_sees_them {
    use eeruf_core::tables::{PAPER_12, TABLE_I_D};
    use eeruf_core::{Micros, Schedule};
    use serde::de::{Deserialize, Deserializer, Error, Visitor, value};
    use serde::forward_to_deserialize_any;

    /// A format that records the fields requested and has none of them.
    struct AsksFor;

    impl<'de> Deserializer<'de> for AsksFor {
        type Error = value::Error;

        fn deserialize_any<V: Visitor<'de>>(self, _visitor: V) -> Result<V::Value, value::Error> {
            Err(Error::custom("no struct"))
        }

        fn deserialize_struct<V: Visitor<'de>>(
            self,
            name: &'static str,
            fields: &'static [&'static str],
            _visitor: V,
        ) -> Result<V::Value, value::Error> {
            Err(Error::custom(format_args!("{name} of {}", fields.join(" "))))
        }

        forward_to_deserialize_any! {
            bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit unit_struct
            newtype_struct seq tuple tuple_struct map enum identifier ignored_any
        }
    }

    // A format is asked for the fields of every phase.
    #[test]
    fn format_is_asked_for_its_phases() {
        let one = Schedule::<2, 1>::deserialize(AsksFor).unwrap_err().to_string();
        assert_eq!(one, "Schedule of period_us t_lag_us t_wait_a_us");
        let three = Schedule::<2, 3>::deserialize(AsksFor).unwrap_err().to_string();
        assert_eq!(three, "Schedule of period_us t_lag_us t_wait_a_us t_wait_b_us t_wait_c_us");
    }

    // A schedule goes into json and back with the keys of a schedule file.
    #[test]
    fn schedule_goes_into_json_and_back() {
        let text = serde_json::to_string(&TABLE_I_D).unwrap();
        assert!(text.starts_with(r#"{"period_us":100000,"t_lag_us":[0,25000,"#), "{text}");
        assert!(text.contains(r#""t_wait_b_us":[18000,12000,"#), "{text}");
        assert_eq!(serde_json::from_str::<Schedule<12>>(&text).unwrap(), TABLE_I_D);
        // With room for more, and in any order of keys.
        let smaller = r#"{"t_wait_b_us": [7, 5], "t_lag_us": [0, 20], "t_wait_a_us": [9, 9], "period_us": 60}"#;
        let read: Schedule<64> = serde_json::from_str(smaller).unwrap();
        assert_eq!((read.sensors(), read.period()), (2, Micros::new(60)));
        // The verified requirements are not written.
        let verified = serde_json::to_string(&PAPER_12).unwrap();
        assert!(verified == text && !serde_json::from_str::<Schedule<12>>(&verified).unwrap().is_verified());
    }

    #[test]
    fn a_schedule_in_order_of_its_fields_without_names_is_read_too() {
        let read: Schedule<2> = serde_json::from_str("[60, [0, 20], [9, 9], [7, 5]]").unwrap();
        let times = |times: [u32; 2]| times.map(Micros::new);
        assert_eq!(read, Schedule::new(Micros::new(60), times([0, 20]), [times([9, 9]), times([7, 5])]).unwrap());
    }

    #[test]
    fn what_is_no_schedule_is_refused_by_what_is_wrong_with_it() {
        for (text, expected) in [
            (r#"{"period_us": 60}"#, "missing field `t_lag_us`"),
            (r#"{"period_us": 60, "t_lag_us": [0], "t_wait_a_us": [9]}"#, "missing field `t_wait_b_us`"),
            (r#"{"period_us": 60, "period_us": 60}"#, "duplicate field `period_us`"),
            (r#"{"t_wait_c_us": [9]}"#, "a field of a schedule of 2 phases"),
            (r#"{"t_lag_us": [0, 1, 2]}"#, "invalid length 3, expected up to 2 times"),
            (r#"[60, [0], [9], [60]]"#, "sensor 1 fires 60 us into phase b; expected less than the period of 60 us"),
            (r#"[60, [0], [9], [1, 2]]"#, "phase b has 2 waits; expected one for each of 1 sensors"),
            ("[60, [0], [9]]", "invalid length 3"),
            ("7", "a schedule"),
        ] {
            let error = serde_json::from_str::<Schedule<2>>(text).unwrap_err().to_string();
            assert!(error.contains(expected), "{text}: {error}");
        }
    }
}

#[cfg(feature = "serde")]
mod a_format_that_counts_fields {
    use eeruf_core::{Micros, Schedule};
    use serde::de::value::Error;
    use serde::ser::{Error as _, Impossible, Serialize, SerializeStruct, Serializer};

    /// A format that counts the fields of a struct, which formats such as CBOR write before them.
    struct Count;

    /// Number of fields announced, and of fields written.
    struct Fields(usize, usize);

    type Never = Impossible<(usize, usize), Error>;

    macro_rules! refuse {
        ($($name:ident($($of:ty),*) -> $gives:ty;)*) => {
            $(fn $name(self, $(_: $of),*) -> Result<$gives, Error> {
                Err(Error::custom("no struct"))
            })*
        };
    }

    impl Serializer for Count {
        type Ok = (usize, usize);
        type Error = Error;
        type SerializeSeq = Never;
        type SerializeTuple = Never;
        type SerializeTupleStruct = Never;
        type SerializeTupleVariant = Never;
        type SerializeMap = Never;
        type SerializeStruct = Fields;
        type SerializeStructVariant = Never;

        refuse! {
            serialize_bool(bool) -> Self::Ok;
            serialize_i8(i8) -> Self::Ok;
            serialize_i16(i16) -> Self::Ok;
            serialize_i32(i32) -> Self::Ok;
            serialize_i64(i64) -> Self::Ok;
            serialize_u8(u8) -> Self::Ok;
            serialize_u16(u16) -> Self::Ok;
            serialize_u32(u32) -> Self::Ok;
            serialize_u64(u64) -> Self::Ok;
            serialize_f32(f32) -> Self::Ok;
            serialize_f64(f64) -> Self::Ok;
            serialize_char(char) -> Self::Ok;
            serialize_str(&str) -> Self::Ok;
            serialize_bytes(&[u8]) -> Self::Ok;
            serialize_none() -> Self::Ok;
            serialize_unit() -> Self::Ok;
            serialize_unit_struct(&'static str) -> Self::Ok;
            serialize_unit_variant(&'static str, u32, &'static str) -> Self::Ok;
            serialize_seq(Option<usize>) -> Never;
            serialize_tuple(usize) -> Never;
            serialize_tuple_struct(&'static str, usize) -> Never;
            serialize_tuple_variant(&'static str, u32, &'static str, usize) -> Never;
            serialize_map(Option<usize>) -> Never;
            serialize_struct_variant(&'static str, u32, &'static str, usize) -> Never;
        }

        fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<Self::Ok, Error> {
            value.serialize(self)
        }

        fn serialize_newtype_struct<T: Serialize + ?Sized>(self, _: &'static str, of: &T) -> Result<Self::Ok, Error> {
            of.serialize(self)
        }

        fn serialize_newtype_variant<T: Serialize + ?Sized>(
            self,
            _: &'static str,
            _: u32,
            _: &'static str,
            of: &T,
        ) -> Result<Self::Ok, Error> {
            of.serialize(self)
        }

        fn serialize_struct(self, _: &'static str, announced: usize) -> Result<Fields, Error> {
            Ok(Fields(announced, 0))
        }
    }

    impl SerializeStruct for Fields {
        type Ok = (usize, usize);
        type Error = Error;

        fn serialize_field<T: Serialize + ?Sized>(&mut self, _: &'static str, _: &T) -> Result<(), Error> {
            self.1 += 1;
            Ok(())
        }

        fn end(self) -> Result<(usize, usize), Error> {
            Ok((self.0, self.1))
        }
    }

    fn fields<const M: usize>() -> (usize, usize) {
        let schedule = Schedule::<2, M>::from_firing(Micros::new(60), [[Micros::ZERO; 2]; M]).unwrap();
        schedule.serialize(Count).unwrap()
    }

    #[test]
    fn a_schedule_says_as_many_as_it_writes() {
        assert_eq!([fields::<1>(), fields::<2>(), fields::<3>(), fields::<8>()], [(3, 3), (4, 4), (5, 5), (10, 10)]);
    }
}

#[cfg(feature = "defmt")]
mod everything_public_has_a_format {
    use defmt::Format;
    use eeruf_core::{adaptation::*, conditions::*, flow::*, judge::*, plan::*, survey::*, watch::*, *};

    const fn formats<T: Format>() {}

    #[test]
    fn each_type_that_firmware_can_hold_can_be_logged() {
        formats::<(Adaptation<'_, VerifiedSchedule<12>>, RequirementsError)>();
        formats::<(Criterion, Least, Requirements<'_>, Layout<'_>)>();
        formats::<(EchoFilter<12>, EchoFilter<12, 8>, ReadingKind, Tally, Verdict)>();
        formats::<(Edge, Instant, Micros, SpeedOfSound, SensorError)>();
        formats::<(PeriodStats, Reading, RingConfig, RingConfig<8>, RingError, RingEvent)>();
        formats::<(ScheduledRing<'_, 12>, ScheduledRing<'_, 12, 8>, SensorWatch<12>, SensorState)>();
        formats::<(Phase, Schedule<12>, ScheduleError, VerifiedFor, VerifiedSchedule<12>)>();
        formats::<(BrokenPromise, ImmediateRefiring<'_, 12>, PlanLimits<'_>, ScheduledFiring<'_, 12>, Upcoming)>();
        formats::<(Verification<'_, 12>, Violation, ViolationKind)>();
        formats::<(SensorLimits, Uneven<'_>, EachSensor<12>)>();
        formats::<(TurnSettings, BeliefSettings, FiringContext, Survey)>();
        formats::<(FlowRing<12>, FlowRing<12, 8, EachSensor<12>>)>();
        formats::<Verification<'_, 12>>();
    }
}
