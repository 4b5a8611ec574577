//! Schedules of many phases as the program designs, verifies and writes them.

// Public, for firmware to put where it likes.
#[expect(unreachable_pub)]
#[path = "emitted/hopping_8.rs"]
mod hopping_8;
// Public, for firmware to put where it likes.
#[expect(unreachable_pub)]
#[path = "emitted/hopping_mower.rs"]
mod hopping_mower;

use eeruf_core::{
    Instant, Micros, RingEvent,
    hopping::{HoppingListening, HoppingRing, HoppingSettings},
};
use serde_json::Value;

use crate::common::{C, Scratch, compile_and_run, cpp, eeruf, json};

/// Eight sensors, `t_delta` of 150 us, a window of 36 ms.
fn ring(min_interval_us: u32) -> (Scratch, String) {
    let keys = "sensors = 8\nt_delta_us = 150\nwindow_us = 36_000\n";
    let (folder, file) = Scratch::new("ring.toml", &format!("{keys}min_interval_us = {min_interval_us}\n"));
    (folder, file.display().to_string())
}

// The shortest period is window and code and proven where neighbours may fire together.
#[test]
fn shortest_many_phase_period_is_window_and_code() {
    for (sensors, margin, separation) in [(1, None, 301), (7, None, 301), (8, None, 301), (12, Some("90"), 240)] {
        let keys = format!("sensors = {sensors}\nt_delta_us = 150\nwindow_us = 36_000\nmin_interval_us = 0\n");
        let (folder, file) = Scratch::new("ring.toml", &keys);
        let margin = margin.map_or(vec![], |margin| vec!["--margin-us", margin]);
        let asked = [&["design", file.to_str().unwrap(), "--phases", "5"][..], &margin].concat();
        let found = json(&[&asked[..], &["--json"]].concat());
        assert_eq!(found["value_us"], 36_000 + (sensors - 1) * separation);
        assert_eq!((&found["bound_us"], &found["proven"]), (&found["value_us"], &true.into()));
        // What was found keeps what it should, by a program that takes nothing as proven.
        let schedule = folder.path().join("schedule.toml");
        std::fs::write(&schedule, eeruf(&[&asked[..], &["--emit", "toml"]].concat()).out).unwrap();
        let verify = ["verify", schedule.to_str().unwrap(), "--t-delta-us", "150", "--window-us", "36000", "--json"];
        let report = json(&[&verify[..], &margin].concat());
        assert_eq!(report["ok"], true, "{sensors}: {report}");
    }
}

// Neighbours keep their interval in all phases and the bound says how much may be left.
#[test]
fn neighbours_keep_their_interval_in_all_phases() {
    let (folder, file) = ring(12_000);
    let asked = ["design", &file, "--phases", "11", "--margin-us", "90"];
    let found = json(&[&asked[..], &["--json"]].concat());
    let (value, bound) = (found["value_us"].as_u64().unwrap(), found["bound_us"].as_u64().unwrap());
    assert_eq!((bound, &found["proven"]), (48_000, &false.into()));
    assert!((bound..=60_000).contains(&value), "{value}");
    let schedule = folder.path().join("schedule.toml");
    std::fs::write(&schedule, eeruf(&[&asked[..], &["--emit", "toml"]].concat()).out).unwrap();
    let verify = ["verify", schedule.to_str().unwrap(), "--t-delta-us", "150", "--window-us", "36000"];
    let keeps = |interval| {
        eeruf(&[&verify[..], &["--margin-us", "90", "--min-interval-us", interval]].concat()).code == Some(0)
    };
    assert!(keeps("12000") && !keeps("12001"));
    // The second criterion is no name for the first.
    let exact = eeruf(&verify);
    assert_eq!(exact.code, Some(1));
    assert!(
        exact.out.contains("moves by 240 us for sensor 2") && exact.out.contains("it needs at least 301 us"),
        "{}",
        exact.out
    );
}

