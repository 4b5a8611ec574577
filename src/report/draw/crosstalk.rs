//! Two periods, or rounds, as they happened: who fired when, who heard what, and whose sound it was (Fig. 3).

use eeruf_sim::{Cause, Method, Readings};
use plotters::style::Color;
use plotters::style::text_anchor::HPos;

use super::picture::Picture;
use super::style::{ACCEPTED, CAPTION, INK, LISTENING, REJECTED, SMALL, TITLE, grid_step, sensor_colour, tick_label};

const LEFT: f64 = 48.0;
const WIDTH: f64 = 900.0;
const RIGHT: f64 = 24.0;
const TOP: f64 = 104.0;
const LANE: f64 = 38.0;

/// One lane for each of a robot's sensors; `readings` are that robot's, `window_s` is how long its sensors listen.
pub(crate) fn two_periods(readings: &Readings, robot: u16, sensors: usize, window_s: f64) -> Picture {
    let first = richest_period(readings);
    let shown: Vec<usize> = (0..readings.len()).filter(|&k| (first..first + 2).contains(&readings.period[k])).collect();
    let fired = |period: u32| {
        let fired = shown.iter().filter(|&&k| readings.period[k] >= period).map(|&k| readings.fired_s[k]);
        fired.fold(f64::INFINITY, f64::min)
    };
    let start = fired(first);
    let start = if start.is_finite() { start } else { 0.0 };
    let length = shown.iter().map(|&k| readings.fired_s[k] + window_s - start).fold(window_s, f64::max) * 1.01;
    let x_of = |s: f64| LEFT + (s - start) / length * (WIDTH - LEFT - RIGHT);
    let lane = |sensor: usize| TOP + LANE * (sensor as f64 + 0.5);
    let bottom = TOP + LANE * sensors as f64;
    let mut picture = Picture::new(WIDTH, bottom + 48.0);
    // Flow has no period: the simulator counts its rounds, in which each sensor fires once.
    let turn = if readings.method == Method::Flow { "round" } else { "period" };
    picture.text(format!("{}: two {turn}s as they happened", readings.method), (16.0, 20.0), TITLE);
    legend(&mut picture);
    let step = grid_step(1000.0 * length, 12.0);
    for tick in 0..=(1000.0 * length / step) as u32 {
        let ms = f64::from(tick) * step;
        let x = x_of(start + 0.001 * ms);
        picture.line((x, TOP), (x, bottom + 4.0), 1.0, INK.mix(0.12));
        picture.text_in(tick_label(ms, step), (x, bottom + 14.0), SMALL, HPos::Center, INK);
    }
    picture.text_in("time, ms", (WIDTH - RIGHT, bottom + 32.0), SMALL, HPos::Right, INK);
    for (period, name) in [(first, &*format!("one {turn}")), (first + 1, "the next")] {
        let x = x_of(fired(period));
        if x.is_finite() {
            picture.dashes((x, TOP - 18.0), (x, bottom), 1.0, INK.mix(0.6));
            picture.text(name, (x + 6.0, TOP - 14.0), CAPTION);
        }
    }
    picture.text_in("sensor", (LEFT - 4.0, TOP - 14.0), SMALL, HPos::Right, INK);
    for sensor in 0..sensors {
        picture.text_in((sensor + 1).to_string(), (LEFT - 14.0, lane(sensor)), CAPTION, HPos::Right, INK);
    }
    for &k in &shown {
        let (y, fire) = (lane(usize::from(readings.sensor[k])), readings.fired_s[k]);
        picture.rect([(x_of(fire), y - 9.0), (x_of(fire + window_s), y + 9.0)], LISTENING.mix(0.55));
    }
    // Ways of foreign sound from the lane of its emitter.
    for &k in &shown {
        let (y, at) = (lane(usize::from(readings.sensor[k])), readings.fired_s[k] + 1e-6 * readings.t_echo_us[k]);
        let emitter = readings.path_of(k).map(|path| path.emitter).filter(|emitter| emitter.robot == robot);
        if let (Cause::Crosstalk, Some(emitter)) = (readings.cause[k], emitter) {
            let colour = sensor_colour(usize::from(emitter.sensor));
            let (from, to) = ((x_of(readings.emitted_s[k]), lane(usize::from(emitter.sensor))), (x_of(at), y));
            if from.0 >= LEFT {
                picture.line(from, to, 1.5, colour.mix(0.8));
                picture.arrow_head(from, to, 11.0, colour);
            }
        }
    }
    for &k in &shown {
        let sensor = usize::from(readings.sensor[k]);
        let (y, fire) = (lane(sensor), readings.fired_s[k]);
        let x = x_of(fire);
        picture.rect([(x - 2.0, y - 14.0), (x + 2.0, y + 14.0)], sensor_colour(sensor));
        if readings.t_echo_us[k].is_nan() {
            continue;
        }
        let at = (x_of(fire + 1e-6 * readings.t_echo_us[k]), y);
        let foreign = matches!(readings.cause[k], Cause::Crosstalk | Cause::Stale | Cause::External);
        let colour = if foreign { REJECTED } else { ACCEPTED };
        if readings.is_accepted(k) {
            picture.dot(at, 5.0, colour);
        } else if readings.kind[k].is_rejected() {
            picture.cross(at, 5.0, colour);
        } else {
            picture.dot(at, 3.0, colour);
        }
        picture.text(format!("{:.1}", 1e-3 * readings.t_echo_us[k]), (at.0 + 10.0, y), SMALL);
    }
    picture
}

/// The first even period, after the ring has settled, that together with the next one has the most foreign sound, if
/// possible none of it believed.
fn richest_period(readings: &Readings) -> u32 {
    const FROM: u32 = 4;
    const TO: u32 = 204;
    let mut scores = [0_i32; (TO - FROM) as usize];
    for k in (0..readings.len()).filter(|&k| readings.cause[k] == Cause::Crosstalk) {
        let pair = readings.period[k].checked_sub(FROM).map(|since| (since - since % 2) as usize);
        if let Some(score) = pair.and_then(|pair| scores.get_mut(pair)) {
            *score += if readings.is_accepted(k) { -3 } else { 1 };
        }
    }
    let most = scores.iter().step_by(2).copied().max().unwrap_or(0);
    FROM + 2 * scores.iter().step_by(2).position(|&score| score == most).unwrap_or(0) as u32
}

fn legend(picture: &mut Picture) {
    let (mut x, y) = (20.0, 52.0);
    let mut entry = |width: f64, text: &str, mark: &dyn Fn(&mut Picture, f64)| {
        mark(picture, x);
        picture.text(text, (x + 16.0, y), CAPTION);
        x += width;
    };
    entry(62.0, "fires", &|picture, x| picture.rect([(x, y - 9.0), (x + 4.0, y + 9.0)], INK));
    entry(74.0, "listens", &|picture, x| picture.rect([(x - 4.0, y - 8.0), (x + 12.0, y + 8.0)], LISTENING.mix(0.55)));
    entry(180.0, "own echo, accepted", &|picture, x| picture.dot((x + 5.0, y), 5.0, ACCEPTED));
    entry(100.0, "rejected", &|picture, x| picture.cross((x + 5.0, y), 5.0, ACCEPTED));
    entry(172.0, "crosstalk, rejected", &|picture, x| picture.cross((x + 5.0, y), 5.0, REJECTED));
    entry(104.0, "accepted", &|picture, x| picture.dot((x + 5.0, y), 5.0, REJECTED));
    entry(150.0, "numbers: reading, ms", &|_, _| {});
}
