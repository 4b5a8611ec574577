//! Settings in the wrong unit, which are refused, and a blanking time shorter than at the start.

use eeruf_core::{
    Instant, Micros, ReadingKind, Ring, RingConfig, RingEvent,
    flow::{Belief, BeliefSettings, FlowRing, InTurn, TurnSettings},
    tables::PAPER_12,
};

const WINDOW: Micros = Micros::from_millis(25);

fn flow(
    turns: impl FnOnce(&mut TurnSettings),
    belief: impl FnOnce(&mut BeliefSettings),
    window: Micros,
) -> Result<FlowRing<8>, String> {
    let (mut t, mut b) = (TurnSettings::new(1), BeliefSettings::DEFAULT);
    turns(&mut t);
    belief(&mut b);
    let config = RingConfig::new().with_window(window);
    FlowRing::flow(8, t, b, config, Instant::default()).map_err(|error| error.to_string())
}

#[test]
fn settings_in_the_wrong_unit_are_refused_with_the_likely_cause() {
    assert!(flow(|_| (), |_| (), WINDOW).is_ok());
    let turns = |change: fn(&mut TurnSettings)| flow(change, |_| (), WINDOW).unwrap_err();
    let belief = |change: fn(&mut BeliefSettings)| flow(|_| (), change, WINDOW).unwrap_err();
    let ms = |named| format!("{named}, likely given in milliseconds");
    assert_eq!(turns(|of| of.rest = Micros::new(60)), ms("rest is 60; expected 1000 to 4000000"));
    assert_eq!(turns(|of| of.most = Micros::new(33)), ms("most is 33; expected 1000 to 250000"));
    assert_eq!(turns(|of| of.least = Micros::new(6)), ms("least is 6; expected 100 to 33500"));
    assert_eq!(turns(|of| of.dice = Micros::new(2)), ms("dice is 2; expected 8 to 250000"));
    let ns = "rest is 60000000; expected 1000 to 4000000, likely given in nanoseconds";
    assert_eq!(turns(|of| of.rest = Micros::new(60_000_000)), ns);
    assert_eq!(turns(|of| of.seed = 0), "seed is 0; expected 1 to 4294967295");
    let ns = |name: &str| format!("{name} is 80000; expected 0 to 10000, likely given in nanoseconds");
    assert_eq!(belief(|of| of.t_delta = Micros::new(80_000)), ns("t_delta"));
    assert_eq!(belief(|of| of.near = Micros::new(80_000)), ns("near"));
    assert_eq!(belief(|of| of.path_change = Micros::new(80_000)), ns("path_change"));
    let m_s = "top_speed_mm_s is 2; expected 10 to 65535, likely given in m/s";
    assert_eq!(belief(|of| of.top_speed_mm_s = 2), m_s);
    assert_eq!(belief(|of| of.hold = 0), "hold is 0; expected 1 to 100");
    let window = flow(|_| (), |_| (), Micros::new(25)).unwrap_err();
    assert_eq!(window, ms("window is 25; expected 1000 to 4000000"));
    // By a table, too.
    let table = |config: RingConfig| Ring::new(&PAPER_12, config, Instant::default()).unwrap_err().to_string();
    assert_eq!(
        table(RingConfig::new().with_audible(Micros::new(60))),
        ms("audible is 60; expected 1000 to 4294967295")
    );
}

/// With a blanking time shorter than at the start, a sensor that rests no longer than its window hears its
/// second-to-last firing later than R minus its rest; all such sound must count as foreign.
#[test]
fn a_shorter_blanking_time_lets_no_stale_echo_in() {
    let (rest, begun) = (Micros::from_millis(25), Micros::from_millis(9));
    let (mut heard, mut ambiguous) = (0, 0);
    for seed in 1..300 {
        let turns = TurnSettings::for_module(seed, WINDOW, rest, begun);
        let belief = BeliefSettings::DEFAULT;
        let config = RingConfig::new().with_window(WINDOW).with_blanking(begun);
        let config = config.with_audible(turns.most).with_path_change(belief.path_change);
        let mut now = Instant::from_micros(seed << 20);
        // Held at the least quiet, or it would grow until nothing stale is heard.
        let turns = TurnSettings { most: turns.least, dice: Micros::new(100), ..turns };
        let plan = InTurn::<1>::new(1, turns, WINDOW, now).unwrap();
        let mut ring: FlowRing<1> = Ring::judged_by(plan, Belief::new(belief).unwrap(), config, now).unwrap();
        ring.set_blanking(Micros::new(300)).unwrap();
        // Its own sound comes back once, by a path longer than the window.
        let path = Micros::new(25_800 + seed * 15);
        let mut edges: Vec<(Instant, u8)> = vec![];
        while now.since(Instant::from_micros(seed << 20)) < Micros::from_millis(3_000) {
            now = ring.next_deadline();
            edges.sort_unstable_by_key(|edge| now.since(edge.0).as_micros() as i32);
            if let Some((at, sensor)) = edges.pop_if(|edge| now.has_reached(edge.0)) {
                now = at;
                ring.echo(sensor, at).unwrap();
            }
            while let Some(event) = ring.poll(now) {
                match event {
                    RingEvent::Fire { sensor: 0, .. } => edges.push((now + path, 0)),
                    RingEvent::Reading(reading) if reading.sensor == 0 && reading.t_echo.is_some() => {
                        heard += 1;
                        ambiguous += u32::from(reading.kind == ReadingKind::Ambiguous);
                        assert_ne!(reading.kind, ReadingKind::Accepted, "seed {seed}: {reading:?}");
                    }
                    _ => {}
                }
            }
        }
    }
    println!("{heard} stale echoes, {ambiguous} ambiguous");
    assert!(ambiguous > 100, "{heard} {ambiguous}");
}
