//! Ring files of sensors that differ: their requirements, their errors and their answers.

use crate::common::{accepted, small};
use eeruf_core::Micros;
use eeruf_design::certificate::Stated;
use eeruf_design::{Effort, RingDesign, RingSpec};

fn read(text: &str) -> RingSpec {
    RingSpec::from_text(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn design(spec: &RingSpec) -> RingDesign {
    let found = spec.shortest(&Effort { budget: 1_000_000, what_if: false, atlas: "" }, &mut ());
    found.expect("there is a schedule")
}

/// Three realistic rings of `rings/`, without the rest of their modules, which would decide their periods alone.
fn rings() -> [(&'static str, String); 3] {
    let rings = [
        ("car-12", include_str!("../../../../rings/car-12.toml")),
        ("hc-sr04-8-two-multiplexers", include_str!("../../../../rings/hc-sr04-8-two-multiplexers.toml")),
        ("mower-8-and-4", include_str!("../../../../rings/mower-8-and-4.toml")),
    ];
    rings.map(|(name, text)| {
        let rest = if text.contains("retrigger_us") { "" } else { "retrigger_us = 0\n" };
        (name, format!("{text}{rest}"))
    })
}

// The uneven rings have a shortest period that is verified and certified.
#[test]
fn uneven_rings_are_verified_and_certified() {
    let mut certificates = Vec::new();
    for ((name, text), period_us) in rings().into_iter().zip([34_100, 61_500, 37_000]) {
        let spec = read(&text);
        let found = design(&spec);
        assert!(found.found.proven, "{name}: {:?}", found.found);
        assert_eq!(found.schedule.period(), Micros::new(period_us), "{name}");
        let problem = found.spec.problem();
        assert_eq!(found.schedule.verify(&problem.requirements).violations().next(), None, "{name}");
        let verified = found.schedule.verified_each(&problem.requirements).expect("it is");
        for sensor in 0..spec.sensors {
            let limits = verified.limits_of(sensor as u8).expect("it is there");
            assert_eq!(limits.window, problem.requirements.window_of(sensor), "{name}");
        }
        let text = found.prove(1_000_000, |_| true).expect("a proof");
        let expected = format!("{period_us} us is the shortest period (tick {} us)", spec.tick.as_micros());
        assert_eq!(Stated::read(&text).expect("a claim").to_string(), expected, "{name}");
        certificates.push(text);
    }
    let certificates = small(certificates);
    for (text, says) in certificates.iter().zip(accepted("uneven", &certificates)) {
        assert_eq!(says, Stated::read(text).expect("a claim").to_string());
    }
}

#[test]
fn uneven_schedule_with_most_to_spare_is_chosen() {
    // The ring with each need increased by this much, in microseconds.
    let ring = |t_delta: u32, interval: u32, refire: u32| {
        let t_deltas = [999, 499, 499, 499, 499].map(|us| us + t_delta);
        read(&format!(
            "sensors = 5\nneighbours = 3\nt_delta_us = {t_deltas:?}\nwindow_us = {}\nmin_interval_us = {}\n\
             intervals_us = [[0, 4, {}]]",
            25_000 + refire,
            7_000 + interval,
            4_000 + interval
        ))
    };
    let found = design(&ring(0, 0, 0));
    let spare = found.to_spare.expect("an uneven ring that is proven");
    assert!(found.found.proven && spare.proven == [true; 3], "{spare:?}");
    let [t_delta, interval, refire] = [spare.t_delta, spare.interval, spare.refire].map(Micros::as_micros);
    assert_eq!([t_delta, interval, refire], [0, 1000, 0]);
    assert!(found.schedule.verify(&ring(t_delta, interval, refire).problem().requirements).ok(), "{spare:?}");
    // Half a tick more t_delta, a tick more interval, or later refiring takes longer.
    for harder in [ring(t_delta + 500, 0, 0), ring(t_delta, interval + 1000, 0), ring(t_delta, interval, refire + 1000)]
    {
        let longer = design(&harder);
        assert!(longer.found.proven && longer.found.value > found.found.value, "{:?}", longer.found);
    }
}

#[test]
fn what_would_make_an_uneven_ring_faster_is_said_and_true() {
    let text = "sensors = 4\nlayout = \"line\"\nneighbours = 2\nt_delta_us = [999, 499, 499, 499]\n\
                window_us = 25_000\nmin_interval_us = 9_000\n";
    let shared = read(&format!("{text}shared_lines = [[0, 1], [2, 3]]"));
    let search = Effort { budget: 1_000_000, what_if: true, atlas: "" };
    let found = shared.shortest(&search, &mut ()).expect("there is a schedule");
    let of = |need: &str| found.what_if.iter().find(|what| what.need.contains(need)).cloned();
    let own = of("an echo line for each").expect("lines are shared");
    let alone = design(&read(text));
    assert!(own.proven && own.period == alone.found.value, "{own:?} {:?}", alone.found);
    assert!(own.period < found.found.value, "two lines for four sensors take longer");
    let listening = of("listening a tenth less").expect("there is a window");
    let less = format!("{text}shared_lines = [[0, 1], [2, 3]]").replace("25_000", "22_000");
    assert_eq!(listening.period, design(&read(&less)).found.value);
    assert!(of("every interval").is_some() && of("every t_delta").is_some(), "{:?}", found.what_if);
}

#[test]
fn a_list_of_equal_numbers_asks_for_what_one_number_asks_for() {
    for (neighbours, layout) in [(3, "line"), (4, "ring")] {
        let common =
            format!("sensors = 8\nneighbours = {neighbours}\nlayout = \"{layout}\"\nmin_interval_us = 15_000\n");
        let even = design(&read(&format!("{common}t_delta_us = 999\nwindow_us = 36_000")));
        let list = |number: u32| format!("{:?}", [number; 8]);
        let uneven = design(&read(&format!("{common}t_delta_us = {}\nwindow_us = {}", list(999), list(36_000))));
        assert!(even.found.proven && uneven.found.proven);
        assert_eq!(even.found.value, uneven.found.value, "{layout}");
    }
}

#[test]
fn a_robot_that_moves_needs_as_much_more_of_every_tolerance() {
    let spec = read(
        "sensors = 3\nmin_interval_us = 10_000\nmax_range_m = [2.0, 3.0, 2.0]\njitter_us = [100, 200, 300]\n\
         speed_m_s = 1.0",
    );
    let found = design(&spec);
    let requirements = found.spec.problem().requirements;
    let t_delta: Vec<u32> = (0..3).map(|sensor| requirements.t_delta_of(sensor).as_micros()).collect();
    let motion = 2 * u64::from(found.schedule.max_refire().as_micros()) * 1000;
    let motion = motion.div_ceil(u64::from(spec.c.mm_per_s())) as u32;
    assert!(motion > 200 && t_delta[0] >= 100 + motion, "{t_delta:?} {motion}");
    assert_eq!([t_delta[1] - t_delta[0], t_delta[2] - t_delta[1]], [100, 100]);
}

// Sensors listen for their range and wait for their retrigger time.
#[test]
fn sensors_listen_for_range_and_wait_for_retrigger() {
    let text = "sensors = 2\nmin_interval_us = 0\njitter_us = 100\nretrigger_us = 40_000\n";
    let uneven = read(&format!("{text}max_range_m = [1.0, 2.0]"));
    let requirements = uneven.problem().requirements;
    assert_eq!(requirements.window_of(0), uneven.c.echo_time(1000));
    assert_eq!(requirements.refire_of(0), Micros::from_millis(40));
    assert!(design(&uneven).schedule.min_refire() >= Micros::from_millis(40));
    // If all sensors are alike, they may as well listen until then.
    assert_eq!(read(&format!("{text}max_range_m = 2.0")).window, Micros::from_millis(40));
}

#[test]
fn file_error_names_key_value_and_expectation() {
    let ring = "sensors = 4\nt_delta_us = 99\nmin_interval_us = 5000\nwindow_us = 9000\n";
    for (more, expected) in [
        ("intervals_us = [[0, 4, 9]]", "intervals_us: sensors 0 and 4; expected two different ones from 0 to 3"),
        ("intervals_us = [[0, 1, 9], [1, 0, 9]]", "intervals_us: sensors 1 and 0 twice; expected each pair once"),
        ("shared_lines = [[2]]", "shared_lines: [2]; expected two or more different sensors from 0 to 3"),
        ("shared_lines = [[0, 64]]", "shared_lines: [0, 64]; expected two or more different sensors from 0 to 3"),
        ("together = [[1, 1]]", "together: [1, 1]; expected two or more different sensors from 0 to 3"),
        (
            "together = [[0, 1], [1, 2]]\nintervals_us = [[0, 1, 0], [1, 2, 0]]",
            "together: sensor 1 is in two groups; expected one",
        ),
        (
            "together = [[0, 1]]",
            "together: sensors 0 and 1 must keep 5 ms between their firings; expected a layout in which they are no \
             neighbours, or intervals_us = [[0, 1, 0]], and no shared line",
        ),
    ] {
        let error = RingSpec::from_text(&format!("{ring}{more}")).unwrap_err();
        assert_eq!(error.message(), expected);
    }
    let with = |text: &str| RingSpec::from_text(text).unwrap_err().message().to_owned();
    let list = "sensors = 4\nt_delta_us = 99\nmin_interval_us = 5000\nwindow_us = [9000, 9000]";
    assert_eq!(with(list), "window_us: 2 values; expected one for all, or one for each of 4 sensors");
    let zero = "sensors = 2\nt_delta_us = 99\nmin_interval_us = 5000\nwindow_us = [9000, 0]";
    assert_eq!(with(zero), "a listening window of 0 us; expected window_us or max_range_m above zero");
    let text = with("sensors = 2\nt_delta_us = \"99\"\nmin_interval_us = 5000\nwindow_us = 9000");
    assert_eq!(text, "t_delta_us: string \"99\"; expected a number, or a list of one for each sensor");
    let negative = with("sensors = 2\nt_delta_us = [99, -1]\nmin_interval_us = 5000\nwindow_us = 9000");
    assert_eq!(negative, "t_delta_us: integer `-1`; expected a whole number from 0 to 4294967295");
    let long =
        read("sensors = 2\nt_delta_us = 99\nmin_interval_us = 4_000_000_000\nwindow_us = [900, 900]\ntick_us = 1");
    let error = long.shortest(&Effort::default(), &mut ()).unwrap_err().to_string();
    assert!(
        error.starts_with("firing one by one already takes 8000 s") && error.contains("a shorter interval"),
        "{error}"
    );
}

#[test]
fn modules_say_how_far_sensors_see_and_how_long_they_rest() {
    const RING: &str = "sensors = 3\nmin_interval_us = 5000\njitter_us = 100\n";
    let same = |one: &str, other: &str| {
        let [one, other] = [one, other].map(|more| read(&format!("{RING}{more}")));
        let of = |spec: &RingSpec| {
            let requirements = spec.problem().requirements;
            [0, 1, 2].map(|sensor| (requirements.window_of(sensor), requirements.refire_of(sensor)))
        };
        assert_eq!(of(&one), of(&other));
        assert_eq!((one.window, one.listening, one.retrigger), (other.window, other.listening, other.retrigger));
    };
    same("module = \"hc-sr04\"", "max_range_m = 4.0\nretrigger_us = 60000");
    same("module = \"hc-sr04\"\nmax_range_m = 2.5", "max_range_m = 2.5\nretrigger_us = 60000");
    same("module = \"hc-sr04\"\nretrigger_us = 40000", "max_range_m = 4.0\nretrigger_us = 40000");
    same("module = \"hc-sr04\"\nwindow_us = 20000", "window_us = 20000");
    let mixed = "module = [\"hc-sr04\", \"ping\", { like = \"ping\", sees_to_m = 2.0 }]";
    same(mixed, "max_range_m = [4.0, 3.0, 2.0]\nretrigger_us = [60000, 19455, 19455]");
    let spec = read(&format!("{RING}{mixed}"));
    assert_eq!(spec.modules.iter().map(|module| module.name).collect::<Vec<_>>(), ["hc-sr04", "ping", "ping"]);
    let wrong = RingSpec::from_text(&format!("{RING}module = [\"ping\"]")).unwrap_err();
    assert_eq!(wrong.message(), "module: 1 modules; expected one for all, or one for each of 3 sensors");
    let none = RingSpec::from_text(RING).unwrap_err();
    assert_eq!(none.message(), "expected one of window_us, max_range_m and module");
    let both = read(&format!("{RING}window_us = 20000\nretrigger_us = 60000"));
    let ms = Micros::from_millis;
    assert_eq!((both.window, both.listening, both.retrigger), (ms(60), ms(20), ms(60)));
}