#[test]
fn tables_of_many_phases_in_files_are_as_separate_as_is_known() {
    let known = std::fs::read_to_string("tests/data/hopping-schedules.json").unwrap();
    let known: Value = serde_json::from_str(&known).unwrap();
    for case in known["cases"].as_array().unwrap() {
        let table = format!("period_us = {}\nt_fire_us = {}\n", case["period_us"], case["t_fire_us"]);
        let (_folder, file) = Scratch::new("schedule.toml", &table);
        let separation = case["separation_us"].to_string();
        let report = json(&[
            "verify",
            file.to_str().unwrap(),
            "--json",
            "--t-delta-us",
            "0",
            "--margin-us",
            &separation,
            "--window-us",
            "36000",
            "--blanking-us",
            "2380",
            "--reach-us",
            "40000",
        ]);
        assert_eq!(report["min_refire_us"], case["gap_us"]);
        assert_eq!(report["min_interval_us"], case["nearest_neighbours_us"]);
        if case["kind"] == "slots" {
            // A path may read the same with two ages.
            assert_eq!((&report["ok"], &report["violations"][0]["kind"]), (&false.into(), &"crosstalk".into()));
            assert!(report["separation_us"].as_u64() <= Some(130));
        } else {
            assert_eq!((&report["ok"], &report["separation_us"]), (&true.into(), &case["separation_us"]));
        }
    }
}

#[test]
fn what_is_wrong_with_a_file_of_many_phases_is_said_in_one_line() {
    let cases = [
        (
            "step_us = 240\nphases = 9\nt_lag_us = [0, 0]\n",
            ", line 3: 9 phases; expected a prime that is no less than the sensors",
        ),
        (
            "step_us = 240\nphases = 11\nt_lag_us = [0, 60000]\n",
            ": a lag of 60 ms for sensor 2; expected at most 57.599 ms",
        ),
        (
            "step_us = 240\nphases = 11\n",
            ", line 2: expected either step_us, phases and t_lag_us, one number for each sensor, or",
        ),
        ("t_fire_us = [[0, 1], [2]]\n", ", line 2: t_fire_us[1] has 1 numbers; expected 2, as many as t_fire_us[0]"),
        ("t_fire_us = [[0, 60000], [2, 3]]\n", ", line 2: t_fire_us[0][1] is 60000; expected less than period_us"),
        ("t_fire_us = [[0, 1]]\n", ", line 2: t_fire_us has 1 phases; expected 2 to 67"),
        ("t_fire_us = [[], []]\n", ": 0 sensors; expected 1 to 64"),
        ("t_fire_us = [[0, 1], [2, 3]]\nstep_us = 9\n", ", line 3: expected either step_us, phases and t_lag_us"),
        ("t_fire_us = [[0, 1], [2, -3]]\n", ", line 2: "),
    ];
    for (keys, expected) in cases {
        let (_folder, file) = Scratch::new("bad.toml", &format!("period_us = 60000\n{keys}"));
        let outcome = eeruf(&["verify", file.to_str().unwrap(), "--window-us", "36000"]);
        assert_eq!((outcome.code, outcome.out.as_str()), (Some(2), ""), "{keys}");
        let prefix = format!("eeruf: {}{expected}", file.display());
        assert!(outcome.err.starts_with(&prefix) && outcome.err.lines().count() == 1, "{}\n{prefix}", outcome.err);
    }
    let (_folder, file) =
        Scratch::new("long.toml", "period_us = 30000000\nstep_us = 240\nphases = 11\nt_lag_us = [0, 20000]\n");
    let outcome = eeruf(&["verify", file.to_str().unwrap(), "--t-delta-us", "150", "--window-us", "16711679"]);
    // It is judged, and not refused.
    assert_eq!(outcome.code, Some(1), "{}", outcome.err);
    let outcome = eeruf(&["verify", file.to_str().unwrap(), "--t-delta-us", "150", "--window-us", "16711680"]);
    let expected = "--window-us: 16711680; expected at most 16711679 for a ring that hops";
    assert!(outcome.code == Some(2) && outcome.err.contains(expected), "{}", outcome.err);
    let text = std::fs::read_to_string("tests/data/hopping-8.toml").unwrap();
    let (_folder, file) = Scratch::new("wide.toml", &text.replace("window_us = 36_000", "window_us = 20_000_000"));
    let outcome = eeruf(&["design", file.to_str().unwrap(), "--phases", "11"]);
    let expected = ": a listening window of 20000 ms; expected at most 16711.679 ms with many phases";
    assert!(outcome.code == Some(2) && outcome.err.contains(expected), "{}", outcome.err);
    let outcome = eeruf(&["verify", "rings/table-i-d.toml", "--margin-us", "90"]);
    assert!(outcome.code == Some(2) && outcome.err.contains("expected a schedule of many phases"), "{}", outcome.err);
}

