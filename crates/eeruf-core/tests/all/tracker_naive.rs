//! The tracker beside one that is written from its rules (`docs/explanation/hopping.md`) with no regard for size or
//! speed: sets of phases instead of bits, wide numbers, and `None` for what is missing.

use std::collections::BTreeSet;

use eeruf_core::{
    Micros, Phase, ReadingKind,
    judge::{EchoTracker, Firing, TrackerSettings},
};

use super::common::random::Random;

/// The latest echo that a tracker tells from later ones, in microseconds.
const LATEST_US: i64 = (1 << 24) - 1 - (1 << 16);

/// Where an echo is: in microseconds, or nowhere. Nowhere is later than all, and far from each of them.
type Place = Option<i64>;

fn is_later(one: Place, other: Place) -> bool {
    one.unwrap_or(i64::MAX) > other.unwrap_or(i64::MAX)
}

fn distance(one: Place, other: Place) -> i64 {
    match (one, other) {
        (Some(one), Some(other)) => (one - other).abs(),
        (None, None) => 0,
        _ => i64::MAX,
    }
}

#[derive(Clone, Debug)]
struct Belief {
    place: Place,
    phases: BTreeSet<u8>,
    solo_votes: i64,
    score: i64,
    close: i64,
    age: i64,
    is_confirmed: bool,
    was_contradicted: bool,
    /// It was confirmed, and is again by one reading.
    is_remembered: bool,
}

impl Belief {
    fn new(place: Place, phase: u8, solo: bool) -> Self {
        let (score, solo_votes) = if solo { (2, 1) } else { (1, 0) };
        let (is_confirmed, was_contradicted, is_remembered) = (false, false, false);
        let phases = [phase].into();
        Self { place, phases, solo_votes, score, close: 1, age: 0, is_confirmed, was_contradicted, is_remembered }
    }

    fn votes(&self) -> i64 {
        self.phases.len() as i64 + self.solo_votes
    }

    fn follow(&mut self, place: Place, part: (i64, i64)) {
        if let (Some(at), Some(to)) = (self.place, place) {
            self.place = Some(at + (to - at) * part.0 / part.1);
        }
    }

    fn support(&mut self, place: Place, phase: u8, solo: bool, settings: &TrackerSettings) {
        let is_new = self.phases.insert(phase);
        if is_new && distance(self.place, place) <= i64::from(settings.tentative_within.as_micros()) {
            self.close = (self.close + 1).min(31);
        }
        if solo {
            self.solo_votes = (self.solo_votes + 1).min(i64::from(settings.votes));
        }
        if is_new || solo || self.is_confirmed {
            self.score = (self.score + if solo { 2 } else { 1 }).min(i64::from(settings.score_limit));
        }
        if core::mem::take(&mut self.is_remembered) && self.age <= i64::from(settings.memory) {
            self.is_confirmed = true;
            self.score = self.score.max(2);
        }
        self.age = 0;
        self.follow(place, (1, 4));
        self.is_confirmed |= self.votes().min(self.score) >= i64::from(settings.votes);
    }

    fn miss(&mut self, phase: u8, settings: &TrackerSettings) {
        self.phases.remove(&phase);
        if self.is_confirmed && self.votes() < 2 {
            (self.is_confirmed, self.is_remembered) = (false, settings.memory > 0);
        }
    }

    /// Returns true if it is remembered, now that nothing speaks for it.
    fn lose(&mut self, settings: &TrackerSettings) -> bool {
        let remembers = (self.is_confirmed || self.is_remembered) && self.age < i64::from(settings.memory);
        (self.is_confirmed, self.is_remembered, self.was_contradicted) = (false, true, true);
        (self.score, self.solo_votes, self.close, self.age) = (1, 0, 0, self.age + 1);
        self.phases.clear();
        remembers
    }
}

/// One sensor of a tracker with as many places for beliefs as the vector is long.
struct Naive {
    settings: TrackerSettings,
    /// The most echoes of a firing.
    echoes: usize,
    beliefs: Vec<Option<Belief>>,
    age: Option<u16>,
    surplus: i64,
    /// Its last reading, unless that said nothing.
    last: Place,
    /// The surplus that two consecutive readings showed last.
    observed: Option<i64>,
}

impl Naive {
    fn new(settings: TrackerSettings, places: usize, echoes: usize) -> Self {
        Self { settings, echoes, beliefs: vec![None; places], age: None, surplus: 0, last: None, observed: None }
    }

    fn confirmed(&self) -> Option<Place> {
        let places = self.beliefs.iter().flatten().filter(|belief| belief.is_confirmed).map(|belief| belief.place);
        places.min_by_key(|place| place.unwrap_or(i64::MAX))
    }

