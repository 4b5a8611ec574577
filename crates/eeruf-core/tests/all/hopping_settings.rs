//! Settings of a hopping ring: each `with_*` sets what it names and nothing else, and the named sets are the numbers
//! that firmware was tried with.

use eeruf_core::{
    Micros, RingError,
    hopping::{HoppingCode, HoppingError, HoppingListening, HoppingSettings},
    judge::TrackerSettings,
};

#[test]
fn each_setting_of_a_hopping_ring_is_set_alone() {
    let kept = HoppingSettings::QUICK;
    let sets = |set: fn(&mut HoppingSettings), says: HoppingSettings| {
        let mut wanted = kept;
        set(&mut wanted);
        assert_eq!(says, wanted);
        assert_ne!(says, kept);
    };
    sets(|of| of.tracker = TrackerSettings::MAPS, kept.with_tracker(TrackerSettings::MAPS));
    sets(|of| of.solo_rate = 7, kept.with_solo_rate(7));
    sets(|of| of.solo_after = 7, kept.with_solo_after(7));
    sets(|of| of.solo_spacing = 7, kept.with_solo_spacing(7));
    sets(|of| of.shift_after = 7, kept.with_shift_after(7));
    sets(|of| of.shift_spacing = 7, kept.with_shift_spacing(7));
    sets(|of| of.shift_interval = Micros::new(7), kept.with_shift_interval(Micros::new(7)));
    sets(|of| of.neighbours = 7, kept.with_neighbours(7));
}

#[test]
fn what_a_hopping_ring_listens_to_is_set_alone() {
    let us = Micros::new;
    let listening = HoppingListening::new(us(36_000));
    assert_eq!((listening.window, listening.blanking, listening.reach), (us(36_000), us(0), us(36_000)));
    let deaf = listening.with_reach(us(50_000)).with_blanking(us(900));
    assert_eq!((deaf.window, deaf.blanking, deaf.reach), (us(36_000), us(900), us(50_000)));
}

#[test]
fn the_named_settings_are_these() {
    let numbers = |of: HoppingSettings| {
        let solo = (of.solo_rate, of.solo_after, of.solo_spacing);
        assert_eq!((of.shift_interval, of.neighbours), (Micros::from_millis(8), 4));
        (of.tracker, solo, (of.shift_after, of.shift_spacing))
    };
    assert_eq!(numbers(HoppingSettings::BALANCED), (TrackerSettings::BALANCED, (84, 5, 3), (0, 8)));
    assert_eq!(numbers(HoppingSettings::QUICK), (TrackerSettings::QUICK, (100, 4, 2), (0, 8)));
    assert_eq!(numbers(HoppingSettings::DRIVING), (TrackerSettings::BALANCED, (0, 5, 3), (0, 8)));
    assert_eq!(numbers(HoppingSettings::MAPS), (TrackerSettings::MAPS, (28, 8, 6), (0, 24)));
    assert_eq!(HoppingSettings::default(), HoppingSettings::BALANCED);
}

#[test]
fn the_fixed_text_of_each_error_names_what_is_wrong() {
    let us = Micros::new;
    for (error, named) in [
        (HoppingError::Sensors { sensors: 65, most: 64 }, "1 to 64 sensors"),
        (HoppingError::Phases { phases: 68 }, "2 to 67 phases"),
        (HoppingError::NotPrime { phases: 9, next: 11 }, "prime"),
        (HoppingError::Multiplier { first_multiplier: 11, phases: 11 }, "first multiplier"),
        (HoppingError::Step { step: us(0) }, "a step is 1 us"),
        (HoppingError::TDelta { t_delta: us(240), step: us(240) }, "t_delta must be less than the step"),
        (HoppingError::Votes { votes: 5, phases: 3 }, "votes"),
        (HoppingError::Period { period: us(1), least: us(2) }, "the period must be longer"),
        (HoppingError::Lag { sensor: 0, lag: us(2), most: us(1) }, "fire inside its period"),
        (HoppingError::Ring(RingError::Setting { name: "votes", value: 0, least: 1, most: 15 }), "tracker"),
        (HoppingError::Ring(RingError::Sensors { sensors: 2, capacity: 1 }), "listen"),
    ] {
        assert!(error.as_str().contains(named), "{error}: {}", error.as_str());
    }
    // As a compile-time check reads it.
    const TEXT: &str = match HoppingCode::new(65, 2, Micros::new(240)) {
        Ok(_) => "",
        Err(error) => error.as_str(),
    };
    assert_eq!(TEXT, "a hopping schedule has 1 to 64 sensors, no more than it has room for");
}