// Each ring file takes many phases and what comes of it keeps its every need, as verify finds by itself.
#[test]
fn every_ring_file_hops_and_keeps_its_needs() {
    let names = [
        "paper-12",
        "ring-24",
        "round-16",
        "car-12",
        "hc-sr04-8",
        "hc-sr04-8-two-multiplexers",
        "labmate-8",
        "mower-8-and-4",
    ];
    for name in names {
        let ring = format!("rings/{name}.toml");
        let emitted = eeruf(&["design", &ring, "--phases", "4", "--period-only", "--emit", "toml"]);
        assert_eq!(emitted.code, Some(0), "{name}: {}", emitted.err);
        let (_folder, file) = Scratch::new("schedule.toml", &emitted.out);
        let verify = ["verify", file.to_str().unwrap(), "--ring", &ring];
        let outcome = eeruf(&verify);
        assert_eq!(outcome.code, Some(0), "{name}: {}", outcome.out);
        // Asked for a margin that the step does not leave, it is not verified.
        let outcome = eeruf(&[&verify[..], &["--margin-us", "60000"]].concat());
        assert!(
            outcome.code == Some(1) && outcome.out.contains("crosstalk") || outcome.out.contains("sound of sensor")
        );
    }
    // Without the sets that fire together the sensors of a set are crosstalk to each other.
    let emitted = eeruf(&["design", "rings/mower-8-and-4.toml", "--phases", "4", "--emit", "toml"]).out;
    let apart: String =
        emitted.lines().filter(|line| !line.starts_with("together")).map(|line| format!("{line}\n")).collect();
    let (_folder, file) = Scratch::new("apart.toml", &apart);
    let outcome = eeruf(&["verify", file.to_str().unwrap(), "--ring", "rings/mower-8-and-4.toml"]);
    assert!(outcome.code == Some(1) && outcome.out.contains("they must fire together"), "{}", outcome.out);
    let (_folder, file) = Scratch::new("lags.toml", &emitted.replace("[8, 9]", "[7, 9]"));
    let outcome = eeruf(&["verify", file.to_str().unwrap(), "--ring", "rings/mower-8-and-4.toml"]);
    assert!(outcome.code == Some(2) && outcome.err.contains("together: sensor 9 has a lag of"), "{}", outcome.err);
}