    fn shift(&mut self, expected_us: i32) {
        let expected = i64::from(expected_us).clamp(i64::from(i16::MIN), i64::from(i16::MAX));
        let change = expected + expected * self.surplus / 64;
        for belief in self.beliefs.iter_mut().flatten() {
            let moved = belief.place.map(|at| at + change);
            if moved.is_some_and(|at| (0..=LATEST_US).contains(&at)) {
                belief.place = moved;
            }
        }
    }

    fn grow_older(&mut self, kind: ReadingKind) {
        self.age = match kind {
            ReadingKind::Accepted | ReadingKind::Tentative => Some(0),
            _ => self.age.map(|age| (age + 1).min(u16::MAX - 1)),
        };
    }

    fn nearest(&self, place: Place) -> Option<usize> {
        let within = i64::from(self.settings.t_delta.as_micros());
        let far = |at: &usize| self.beliefs[*at].as_ref().map_or(i64::MAX, |belief| distance(belief.place, place));
        (0..self.beliefs.len()).filter(|at| far(at) <= within).min_by_key(far)
    }

    fn weakest(&self) -> usize {
        let rank =
            |at: &usize| self.beliefs[*at].as_ref().map(|of| (of.is_confirmed, of.is_remembered, of.score, -of.age));
        (0..self.beliefs.len()).min_by_key(rank).unwrap()
    }

    /// The kind of a reading, its echo, and the echo time that it is compared with: of a firing whose sounds these are,
    /// earliest first, the last of them silence if there was room for more echoes.
    fn push(&mut self, sounds: &[Place], firing: Firing) -> (ReadingKind, Place, Place) {
        // A robot that moves remembers for three times as long.
        let moves = firing.expected_change_us != 0;
        let settings = self.settings.with_memory(self.settings.memory.saturating_mul(if moves { 3 } else { 1 }));
        let (phase, solo) = (firing.phase.0 % 16, firing.solo);
        self.learn(sounds[0], firing.expected_change_us);
        self.shift(firing.expected_change_us);
        let before = self.confirmed();
        let is_near = |of: Option<Place>, place: Place| {
            of.is_some_and(|of| distance(of, place) <= i64::from(settings.near.as_micros()))
        };
        let nearest: Vec<_> = sounds.iter().map(|&place| self.nearest(place)).collect();
        let place_of = |at: usize| self.beliefs[at].as_ref().map(|belief| belief.place);
        let previous: Vec<_> = nearest.iter().map(|at| at.map_or(before, place_of)).collect();
        let mut tentative = vec![false; sounds.len()];
        for at in (0..self.beliefs.len()).filter(|_| firing.steady) {
            let Some(belief) = &mut self.beliefs[at] else { continue };
            let own = (0..sounds.len()).filter(|&sound| nearest[sound] == Some(at));
            let follows = before.and_then(|before| sounds.iter().copied().min_by_key(|&of| distance(of, before)));
            let follows = follows.filter(|&sound| is_near(before, sound));
            if let Some(sound) = own.min_by_key(|&sound| distance(sounds[sound], belief.place)) {
                belief.support(sounds[sound], phase, solo, &settings);
                let is_earlier = belief.place.is_some() && before.is_none_or(|before| is_later(before, belief.place));
                // Two of many, and any two readings while the robot moves, agree by chance.
                let least = if moves || self.echoes > 1 { 3 } else { 0 };
                let votes = i64::from(settings.tentative_votes).max(least);
                let agreed = !belief.was_contradicted && belief.close >= votes;
                tentative[sound] = is_earlier && settings.tentative_votes != 0 && (solo || agreed);
            } else if let Some(place) = follows.filter(|_| before == Some(belief.place)) {
                belief.age = (belief.age + 1).min(255);
                belief.follow(place, (3, 10));
            } else if sounds.iter().any(|&sound| is_later(sound, belief.place))
                // Two so close to each other are reported as one.
                && !(self.echoes > 1
                    && sounds.iter().any(|&of| !is_later(of, belief.place) && is_near(Some(of), belief.place)))
            {
                let solo_weight = settings.solo_contradiction;
                let weight = if belief.is_confirmed { settings.contradiction } else { 1 };
                belief.score -= i64::from(if solo { solo_weight } else { weight });
                if belief.score <= 0 {
                    if !belief.lose(&settings) {
                        self.beliefs[at] = None;
                    }
                    continue;
                }
                belief.solo_votes = 0;
                belief.was_contradicted = true;
                belief.age = (belief.age + 1).min(255);
                belief.miss(phase, &settings);
            } else {
                belief.age = (belief.age + 1).min(255);
                if belief.is_confirmed {
                    belief.miss(phase, &settings);
                }
            }
        }
        for sound in 0..sounds.len() {
            if firing.steady && nearest[sound].is_none() && !is_near(before, sounds[sound]) {
                let weakest = self.weakest();
                self.beliefs[weakest] = Some(Belief::new(sounds[sound], phase, solo));
                tentative[sound] = solo && settings.tentative_votes != 0 && sounds[sound].is_some();
            }
        }
        let confirmed = self.confirmed();
        let of_confirmed = |&sound: &usize| confirmed.map_or(0, |confirmed| distance(sounds[sound], confirmed));
        let best = (0..sounds.len()).min_by_key(of_confirmed).filter(|&sound| is_near(confirmed, sounds[sound]));
        let first = (0..sounds.len()).find(|&sound| tentative[sound]);
        let first = first.filter(|&first| best.is_none_or(|best| first < best));
        let sound = first.or(best).unwrap_or(0);
        let kind = match (first.is_none() && best.is_some(), sounds[sound]) {
            (true, None) => ReadingKind::Clear,
            (true, Some(_)) => ReadingKind::Accepted,
            (false, None) => ReadingKind::NoEcho,
            (false, Some(_)) if first.is_some() => ReadingKind::Tentative,
            (false, Some(_)) if previous[sound].is_none() => ReadingKind::First,
            (false, Some(_)) => ReadingKind::Rejected,
        };
        self.grow_older(kind);
        (kind, sounds[sound], previous[sound].flatten())
    }

