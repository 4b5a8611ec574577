use super::*;

const HEARING: Hearing = Hearing {
    blanking: 10,
    window: 100,
    refire: 100,
    dead_time: 5,
    echoes: 1,
    gain: GainProfile::Constant,
    gain_full_s: 1.0,
    rise_ns: 0.0,
};

fn arrival(at: u64, level_over_threshold_db: f32) -> Arrival {
    Arrival { onset: at, at, sent: 0, path: at as u32, level_over_threshold_db, rise: None }
}

fn hears(hearing: &Hearing, arrivals: &[(u64, f32)]) -> Vec<u64> {
    let mut receiver = Receiver::NEW;
    receiver.fire(1000, hearing);
    for &(at, level_over_threshold_db) in arrivals {
        receiver.insert(arrival(at, level_over_threshold_db), hearing);
    }
    while receiver.next_at() != NEVER {
        receiver.hear((receiver.next_at() - 1000) as u32, hearing);
    }
    receiver.heard().iter().map(|heard| heard.arrival.at).collect()
}

#[test]
fn the_first_loud_arrival_within_the_window_is_heard() {
    assert_eq!(hears(&HEARING, &[(1009, 9.0), (1060, 3.0), (1050, 3.0), (1040, -0.1)]), [1050]);
    assert_eq!(hears(&HEARING, &[(1010, 0.0)]), [1010]);
    assert_eq!(hears(&HEARING, &[(1100, 0.0)]), [1100]);
    assert!(hears(&HEARING, &[(1101, 9.0)]).is_empty());
}

#[test]
fn several_echoes_are_a_burst_apart_and_eight_at_the_most() {
    let several = Hearing { echoes: 8, ..HEARING };
    assert_eq!(hears(&several, &[(1033, 1.0), (1020, 1.0), (1024, 1.0), (1028, 1.0)]), [1020, 1028, 1033]);
    let many: Vec<_> = (0..12).map(|i| (1095 - 6 * i, 1.0)).collect();
    assert_eq!(hears(&several, &many).len(), 8);
}

#[test]
fn what_comes_too_late_for_one_firing_is_heard_by_the_next() {
    let mut receiver = Receiver::NEW;
    receiver.fire(1000, &HEARING);
    receiver.insert(arrival(1250, 1.0), &HEARING);
    receiver.stop();
    receiver.fire(1200, &HEARING);
    assert_eq!(receiver.next_at(), 1250);
    receiver.insert(arrival(1240, 1.0), &HEARING);
    assert_eq!(receiver.next_at(), 1240);
    assert!(!receiver.cares(1245, 4) && receiver.cares(1235, 4) && receiver.cares(1301, 0));
}

#[test]
fn the_gain_of_the_receiver_grows_from_its_own_firing() {
    let linear = Hearing { gain: GainProfile::Linear, gain_full_s: 100e-9, ..HEARING };
    // Half way to full gain, the gain is 6 dB lower.
    assert!(hears(&linear, &[(1050, 6.0)]).is_empty());
    assert_eq!(hears(&linear, &[(1050, 6.1)]), [1050]);
}

// A threshold detector hears faint echoes later by up to a burst.
#[test]
fn threshold_detector_hears_faint_echoes_later() {
    let walking = Hearing { rise_ns: 20.0, ..HEARING };
    // An echo is late by a whole burst at the threshold, by a tenth 20 dB over it. None is heard before blanking ends.
    assert_eq!(hears(&walking, &[(1050, 0.0)]), [1070]);
    assert_eq!(hears(&walking, &[(1050, 20.0)]), [1052]);
    assert_eq!(hears(&walking, &[(1009, 20.0)]), [1011]);
    assert!(hears(&walking, &[(1008, 200.0)]).is_empty());
    assert!(hears(&walking, &[(1099, 0.0)]).is_empty());
    // The louder of two echoes is heard first, although it begins later.
    assert_eq!(hears(&walking, &[(1050, 0.0), (1055, 20.0)]), [1057]);
}

// An echo that crosses the threshold after its receiver has fired again is heard by the new firing.
#[test]
fn echo_after_the_next_firing_is_heard_then() {
    let walking = Hearing { rise_ns: 20.0, refire: 45, ..HEARING };
    let mut receiver = Receiver::NEW;
    receiver.fire(1000, &walking);
    receiver.insert(arrival(1095, 0.0), &walking);
    receiver.stop();
    receiver.fire(1100, &walking);
    assert_eq!(receiver.next_at(), 1115);
}