// Emitted rust is checked by the compiler and emitted c compiles without a warning.
#[test]
fn emitted_rust_and_c_compile_without_warning() {
    let asked = ["design", "tests/data/hopping-8.toml", "--phases", "11", "--margin-us", "90", "--emit"];
    let rust = eeruf(&[&asked[..], &["rust"]].concat()).out;
    assert_eq!(rust, include_str!("emitted/hopping_8.rs"));
    let mower = ["design", "rings/mower-8-and-4.toml", "--phases", "4", "--emit", "rust"];
    assert_eq!(eeruf(&mower).out, include_str!("emitted/hopping_mower.rs"));
    let c = eeruf(&[&asked[..], &["c"]].concat()).out;
    let (folder, header) = Scratch::new("schedule.h", &c);
    let main = "int main(void) { return eeruf_t_fire_us[EERUF_PHASES - 1][EERUF_SENSORS - 1] >= EERUF_PERIOD_US; }";
    let alone = format!("#include \"{}\"\n{main}\n", header.display());
    compile_and_run(&folder, &alone, C);
    // With the library: the ring is set up, and fires sensor 5 in the second period when the table says.
    let main = "static EerufHoppingRing ring;
        static EerufHopSensor sensors[EERUF_SENSORS];
        static EerufHopper hoppers[EERUF_SENSORS];
        int main(void) {
            EerufEvent event;
            uint32_t at = 0;
            if (eeruf_hopping_init(&ring, sizeof ring, sensors, sizeof sensors, hoppers, sizeof hoppers,
                                   &eeruf_hopping_config, 0) != EERUF_OK)
                return 1;
            for (;;) {
                if (eeruf_hopping_poll(&ring, at, NULL, &event) != EERUF_EVENT) at = eeruf_ring_deadline(&ring.ring);
                else if (event.kind == EERUF_EVENT_FIRE && event.sensor == 5 && at > EERUF_PERIOD_US)
                    return at != EERUF_PERIOD_US + eeruf_t_fire_us[1][5];
            }
        }";
    let with_library = format!("#include <eeruf.h>\n#include \"{}\"\n{main}\n", header.display());
    for language in [C].into_iter().chain(cpp()) {
        compile_and_run(&folder, &with_library, &[language, &["c/eeruf.c"]].concat());
    }
}

// The same in C: the four that look down hear nothing beyond half a metre, and fire two by two when the table says.
#[test]
fn emitted_limits_drive_a_hopping_ring_in_c() {
    let c = eeruf(&["design", "rings/mower-8-and-4.toml", "--phases", "4", "--emit", "c"]).out;
    let (folder, header) = Scratch::new("schedule.h", &c);
    let main = "static EerufHoppingRing ring;
        static EerufHopSensor sensors[EERUF_SENSORS];
        static EerufHopper hoppers[EERUF_SENSORS];
        static uint32_t fired[EERUF_SENSORS], accepted[EERUF_SENSORS];
        int main(void) {
            EerufEvent event;
            EerufHoppingConfig other = eeruf_hopping_config;
            uint32_t at = 0, x, period = 0;
            other.shift_after = 3;
            if (eeruf_hopping_init(&ring, sizeof ring, sensors, sizeof sensors, hoppers, sizeof hoppers, &other, 0) !=
                EERUF_ERR_HOPPING)
                return 1;
            other.shift_after = other.solo_rate = 0;
            if (eeruf_hopping_init(&ring, sizeof ring, sensors, sizeof sensors, hoppers, sizeof hoppers, &other, 0) !=
                EERUF_OK)
                return 2;
            while (period < 100) {
                if (eeruf_hopping_poll(&ring, at, NULL, &event) != EERUF_EVENT) {
                    at = eeruf_ring_deadline(&ring.ring);
                } else if (event.kind == EERUF_EVENT_FIRE) {
                    fired[event.sensor] = at - period * EERUF_PERIOD_US;
                    eeruf_ring_echo(&ring.ring, event.sensor, at + 8000);
                } else if (event.kind == EERUF_EVENT_PERIOD) {
                    for (x = 0; x < EERUF_SENSORS; x++)
                        if (fired[x] != eeruf_t_fire_us[period % EERUF_PHASES][x]) return 3;
                    period++;
                } else if (event.u.reading.kind == EERUF_READING_ACCEPTED) {
                    accepted[event.sensor]++;
                }
            }
            for (x = 0; x < EERUF_SENSORS; x++)
                if ((accepted[x] > 50) != (eeruf_window_us[x] > 8000u)) return 4;
            return 0;
        }";
    let with_library = format!("#include <eeruf.h>\n#include \"{}\"\n{main}\n", header.display());
    for language in [C].into_iter().chain(cpp()) {
        compile_and_run(&folder, &with_library, &[language, &["c/eeruf.c"]].concat());
    }
}