    /// The share of the expected change that there is, from two pairs of consecutive readings that agree about it.
    fn learn(&mut self, place: Place, expected_us: i32) {
        let last = core::mem::replace(&mut self.last, place);
        let expected = i64::from(expected_us);
        let observed = match (last, place) {
            (Some(last), Some(now)) if (40..32_768).contains(&expected.abs()) => {
                Some(64 * (now - last) / expected - 64)
            }
            _ => None,
        };
        let observed = observed.filter(|surplus| (-80..=80).contains(surplus));
        let before = self.observed;
        self.observed = observed.or(before);
        if let (Some(before), Some(now)) = (before, observed) {
            if (now - before).abs() * expected.abs() <= 64 * i64::from(self.settings.t_delta.as_micros()) {
                self.surplus = (self.surplus + (now - self.surplus) / 2).clamp(-64, 64);
            }
        }
    }

    fn firing_changed(&mut self) {
        for belief in self.beliefs.iter_mut().flatten().filter(|belief| !belief.is_confirmed) {
            belief.phases.clear();
            (belief.score, belief.close, belief.is_remembered) = (belief.score.min(1), 0, false);
        }
    }
}

/// Sounds of a sensor: a wall that comes and goes, moves and turns away, paths in some phases, and chance.
struct World {
    random: Random,
    wall_us: Place,
    paths_us: Vec<Place>,
}

impl World {
    fn new(seed: u64) -> Self {
        let mut random = Random(seed);
        let paths_us = (0..19).map(|_| (random.up_to(3) == 0).then(|| 500 + i64::from(random.up_to(12_000)))).collect();
        Self { random, wall_us: Some(8_000), paths_us }
    }

    fn one_in(&mut self, many: u32) -> bool {
        self.random.up_to(many - 1) == 0
    }

    fn settings(&mut self) -> TrackerSettings {
        let random = &mut self.random;
        let some = |random: &mut Random, most: u32| Micros::new(1 + random.up_to(most - 1));
        let t_delta = some(random, 400);
        let near = Micros::new(t_delta.as_micros() + random.up_to(400));
        let votes = 2 + random.up_to(5) as u8;
        let tentative_votes = [0, 2, 3, 4][random.up_to(3) as usize];
        let settings = TrackerSettings::BALANCED.with_t_delta(t_delta).with_votes(votes);
        let settings = settings.with_near(near).with_score_limit(votes + random.up_to(4) as u8);
        let settings = settings.with_contradiction(1 + random.up_to(3) as u8).with_tentative_votes(tentative_votes);
        let settings = settings.with_solo_contradiction(1 + random.up_to(7) as u8);
        let settings = settings.with_memory([0, 0, 3, 10, 40][random.up_to(4) as usize]);
        settings.with_tentative_within(Micros::new(random.up_to(t_delta.as_micros())))
    }

