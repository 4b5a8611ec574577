//! The named settings of hopping and flow rings are the same numbers in both.

use eeruf_core::{Micros, flow::FlowSettings, hopping::HoppingSettings, judge::TrackerSettings};

fn numbers(text: &str) -> Vec<u32> {
    text.split(',').filter_map(|word| word.trim_matches([' ', '\n', '\\', '{', '}']).parse().ok()).collect()
}

fn tracker_numbers(of: &TrackerSettings) -> Vec<u32> {
    let votes = [of.votes, of.score_limit, of.contradiction, of.solo_contradiction, of.tentative_votes, of.memory];
    let times = [of.t_delta, of.near, of.tentative_within].map(Micros::as_micros);
    [&times[..], &votes.map(u32::from)].concat()
}

#[test]
fn flow_settings_of_c_are_those_of_the_core() {
    let (_, after) = include_str!("../../../../c/eeruf.h").split_once("#define EERUF_FLOW(").unwrap();
    let (body, _) = after.split_once(", NULL}").unwrap();
    let of = FlowSettings::DEFAULT;
    let gaps = [of.shortest_gap, of.masked_adds, of.believed_takes, of.unserved_adds];
    let cycles = [of.shortest_cycle, of.rest, of.lead, of.longest_cycle, of.travel];
    // Without the window and the reach, which are parameters; blanking is none.
    let mut expected = vec![of.unserved_after.into(), of.step.as_micros(), 0];
    expected.extend(gaps.into_iter().chain(cycles).map(Micros::as_micros));
    expected.extend(tracker_numbers(&of.tracker));
    assert_eq!(numbers(body), expected);
}

#[test]
fn the_named_settings_of_c_are_those_of_the_core() {
    let header = include_str!("../../../../c/eeruf.h");
    for (name, settings) in [
        ("BALANCED", HoppingSettings::BALANCED),
        ("QUICK", HoppingSettings::QUICK),
        ("DRIVING", HoppingSettings::DRIVING),
        ("MAPS", HoppingSettings::MAPS),
    ] {
        let (_, after) = header.split_once(&format!("#define EERUF_HOPPING_{name}(")).expect(name);
        let (_, body) = after.split_once('{').expect(name);
        // The tracker's settings stand in inner braces, the others after them.
        let (_, body) = body.split_once('{').expect(name);
        let (tracker, body) = body.split_once('}').expect(name);
        let (others, _) = body.split_once('}').expect(name);
        let of = settings.tracker;
        assert_eq!(numbers(tracker), tracker_numbers(&of), "{name}");
        let solo = [settings.solo_rate, settings.solo_after, settings.solo_spacing];
        // The last is the code: the narrowest.
        let shifts = [settings.shift_after, settings.shift_spacing, settings.neighbours, 0];
        assert_eq!(numbers(others), [&solo.map(u32::from)[..], &shifts.map(u32::from)].concat(), "{name}");
    }
}
