//! A survey's firings and rows, also after a long time without polls.

extern crate std;
use super::*;
use std::collections::BTreeMap;
use std::vec::Vec;

fn firings(plan: SurveyPlan, slot: u32) -> Vec<(u8, Micros)> {
    plan.firings(slot).collect()
}

/// One line of a survey's log.
#[derive(Debug)]
struct Row {
    sensor: u8,
    fired: Instant,
    slot: u32,
    t_echo: Option<Micros>,
}

// Every sensor fires alone and every ordered pair with every lead.
#[test]
fn every_sensor_and_pair_fires_with_every_lead() {
    let plan = SurveyPlan::new(5).with_solos(2).with_leads(3, Micros::new(400));
    let mut seen = BTreeMap::new();
    for slot in 0..plan.slots() {
        *seen.entry(firings(plan, slot)).or_insert(0) += 1;
    }
    for x in 0..5 {
        assert_eq!(seen.remove(&std::vec![(x, Micros::ZERO)]), Some(2));
        for y in (0..5).filter(|&y| y != x) {
            for lead in [0, 400, 800] {
                assert_eq!(
                    seen.remove(&std::vec![(x, Micros::ZERO), (y, Micros::new(lead))]),
                    Some(1),
                    "{x} {y} {lead}"
                );
            }
        }
    }
    assert_eq!((seen.len(), plan.slots(), firings(plan, plan.slots()).len()), (0, 5 * 2 + 20 * 3, 0));
    assert_eq!(plan.duration_us(), 70 * (800 + 36_000 + 57_000));
    // The first pair follows the solos, however many there are.
    let once = SurveyPlan::new(5).with_solos(1);
    assert_eq!(firings(once, 5), [(0, Micros::ZERO), (1, Micros::ZERO)]);
    assert_eq!(firings(SurveyPlan::new(0), 0), []);
    assert_eq!(SurveyPlan::new(1).slots(), 3);
}

/// Runs a survey over the wrap of the clock, polled at its deadlines or later; each sensor hears an edge `1000 +
/// sensor` after it fires and another later.
fn run(plan: SurveyPlan, late: impl Fn(usize) -> u32) -> (Vec<(u32, u8)>, Vec<Row>) {
    let mut survey = Survey::new(plan, Instant::from_micros(u32::MAX - 50_000));
    let (mut fired, mut rows) = (Vec::new(), Vec::new());
    while let Some(due) = survey.next_deadline() {
        let now = due + Micros::new(late(fired.len()));
        while let Some(event) = survey.poll(now) {
            match event {
                SurveyEvent::Fire { sensor } => {
                    fired.push((now.as_micros(), sensor));
                    survey.echo(sensor, now + Micros::new(1000 + u32::from(sensor)));
                    survey.echo(sensor, now + Micros::new(5000));
                    survey.echo(sensor + 1, now);
                }
                SurveyEvent::Row { sensor, fired, slot, t_echo } => rows.push(Row { sensor, fired, slot, t_echo }),
            }
        }
    }
    assert!(survey.is_over());
    assert_eq!(survey.poll(Instant::from_micros(0)), None);
    (fired, rows)
}

// A survey fires as planned and logs each firing once with its first edge.
#[test]
fn survey_logs_each_firing_once_with_its_first_edge() {
    let plan = SurveyPlan::new(3).with_leads(2, Micros::new(500)).with_solos(1);
    let (fired, rows) = run(plan, |_| 0);
    assert_eq!((fired.len(), rows.len()), (3 + 12 * 2, 3 + 12 * 2));
    for row in &rows {
        assert!(fired.contains(&(row.fired.as_micros(), row.sensor)));
        let begins = plan.slot_length().as_micros() * row.slot;
        let lead = plan.firings(row.slot).find(|firing| firing.0 == row.sensor).unwrap().1.as_micros();
        assert_eq!(row.fired.as_micros(), (u32::MAX - 50_000).wrapping_add(begins + lead), "{row:?}");
        assert_eq!(row.t_echo, Some(Micros::new(1000 + u32::from(row.sensor))));
    }
}

#[test]
fn late_firing_delays_all_that_follow() {
    let plan = SurveyPlan::new(2).with_leads(2, Micros::new(500)).with_solos(1);
    let (on_time, _) = run(plan, |_| 0);
    let (late, rows) = run(plan, |fired| if fired == 3 { 7000 } else { 0 });
    assert_eq!(rows.len(), on_time.len());
    let between =
        |fired: &[(u32, u8)]| -> Vec<_> { fired.windows(2).map(|pair| pair[1].0.wrapping_sub(pair[0].0)).collect() };
    for (late, on_time) in between(&late).into_iter().zip(between(&on_time)) {
        assert!(late >= on_time, "{late} {on_time}");
    }
}