    /// All that comes back from a firing in this phase, earliest first.
    fn heard(&mut self, firing: Firing, part: i64) -> Vec<i64> {
        if self.one_in(40) {
            let far = self.one_in(20);
            self.wall_us =
                (!self.one_in(3)).then(|| i64::from(self.random.up_to(if far { 20_000_000 } else { 9_000 })));
        }
        let change = i64::from(firing.expected_change_us.clamp(-2_000, 2_000)) * part / 64;
        self.wall_us = self.wall_us.map(|at| (at + change).max(0));
        let jitter = i64::from(self.random.up_to(120)) - 60;
        let own = self.wall_us.filter(|_| !self.one_in(8)).map(|at| (at + jitter).max(0));
        let path = self.paths_us[usize::from(firing.phase.0) % 19].filter(|_| !firing.solo);
        let chance = self.one_in(15).then(|| i64::from(self.random.up_to(9_000)));
        let behind = own.map(|at| at + 700).filter(|_| !self.one_in(5));
        let mut all: Vec<_> = [own, path, chance, behind].into_iter().flatten().map(|at| at.min(LATEST_US)).collect();
        all.sort_unstable();
        all
    }
}

fn agree<const H: usize, const E: usize>(seed: u64) {
    let mut world = World::new(seed);
    let settings = world.settings();
    let mut tracker = EchoTracker::<1, H, E>::new(settings).unwrap();
    let mut naive = Naive::new(settings, H, E);
    let (phases, part) = (2 + world.random.up_to(17), i64::from(world.random.up_to(192)));
    let swings = 4 + world.random.up_to(30);
    for number in 0..400_u32 {
        let expected_change_us = match world.random.up_to(9) {
            0 => 0,
            1 => world.random.up_to(60) as i32 - 30,
            2 => [i32::MIN, i32::MAX, 40_000, -40_000][world.random.up_to(3) as usize],
            _ if number / swings % 2 == 0 => 120,
            _ => -120,
        };
        let expected_change_us = if seed % 3 == 0 { 0 } else { expected_change_us };
        let (solo, steady) = (world.one_in(6), !world.one_in(12));
        let firing = Firing { phase: Phase((number % phases) as u8), solo, steady, expected_change_us };
        let echoes_us = world.heard(firing, part);
        let echoes: Vec<_> = echoes_us.iter().map(|&at| Micros::new(at as u32)).collect();
        let silence = core::iter::once(None);
        let sounds: Vec<Place> = echoes_us.into_iter().map(Some).chain(silence).take(E).collect();
        let us = |echo: Option<Micros>| echo.map(|echo| i64::from(echo.as_micros()));
        let verdict = if world.one_in(20) {
            naive.last = None;
            naive.shift(expected_change_us);
            naive.grow_older(ReadingKind::TooEarly);
            let first = echoes.first().copied();
            let verdict = tracker.skip(0, ReadingKind::TooEarly, first, expected_change_us).unwrap();
            assert_eq!((verdict.kind, verdict.t_echo, verdict.previous), (ReadingKind::TooEarly, first, None));
            verdict
        } else {
            let verdict = tracker.push(0, &echoes, firing).unwrap();
            let said = (verdict.kind, us(verdict.t_echo), us(verdict.previous));
            assert_eq!(said, naive.push(&sounds, firing), "{seed}, firing {number}: {:?}", naive.beliefs);
            verdict
        };
        assert_eq!((verdict.age, tracker.age(0)), (naive.age, naive.age));
        if world.one_in(150) {
            tracker.forget(0);
            naive = Naive { age: naive.age, ..Naive::new(settings, H, E) };
        }
        if world.one_in(30) {
            tracker.firing_changed();
            naive.firing_changed();
        }
        assert_eq!(us(tracker.confirmed(0)), naive.confirmed().flatten(), "{seed}, firing {number}");
        assert_eq!(tracker.is_clear(0), naive.confirmed() == Some(None), "{seed}, firing {number}");
    }
}

#[test]
fn the_tracker_says_what_its_rules_say_of_any_readings() {
    // In the last one two tracks come to the same place.
    for seed in (0..2_000).chain([18_512]) {
        agree::<4, 1>(seed);
        agree::<2, 1>(seed);
        agree::<1, 1>(seed);
        agree::<12, 8>(seed);
        agree::<4, 3>(seed);
        agree::<2, 2>(seed);
    }
}

// A sensor is of no age until a reading counts and no older than can be given.
#[test]
fn sensor_age_saturates_and_starts_unknown() {
    let mut tracker = EchoTracker::<1>::new(TrackerSettings::BALANCED).unwrap();
    let alone = Firing { solo: true, ..Firing::new(Phase(0)) };
    assert_eq!(tracker.skip(0, ReadingKind::TooEarly, None, 0).unwrap().age, None);
    assert_eq!(tracker.push(0, &[Micros::new(9_000)], alone).unwrap().age, Some(0));
    for firing in 1..=70_000_u32 {
        let age = tracker.skip(0, ReadingKind::TooEarly, None, 0).unwrap().age;
        assert_eq!(age, Some(firing.min(65_534) as u16));
    }
}

