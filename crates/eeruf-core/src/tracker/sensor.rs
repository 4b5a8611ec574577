//! [`SensorTracks`]: the tracks of one sensor, and what a reading does to them.

use super::settings::TrackerSettings;
use super::track::Track;
use crate::filter::NO_ECHO;
use crate::reading::{ReadingKind, Verdict};
use crate::time::Micros;

/// The age of a sensor none of whose readings was ever accepted.
const NEVER: u16 = u16::MAX;

/// What one firing of a sensor was like, for those who know more than the echo time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Heard {
    pub(super) t_echo: u32,
    pub(super) phase: u8,
    pub(super) solo: bool,
    pub(super) steady: bool,
    /// How many close votes a tentative echo needs; 0: none is reported.
    pub(super) tentative_votes: u8,
}

/// The hypotheses about one sensor.
#[derive(Clone, Copy, Debug)]
pub(super) struct SensorTracks<const H: usize> {
    tracks: [Track; H],
    /// Firings since the last accepted reading.
    age: u16,
    /// How often readings were of nothing known, in 1/255, of about the last 16.
    unexplained: u8,
}

impl<const H: usize> SensorTracks<H> {
    pub(super) const NEW: Self = Self { tracks: [Track::NONE; H], age: NEVER, unexplained: 0 };

    pub(super) fn forget(&mut self) {
        self.tracks = [Track::NONE; H];
    }

    pub(super) fn firing_changed(&mut self) {
        for track in &mut self.tracks {
            track.firing_changed();
        }
    }

    pub(super) const fn unexplained(&self) -> u8 {
        self.unexplained
    }

    /// All values move with the robot.
    pub(super) fn shift(&mut self, change_us: i32) {
        for track in &mut self.tracks {
            track.shift(change_us);
        }
    }

    /// Takes in a reading; also whether it may become a tentative one.
    pub(super) fn push(&mut self, heard: Heard, settings: &TrackerSettings) -> (Verdict, bool) {
        let Heard { t_echo, phase, solo, steady, tentative_votes } = heard;
        let believed = self.earliest_confirmed();
        let nearest = self.nearest(t_echo, settings.t_delta.as_micros());
        let near = settings.near.as_micros();
        let is_near = believed.is_some_and(|believed| is_within(believed, t_echo, near));
        let mut previous = believed;
        if let Some(Some(track)) = nearest.map(|place| self.tracks.get(place)) {
            previous = Some(track.t_echo);
        }
        let mut candidate = false;
        let mut tentative = false;
        if steady {
            for (place, track) in self.tracks.iter_mut().enumerate().filter(|(_, track)| track.exists()) {
                if nearest == Some(place) {
                    track.support(t_echo, phase, solo, settings);
                    let votes = track.close_votes();
                    let earlier = believed.is_none_or(|believed| track.t_echo < believed) && !track.is_silence();
                    candidate = earlier && !track.is_confirmed() && votes >= 2;
                    tentative = earlier && tentative_votes != 0 && (solo || votes >= tentative_votes);
                } else if is_near && believed == Some(track.t_echo) {
                    track.grow_older();
                    track.follow(t_echo);
                } else if t_echo > track.t_echo {
                    track.contradict(phase, solo, settings);
                } else {
                    track.mask(phase);
                }
            }
            if nearest.is_none() && !is_near {
                self.begin(t_echo, phase, solo);
                tentative = solo && tentative_votes != 0 && t_echo != NO_ECHO;
            }
            self.explain(nearest.is_some() || is_near);
        }
        let believed = self.earliest_confirmed();
        let confirmed = believed.is_some_and(|believed| is_within(believed, t_echo, near));
        let kind = match (confirmed, t_echo == NO_ECHO) {
            (true, true) => ReadingKind::Clear,
            (true, false) => ReadingKind::Accepted,
            (false, true) => ReadingKind::NoEcho,
            (false, false) if tentative => ReadingKind::Tentative,
            (false, false) if previous.is_none() => ReadingKind::First,
            (false, false) => ReadingKind::Rejected,
        };
        let previous = previous.filter(|&previous| previous != NO_ECHO).map(Micros::new);
        (self.verdict(kind, t_echo, previous), candidate)
    }

    /// A firing that says nothing about the echo time.
    pub(super) fn skip(&mut self, kind: ReadingKind, t_echo: Option<Micros>) -> Verdict {
        self.verdict(kind, t_echo.map_or(NO_ECHO, Micros::as_micros), None)
    }

    /// Whether nothing in range is confirmed.
    pub(super) fn is_clear(&self) -> bool {
        self.earliest_confirmed() == Some(NO_ECHO)
    }

    /// The echo time that counts now; [`NO_ECHO`] if nothing in range is confirmed.
    pub(super) fn earliest_confirmed(&self) -> Option<u32> {
        self.tracks.iter().filter(|track| track.exists() && track.is_confirmed()).map(|track| track.t_echo).min()
    }

    fn nearest(&self, t_echo: u32, t_delta: u32) -> Option<usize> {
        let near = |(place, track): (usize, &Track)| {
            let within = track.exists() && is_within(track.t_echo, t_echo, t_delta);
            within.then(|| (place, track.distance(t_echo)))
        };
        self.tracks.iter().enumerate().filter_map(near).min_by_key(|&(_, distance)| distance).map(|(place, _)| place)
    }

    fn begin(&mut self, t_echo: u32, phase: u8, solo: bool) {
        if let Some(weakest) = self.tracks.iter_mut().min_by_key(|track| track.rank()) {
            *weakest = Track::new(t_echo, phase, solo);
        }
    }

    fn explain(&mut self, explained: bool) {
        let target: i16 = if explained { 0 } else { 255 };
        let held = i16::from(self.unexplained);
        // Between 0 and 255.
        self.unexplained = (held + (target - held) / 16) as u8;
    }

    fn verdict(&mut self, kind: ReadingKind, t_echo: u32, previous: Option<Micros>) -> Verdict {
        self.age = match kind {
            ReadingKind::Accepted | ReadingKind::Tentative => 0,
            _ if self.age >= NEVER - 1 => self.age,
            _ => self.age + 1,
        };
        let t_echo = (t_echo != NO_ECHO).then_some(Micros::new(t_echo));
        Verdict { kind, t_echo, previous, age: (self.age != NEVER).then_some(self.age) }
    }
}

/// Whether two readings are this close, where silence is close to silence alone.
const fn is_within(one: u32, other: u32, most: u32) -> bool {
    if one == NO_ECHO || other == NO_ECHO { one == other } else { one.abs_diff(other) <= most }
}