// A plan reports its settings, capped at ten seconds.
#[test]
fn plan_keeps_its_settings_up_to_ten_seconds() {
    let plan = SurveyPlan::new(3).with_solos(1).with_leads(2, Micros::new(500));
    let plan = plan.with_window(Micros::from_millis(30), Micros::from_millis(5));
    assert_eq!((plan.sensors(), plan.window(), plan.slot_length()), (3, Micros::from_millis(30), Micros::new(35_500)));
    // All sensors fire alone, then all pairs, sensor by sensor, then all pairs with the next lead.
    let pairs = [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)];
    for (number, (first, second)) in (3..).zip(pairs.into_iter().cycle()).take(12) {
        let lead = if number < 9 { Micros::ZERO } else { Micros::new(500) };
        assert_eq!(firings(plan, number), [(first, Micros::ZERO), (second, lead)], "{number}");
    }
    let [most, more] = [10_000_000, 10_000_001].map(Micros::new);
    for time in [more, Micros::MAX] {
        let plan = SurveyPlan::new(1).with_leads(2, time).with_window(time, Micros::ZERO);
        assert_eq!((plan.window(), plan.slot_length()), (most, Micros::new(20_000_000)));
    }
}

#[test]
fn survey_begins_no_slot_early_however_often_polled() {
    let plan = SurveyPlan::new(2).with_leads(2, Micros::new(400)).with_solos(1);
    let plan = plan.with_window(Micros::from_millis(3), Micros::ZERO);
    let mut survey = Survey::new(plan, Instant::from_micros(0));
    let (mut fired, mut rows) = (Vec::new(), 0);
    for now in (0..60_000).step_by(100).map(Instant::from_micros) {
        // One event a poll: the end of a slot comes before its second row is fetched.
        match survey.poll(now) {
            Some(SurveyEvent::Fire { sensor }) => fired.push((now.as_micros(), sensor)),
            Some(SurveyEvent::Row { .. }) => rows += 1,
            None => {}
        }
    }
    assert!(survey.is_over());
    let planned: usize = (0..plan.slots()).map(|slot| plan.firings(slot).count()).sum();
    assert_eq!((fired.len(), rows), (planned, planned));
    let begins: Vec<_> = fired.windows(2).map(|pair| pair[1].0 - pair[0].0).collect();
    assert!(begins[0] == 3_400 && begins.iter().all(|&apart| apart <= 400 || apart >= 3_000), "{begins:?}");
}

#[test]
fn an_edge_after_the_window_is_no_echo() {
    let plan = SurveyPlan::new(1).with_window(Micros::new(1000), Micros::new(1000));
    let (_, rows) = run(plan, |_| 0);
    assert_eq!(rows.len(), 3);
    assert!(rows.iter().all(|row| row.t_echo.is_none()), "{rows:?}");
}

#[test]
fn a_survey_asks_to_be_polled_when_the_first_window_ends() {
    let plan = SurveyPlan::new(2).with_leads(2, Micros::new(500)).with_solos(1);
    let mut survey = Survey::new(plan, Instant::from_micros(0));
    let mut rows = 0;
    while let Some(now) = survey.next_deadline() {
        while let Some(event) = survey.poll(now) {
            if let SurveyEvent::Row { fired, .. } = event {
                assert_eq!(now, fired + plan.window, "{event:?}");
                rows += 1;
            }
        }
    }
    assert_eq!(rows, 2 + 2 * 2 * 2);
}

#[test]
fn a_survey_left_alone_for_any_time_goes_on_when_polled() {
    let plan = SurveyPlan::new(2).with_leads(2, Micros::new(500)).with_solos(1);
    let planned = run(plan, |_| 0);
    for minutes in [1, 34, 36, 40, 70] {
        // Before each of its sleeps except the one before its first firing.
        for before in 1..3 * planned.1.len() {
            let (mut survey, mut now) = (Survey::new(plan, Instant::from_micros(0)), Instant::from_micros(0));
            let (mut fired, mut rows, mut sleeps) = (Vec::new(), Vec::new(), 0);
            while let Some(due) = survey.next_deadline() {
                assert!(due.since(now) <= plan.slot_length(), "{minutes} min, {before}: until {due:?} at {now:?}");
                now = due;
                if sleeps == before {
                    now += Micros::from_millis(minutes * 60_000);
                }
                sleeps += 1;
                while let Some(event) = survey.poll(now) {
                    match event {
                        SurveyEvent::Fire { sensor } => {
                            fired.push(sensor);
                            survey.echo(sensor, now + Micros::new(1000 + u32::from(sensor)));
                        }
                        SurveyEvent::Row { sensor, t_echo, .. } => rows.push((sensor, t_echo)),
                    }
                }
            }
            assert!(fired.iter().eq(planned.0.iter().map(|(_, sensor)| sensor)), "{minutes} min, {before}: {fired:?}");
            assert_eq!(rows.len(), planned.1.len(), "{minutes} min, {before}");
            assert!(rows.iter().all(|&(sensor, t_echo)| t_echo == Some(Micros::new(1000 + u32::from(sensor)))));
        }
    }
}

#[test]
fn a_survey_that_has_not_begun_waits_for_its_beginning() {
    for ahead in [1, 1_000_000, 600_000_000] {
        let mut survey = Survey::new(SurveyPlan::new(2), Instant::from_micros(ahead));
        assert_eq!(survey.poll(Instant::from_micros(0)), None, "{ahead}");
        assert_eq!(survey.next_deadline(), Some(Instant::from_micros(ahead)));
    }
}
