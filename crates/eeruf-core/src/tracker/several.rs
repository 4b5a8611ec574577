//! Firings of a sensor that reports several echoes: all of them are weighed, by the rules of a single one.
//!
//! An echo supports the track that it is nearest to, if no other echo is nearer to that. A track without support is
//! contradicted if its echo would have been reported: a later one was, or there was room for more. So another sensor's
//! sound does not hide what comes after it, silence included.

use super::sensor::{NOTHING, SensorTracks, duration, kind_of};
use super::settings::TrackerSettings;
use super::track::{LATEST, SILENCE, Track, bit};
use crate::judging::Firing;
use crate::reading::Verdict;
use crate::schedule::Phase;
use crate::time::Micros;

/// An echo, or the silence after the last one.
#[derive(Clone, Copy)]
struct Sound {
    t_echo: u32,
    /// The place of the track that it is nearest to within `t_delta`, or `H`.
    track: usize,
    /// The time of that; without it what was confirmed.
    previous: u32,
    is_tentative: bool,
}

/// The sounds of a firing, earliest first.
struct Sounds<const E: usize> {
    sounds: [Sound; E],
    count: usize,
}

impl<const E: usize> Sounds<E> {
    const SILENT: Sound = Sound { t_echo: SILENCE, track: usize::MAX, previous: NOTHING, is_tentative: false };

    /// With room for more echoes there was silence after them.
    fn new(echoes: &[Micros]) -> Self {
        let mut sounds = [Self::SILENT; E];
        for (sound, echo) in sounds.iter_mut().zip(echoes) {
            sound.t_echo = echo.as_micros().min(LATEST);
        }
        Self { sounds, count: (echoes.len() + 1).min(E) }
    }

    fn all(&self) -> impl Iterator<Item = &Sound> {
        self.sounds.iter().take(self.count)
    }

    fn all_mut(&mut self) -> impl Iterator<Item = &mut Sound> {
        self.sounds.iter_mut().take(self.count)
    }

    fn first(&self) -> Sound {
        self.sounds.first().copied().unwrap_or(Self::SILENT)
    }

    fn nearest(&self, t_echo: u32) -> Sound {
        self.all().min_by_key(|sound| sound.t_echo.abs_diff(t_echo)).copied().unwrap_or(Self::SILENT)
    }

    /// Returns true if an echo at this time would have been reported: a later sound was, and it was not so soon after
    /// another that both are one.
    fn would_show(&self, t_echo: u32, near: u32) -> bool {
        let hides = |sound: &Sound| E > 1 && sound.t_echo <= t_echo && t_echo - sound.t_echo <= near;
        self.all().any(|sound| sound.t_echo > t_echo) && !self.all().any(hides)
    }
}

impl<const H: usize> SensorTracks<H> {
    /// Takes in a firing with its echoes, earliest first, of a sensor that reports up to `E`. Each supports a track
    /// within `t_delta`.
    pub(super) fn push_several<const E: usize>(
        &mut self,
        echoes: &[Micros],
        firing: Firing,
        t_delta: Micros,
        settings: &TrackerSettings,
    ) -> Verdict {
        let Firing { phase: Phase(phase), solo, steady, expected_change_us: change_us } = firing;
        let (phase, near) = (bit(phase), settings.near.as_micros());
        let mut sounds = Sounds::<E>::new(echoes);
        // Of the first, since what comes nearer matters more than the wall behind it, which may change otherwise.
        self.learn(sounds.first().t_echo, change_us, t_delta);
        self.shift(change_us);
        let before = self.confirmed();
        for sound in sounds.all_mut() {
            (_, sound.track) = self.confirmed_and_nearest(sound.t_echo, t_delta.as_micros());
            sound.previous = self.tracks.get(sound.track).map_or(before, Track::t_echo);
        }
        if steady {
            self.weigh(&mut sounds, phase, solo, change_us != 0, before, settings);
        }
        let confirmed = self.confirmed();
        let best = Some(sounds.nearest(confirmed)).filter(|sound| confirmed.abs_diff(sound.t_echo) <= near);
        let tentative = sounds.all().find(|sound| sound.is_tentative).copied();
        let tentative = tentative.filter(|sound| best.is_none_or(|best| sound.t_echo < best.t_echo));
        let heard = tentative.or(best).unwrap_or_else(|| sounds.first());
        let kind = kind_of(heard.t_echo, best.is_some() && tentative.is_none(), tentative.is_some(), heard.previous);
        self.verdict(kind, duration(heard.t_echo), duration(heard.previous))
    }

    /// Supports and contradicts tracks, and begins those that are missing.
    fn weigh<const E: usize>(
        &mut self,
        sounds: &mut Sounds<E>,
        phase: u16,
        solo: bool,
        moving: bool,
        before: u32,
        settings: &TrackerSettings,
    ) {
        let near = settings.near.as_micros();
        let reports_tentative = settings.tentative_votes != 0;
        let tentative_votes = settings.tentative_votes_if(moving || E > 1);
        let settings = &settings.for_motion(moving);
        let weights = settings.contradictions(solo);
        let follows = sounds.nearest(before).t_echo;
        let is_near = before.abs_diff(follows) <= near;
        for (place, track) in self.tracks.iter_mut().enumerate() {
            if !track.exists() {
                continue;
            }
            let at = track.t_echo();
            let would_show = sounds.would_show(at, near);
            let own = sounds.all_mut().filter(|sound| sound.track == place);
            if let Some(sound) = own.min_by_key(|sound| sound.t_echo.abs_diff(at)) {
                track.support(sound.t_echo, phase, solo, settings);
                let earlier = track.t_echo() < before.min(SILENCE);
                let enough = solo || track.close_votes() >= tentative_votes;
                sound.is_tentative = earlier && reports_tentative && enough;
            } else if is_near && at == before {
                track.grow_older();
                track.catch_up(follows);
            } else if would_show {
                track.contradict(phase, weights, settings);
            } else {
                track.mask(phase, settings);
            }
        }
        for sound in sounds.all_mut().filter(|sound| sound.track >= H && before.abs_diff(sound.t_echo) > near) {
            self.begin(sound.t_echo, phase, solo);
            sound.is_tentative = solo && reports_tentative && sound.t_echo != SILENCE;
        }
    }
}