#[test]
fn what_is_confirmed_no_more_keeps_no_place_from_what_comes() {
    // Walls that come and go one after the other, each confirmed and then contradicted, and then two that take turns.
    let mut tracker = EchoTracker::<1>::new(TrackerSettings::BALANCED).unwrap();
    let mut phases = (0..11).cycle();
    let mut push = |t_echo| tracker.push(0, &[Micros::new(t_echo)], Firing::new(Phase(phases.next().unwrap())));
    for wall in 1..=8 {
        assert_eq!((0..22).map(|_| push(2_000 * wall).unwrap().kind).last(), Some(ReadingKind::Accepted), "{wall}");
    }
    let kinds: Vec<_> = (0..30).map(|turn| push(20_000 + 1_000 * (turn % 2)).unwrap().kind).collect();
    assert!(kinds[20..].contains(&ReadingKind::Accepted), "{kinds:?}");
}

#[test]
fn a_track_that_is_masked_for_long_stays_where_it_is() {
    let mut tracker = EchoTracker::<1>::new(TrackerSettings::BALANCED).unwrap();
    let mut phases = (0..11).cycle();
    let mut push = |t_echo| tracker.push(0, &[Micros::new(t_echo)], Firing::new(Phase(phases.next().unwrap())));
    for _ in 0..22 {
        push(9_000).unwrap();
    }
    // Earlier ones by chance, longer than an age is counted.
    let mut random = Random(3);
    for _ in 0..600 {
        push(random.up_to(8_000)).unwrap();
    }
    assert_eq!(push(9_000).unwrap().previous, Some(Micros::new(9_000)));
}

// A track that is masked and supported in turns gets no more votes than can be counted.
#[test]
fn masked_track_gets_no_more_votes_than_fit() {
    let settings = TrackerSettings::BALANCED;
    let mut tracker = EchoTracker::<1>::new(settings).unwrap();
    let mut naive = Naive::new(settings, 4, 1);
    let mut random = Random(5);
    // Of eleven phases each is masked in every other period, and in the end all are, so that it is confirmed no more.
    for number in 0..400_u16 {
        let is_masked = number > 22 && (number % 2 == 0 || number > 380) && number < 395;
        let t_echo = if is_masked { random.up_to(8_000) } else { 9_000 };
        let firing = Firing::new(Phase((number % 11) as u8));
        let verdict = tracker.push(0, &[Micros::new(t_echo)], firing).unwrap();
        assert_eq!(verdict.kind, naive.push(&[Some(t_echo.into())], firing).0, "firing {number}");
    }
}

#[test]
fn each_setting_of_a_tracker_is_set_alone() {
    let us = Micros::new;
    let kept = TrackerSettings::MAPS;
    let sets = |set: fn(&mut TrackerSettings), says: TrackerSettings| {
        let mut wanted = kept;
        set(&mut wanted);
        assert_eq!(says, wanted);
        assert_ne!(says, kept);
    };
    sets(|of| of.t_delta = Micros::new(77), kept.with_t_delta(us(77)));
    sets(|of| of.near = Micros::new(777), kept.with_near(us(777)));
    sets(|of| of.votes = 3, kept.with_votes(3));
    sets(|of| of.score_limit = 9, kept.with_score_limit(9));
    sets(|of| of.contradiction = 3, kept.with_contradiction(3));
    sets(|of| of.solo_contradiction = 3, kept.with_solo_contradiction(3));
    sets(|of| of.tentative_votes = 3, kept.with_tentative_votes(3));
    sets(|of| of.memory = 7, kept.with_memory(7));
    sets(|of| of.tentative_within = Micros::new(7), kept.with_tentative_within(us(7)));
    let numbers = |of: TrackerSettings| {
        let votes = (of.votes, of.score_limit, of.tentative_votes);
        assert_eq!((of.t_delta, of.near, of.solo_contradiction), (us(150), us(400), 6));
        (votes, of.contradiction, of.tentative_within)
    };
    assert_eq!(numbers(TrackerSettings::BALANCED), ((5, 6, 2), 2, us(60)));
    assert_eq!(numbers(TrackerSettings::QUICK), ((4, 6, 2), 2, us(100)));
    assert_eq!(numbers(TrackerSettings::MAPS), ((5, 7, 0), 1, us(60)));
    assert_eq!(TrackerSettings::default(), TrackerSettings::BALANCED);
}
