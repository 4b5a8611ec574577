//! The named settings of hopping rings are the same numbers in both.

use eeruf_core::hopping::HoppingSettings;

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
        let numbers = |text: &str| text.split(',').filter_map(|word| word.trim().parse().ok()).collect::<Vec<u32>>();
        let of = settings.tracker;
        let votes = [of.votes, of.score_limit, of.contradiction, of.solo_contradiction, of.tentative_votes];
        let times = [of.t_delta, of.near, of.tentative_within].map(|time| time.as_micros());
        assert_eq!(numbers(tracker), [&times[..], &votes.map(u32::from)].concat(), "{name}");
        let solo = [settings.solo_rate, settings.solo_after, settings.solo_spacing];
        // The last is the code: the narrowest.
        let shifts = [settings.shift_after, settings.shift_spacing, settings.neighbours, 0];
        assert_eq!(numbers(others), [&solo.map(u32::from)[..], &shifts.map(u32::from)].concat(), "{name}");
    }
}