// In C the ring of a file slows down while all is noise, to the emitted lags and period half as long again, and speeds
// up before a wall; it keeps the limits of each sensor.
#[test]
fn emitted_limits_hop_and_adapt_in_c() {
    let c = eeruf(&["design", "rings/mower-8-and-4.toml", "--phases", "4", "--emit", "c"]).out;
    let (folder, header) = Scratch::new("schedule.h", &c);
    let main = "static EerufHoppingRing ring;
        static EerufHopSensor sensors[EERUF_SENSORS];
        static EerufHopper hoppers[EERUF_SENSORS];
        static EerufHoppingConfig fast, slow;
        static const EerufHoppingConfig *const ladder[2] = {&fast, &slow};
        static EerufAdaptation adaptation;
        static uint32_t lag_us[EERUF_SENSORS], accepted[EERUF_SENSORS];
        int main(void) {
            EerufEvent event;
            uint32_t at = 0, x, noise = 0, changes = 0, period = 0;
            fast = eeruf_hopping_config;
            fast.solo_rate = 0;
            slow = fast;
            for (x = 0; x < EERUF_SENSORS; x++) lag_us[x] = fast.lag_us[x] * 3 / 2;
            slow.lag_us = lag_us;
            slow.period_us = EERUF_PERIOD_US * 3 / 2;
            if (eeruf_hopping_init(&ring, sizeof ring, sensors, sizeof sensors, hoppers, sizeof hoppers, &fast, 0) !=
                EERUF_OK)
                return 1;
            if (eeruf_hopping_adaptation_init(&adaptation, sizeof adaptation, ladder, 2) != EERUF_OK) return 2;
            while (period < 400) {
                if (eeruf_hopping_poll(&ring, at, NULL, &event) != EERUF_EVENT) {
                    at = eeruf_ring_deadline(&ring.ring);
                } else if (event.kind == EERUF_EVENT_FIRE) {
                    noise = (noise + 3700) % 9000;
                    eeruf_ring_echo(&ring.ring, event.sensor, at + (period < 40 ? 1000 + noise : 8000));
                } else if (event.kind == EERUF_EVENT_PERIOD) {
                    EerufStatus changed = eeruf_hopping_adaptation_period(&adaptation, &ring, &event);
                    if (changed < 0) return 3;
                    changes += changed == EERUF_EVENT;
                    for (x = 0; x < EERUF_SENSORS; x++)
                        if (eeruf_hopping_lag_us(&ring, (uint8_t)x) != ladder[adaptation.rung]->lag_us[x]) return 4;
                    if (period == 40 && adaptation.rung != 1) return 5;
                    period++;
                } else if (event.u.reading.kind == EERUF_READING_ACCEPTED && period > 40) {
                    if (event.u.reading.t_echo_us != 8000u) return 6;
                    accepted[event.sensor]++;
                }
            }
            if (changes != 2 || adaptation.rung != 0) return 7;
            for (x = 0; x < EERUF_SENSORS; x++)
                if ((accepted[x] > 200) != (eeruf_window_us[x] > 8000u)) return 8;
            return 0;
        }";
    let with_library = format!("#include <eeruf.h>\n#include \"{}\"\n{main}\n", header.display());
    for language in [C].into_iter().chain(cpp()) {
        compile_and_run(&folder, &with_library, &[language, &["c/eeruf.c"]].concat());
    }
}

// A ring that hops on an arduino is set up by what is emitted for it.
#[test]
fn hopping_ring_is_set_up_by_its_emitted_arduino_file() {
    let asked = ["design", "tests/data/hopping-8.toml", "--phases", "11", "--margin-us", "90", "--emit", "arduino"];
    let (folder, tab) = Scratch::new("ring.h", &eeruf(&asked).out);
    // The tab asks for the library by its name; what it takes of it is eeruf.h.
    std::fs::write(folder.path().join("EerufArduino.h"), "#include <eeruf.h>\n").unwrap();
    let main = "static EerufHoppingRing ring;
        static EerufHopSensor sensors[8];
        static EerufHopper hoppers[8];
        int main() {
            return eeruf_hopping_init(&ring, sizeof ring, sensors, sizeof sensors, hoppers, sizeof hoppers, &RING, 0)
                != EERUF_OK || eeruf_hopping_lag_us(&ring, 7) != RING_lag_us[7];
        }";
    let sketch = format!("#include \"{}\"\n{main}\n", tab.display());
    if let Some(language) = cpp() {
        compile_and_run(&folder, &sketch, &[language, &["c/eeruf.c"]].concat());
    }
}

