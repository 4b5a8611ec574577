//! The formats of other crates, where their features are on: `serde` and `defmt`.
#![cfg(any(feature = "serde", feature = "defmt"))]

#[cfg(feature = "serde")]
mod schedules_as_serde_sees_them {
    use eeruf_core::tables::{PAPER_12, TABLE_I_D};
    use eeruf_core::{Micros, Schedule};

    #[test]
    fn a_schedule_goes_into_json_and_back_with_the_keys_of_a_schedule_file() {
        let text = serde_json::to_string(&TABLE_I_D).unwrap();
        assert!(text.starts_with(r#"{"period_us":100000,"t_lag_us":[0,25000,"#), "{text}");
        assert!(text.contains(r#""t_wait_b_us":[18000,12000,"#), "{text}");
        assert_eq!(serde_json::from_str::<Schedule<12>>(&text).unwrap(), TABLE_I_D);
        // With room for more, and in any order of keys.
        let smaller = r#"{"t_wait_b_us": [7, 5], "t_lag_us": [0, 20], "t_wait_a_us": [9, 9], "period_us": 60}"#;
        let read: Schedule<64> = serde_json::from_str(smaller).unwrap();
        assert_eq!((read.sensors(), read.period()), (2, Micros::new(60)));
        // What it was verified for stays behind.
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
            (r#"{"t_lag_us": [0, 1, 2]}"#, "up to 2 times"),
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

#[cfg(feature = "defmt")]
mod everything_public_has_a_format {
    use defmt::Format;
    use eeruf_core::search::{Outcome, ProblemError, SearchError};
    use eeruf_core::*;

    const fn formats<T: Format>() {}

    #[test]
    fn each_type_that_firmware_can_hold_can_be_logged() {
        formats::<(Adaptation<'_, 12>, Advice, Ladder<'_, 12>, LadderError)>();
        formats::<(Criterion, Interval, Requirements<'_>, Separation, Layout<'_>, LayoutError)>();
        formats::<(EchoFilter<12>, EchoFilter<12, 8>, FilterError, ReadingKind, Tally, Verdict)>();
        formats::<(Edge, DurationError, Instant, Micros, SpeedOfSound, SensorError)>();
        formats::<(PeriodStats, Reading, RingConfig, RingConfig<8>, RingError, RingEvent)>();
        formats::<(ScheduledRing<'_, 12>, ScheduledRing<'_, 12, 8>, SensorWatch<12>, Blind, LastAccepted)>();
        formats::<(Phase, Schedule<12>, ScheduleError, VerifiedFor, VerifiedSchedule<12>)>();
        formats::<(BrokenPromise, ImmediateRefiring<'_, 12>, Limits<'_>, ScheduledFiring<'_, 12>, SchedulerStep)>();
        formats::<(Verification<'_, 12>, Violation, ViolationKind, Violations<'_, 12>)>();
        formats::<(SensorLimits, Uneven<'_>, UnevenError, UnevenFiring<'_, 12>, UnevenSchedule<12>)>();
        formats::<(HoppingCode, HoppingSchedule<12>, HoppingSettings, HoppingListening, HoppingError)>();
        formats::<(HoppingRing<12>, HoppingRing<12, 8>, HoppingFiring<'_, 12>)>();
        formats::<(EchoTracker<12>, TrackerSettings, TrackerError, Firing, RateFilter<12>, Survey)>();
        formats::<(PhaseTable<'_, 12>, PhaseRequirements<'_>, PhaseCriterion, Audible)>();
        formats::<(PhaseVerification<'_>, PhaseViolation, PhaseViolations<'_>, PhaseSeparation, PhaseInterval)>();
        formats::<(Outcome<()>, ProblemError, SearchError)>();
    }
}