#[test]
fn an_emitted_code_drives_a_hopping_ring() {
    let (settings, listening) = (hopping_8::SETTINGS, hopping_8::LISTENING);
    assert_eq!((settings, listening), (HoppingSettings::BALANCED, HoppingListening::new(Micros::from_millis(36))));
    let mut ring = HoppingRing::<8>::hopping(&hopping_8::RING, settings, listening, 1, Instant::default()).unwrap();
    let mut accepted = 0;
    for _ in 0..500 {
        let now = ring.next_deadline();
        while let Some(event) = ring.poll(now) {
            match event {
                RingEvent::Fire { sensor, .. } => ring.echo(sensor, now + Micros::from_millis(12)).unwrap(),
                RingEvent::Reading(reading) => accepted += u32::from(reading.kind == eeruf_core::ReadingKind::Accepted),
                RingEvent::PeriodEnded(_) => {}
            }
        }
    }
    assert!(accepted > 100, "{accepted}");
}

// A ring whose sensors are not all alike is set up by what is emitted for it, and keeps their limits.
#[test]
fn emitted_limits_drive_a_hopping_ring() {
    let ((schedule, limits), listening) = (&hopping_mower::RING, hopping_mower::LISTENING);
    let start = Instant::default();
    let ring = HoppingRing::<12, 4, 1, _>::with_limits(schedule, *limits, hopping_mower::SETTINGS, listening, 1, start);
    let mut ring = ring.unwrap();
    let (mut accepted, mut fired) = ([0; 12], [[0_u32; 12]; 2]);
    while ring.next_deadline().as_micros() < 20_000_000 {
        let now = ring.next_deadline();
        while let Some(event) = ring.poll(now) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    fired[1][usize::from(sensor)] = now.as_micros();
                    // A wall 1.4 m away, which the four that look down are not meant to see.
                    ring.echo(sensor, now + Micros::from_millis(8)).unwrap();
                }
                RingEvent::Reading(reading) => {
                    accepted[usize::from(reading.sensor)] +=
                        u32::from(reading.kind == eeruf_core::ReadingKind::Accepted);
                }
                RingEvent::PeriodEnded(_) => {
                    if ring.plan().solo().is_none() && fired[1][8] > fired[0][8] && fired[1][9] > fired[0][9] {
                        assert_eq!((fired[1][8], fired[1][10]), (fired[1][9], fired[1][11]));
                    }
                    fired[0] = fired[1];
                }
            }
        }
    }
    assert!(accepted[..8].iter().all(|&often| often > 100) && accepted[8..] == [0; 4], "{accepted:?}");
    // New lags would not keep them.
    let draws = hopping_mower::SETTINGS.with_shift_after(3);
    let refused = HoppingRing::<12, 4, 1, _>::with_limits(schedule, *limits, draws, listening, 1, start).unwrap_err();
    assert!(refused.to_string().starts_with("shift_after 3; expected 0"), "{refused}");
}

// A picture of many phases has a line for each sensor and phase.
#[test]
fn picture_has_a_line_for_each_sensor_and_phase() {
    let (folder, file) = ring(12_000);
    let picture = folder.path().join("timing.svg");
    let outcome = eeruf(&["design", &file, "--phases", "11", "--svg", picture.to_str().unwrap()]);
    assert_eq!(outcome.code, Some(0), "{}", outcome.err);
    let svg = std::fs::read_to_string(picture).unwrap();
    assert_eq!(svg.matches("#D1495B").count(), 8 * 11);
    assert!(svg.contains("8 sensors, 11 phases, T_p = "));
}
