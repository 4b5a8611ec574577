//! Rings on peripherals that trigger and capture: a PIO simulated cycle by cycle, an RMT receiver, and the capture
//! registers of a timer. The loop is late, and results are late, lost or duplicated.

use fastrand::Rng;
use std::collections::VecDeque;

use eeruf_core::flow::{BeliefSettings, FlowRing, TurnSettings};
use eeruf_core::{
    Instant, Micros, ReadingKind, Ring, RingConfig, RingEvent, ScheduledRing, Tally, judge::Judge, plan::Plan,
    tables::PAPER_12,
};
use eeruf_hc_sr04::capture::{CaptureRing, Captured, Captures, LineEdge, PioLine, RmtLine, TimerLine};
use eeruf_hc_sr04::{Health, Settings, SetupError};

use crate::pio::StateMachine;

const K: usize = 12;
const BEGIN: Instant = Instant::from_micros(u32::MAX - 700_000);

fn us(us: u32) -> Micros {
    Micros::new(us)
}

/// The space in front of a module, or a fault of its line.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Answer {
    /// A pulse of this many microseconds.
    Pulse(u32),
    /// A pulse with a gap of 5 us after 2 ms.
    Gap(u32),
    /// A second pulse after the first.
    Twice(u32),
    /// No edge at all.
    Cut,
    /// The line rises once and stays high for ever.
    Held,
}

impl Answer {
    /// Edges of the line, in microseconds after the trigger, alternately rising and falling.
    fn edges(self, jitter: u32) -> Vec<u32> {
        match self {
            Self::Pulse(width) => vec![450, 450 + width + jitter],
            Self::Gap(width) => vec![450, 2_450, 2_455, 450 + width + jitter],
            Self::Twice(width) => vec![450, 450 + width + jitter, 900 + width, 2_900 + width],
            Self::Cut => vec![],
            Self::Held => vec![450],
        }
    }
}

/// A fault in a peripheral's reports.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Trouble {
    None,
    /// Reports come up to 4 ms late.
    Late,
    /// Every third report gets lost.
    Lost,
    /// Each report comes twice.
    Twice,
    /// Reports come so late that the sensor has fired again.
    Stale,
}

/// Removes the first element if it passes the test.
fn next_if<T>(queue: &mut VecDeque<T>, may_come: impl Fn(&T) -> bool) -> Option<T> {
    if may_come(queue.front()?) { queue.pop_front() } else { None }
}

/// The modules: the line of each, the faults, and the firings.
struct Modules {
    answer: fn(u8) -> (Answer, Trouble),
    random: Rng,
    /// Edges of each line by time; the first rises if `high` is false.
    edges: [VecDeque<Instant>; K],
    high: [bool; K],
    reports: u32,
}

impl Modules {
    fn new(answer: fn(u8) -> (Answer, Trouble)) -> Self {
        let random = Rng::with_seed(20_000);
        Self { answer, random, edges: std::array::from_fn(|_| VecDeque::new()), high: [false; K], reports: 0 }
    }

    /// Triggers a module; one that holds its line ignores it.
    fn trigger(&mut self, sensor: u8, at: Instant) {
        let x = usize::from(sensor);
        if self.high[x] || !self.edges[x].is_empty() {
            return;
        }
        let jitter = self.random.u32(..=30);
        self.edges[x].extend((self.answer)(sensor).0.edges(jitter).into_iter().map(|after| at + us(after)));
    }

    /// The next edge of a line up to now.
    fn edge(&mut self, sensor: u8, now: Instant) -> Option<LineEdge> {
        let x = usize::from(sensor);
        let at = next_if(&mut self.edges[x], |at| now.has_reached(*at))?;
        self.high[x] = !self.high[x];
        Some(LineEdge { high: self.high[x], at })
    }

    fn trouble(&self, sensor: u8) -> Trouble {
        (self.answer)(sensor).1
    }

    /// Number of copies of the next report.
    fn copies(&mut self, sensor: u8) -> usize {
        self.reports += 1;
        match self.trouble(sensor) {
            Trouble::Lost if self.reports % 3 == 0 => 0,
            Trouble::Twice => 2,
            _ => 1,
        }
    }

    /// Lateness of the next report.
    fn late(&mut self, sensor: u8) -> Micros {
        match self.trouble(sensor) {
            Trouble::Late => us(self.random.u32(..=4_000)),
            Trouble::Stale => us(190_000),
            _ => us(0),
        }
    }
}

/// A state machine for each module.
struct Pio {
    modules: Modules,
    machines: [StateMachine; K],
    lines: [PioLine; K],
    words: [VecDeque<u32>; K],
    /// Greatest difference between a trigger and its requested instant.
    off: u32,
    awaited: [Instant; K],
}

impl Pio {
    fn new(modules: Modules) -> Self {
        let machines = std::array::from_fn(|_| StateMachine::new(BEGIN));
        let lines = [PioLine::new(us(45_000)); K];
        Self { modules, machines, lines, words: std::array::from_fn(|_| VecDeque::new()), off: 0, awaited: [BEGIN; K] }
    }

    fn run(&mut self, x: usize, now: Instant) {
        let (modules, sensor) = (std::cell::RefCell::new(&mut self.modules), x as u8);
        let (off, awaited) = (&mut self.off, self.awaited[x]);
        let level = |at| {
            let mut modules = modules.borrow_mut();
            while modules.edge(sensor, at).is_some() {}
            modules.high[x]
        };
        self.machines[x].run(now, level, |at| {
            *off = (*off).max(at.since(awaited).as_micros().min(awaited.since(at).as_micros()));
            modules.borrow_mut().trigger(sensor, at);
        });
    }
}

impl Captures for Pio {
    fn fire(&mut self, sensor: u8, at: Instant, now: Instant) -> Option<Instant> {
        let x = usize::from(sensor);
        self.run(x, now);
        let (words, at) = self.lines[x].fire(at, now)?;
        assert!(self.machines[x].from_host.is_empty() && self.machines[x].at == 0, "it listens still");
        self.awaited[x] = at;
        self.machines[x].from_host.extend(words);
        Some(at)
    }

    fn edge(&mut self, sensor: u8, now: Instant) -> Option<LineEdge> {
        let x = usize::from(sensor);
        self.run(x, now);
        loop {
            if let Some(word) = self.words[x].pop_front() {
                if let Some(edge) = self.lines[x].edge(word) {
                    return Some(edge);
                }
                continue;
            }
            let late = self.modules.late(sensor);
            let (_, word) = next_if(&mut self.machines[x].to_host, |(at, _)| now.has_reached(*at + late))?;
            let copies = self.modules.copies(sensor);
            self.words[x].extend(std::iter::repeat_n(word, copies));
        }
    }
}

/// A receiver for each module, with ticks of 2 us.
struct Rmt {
    modules: Modules,
    lines: [RmtLine<8>; K],
    fired: [Instant; K],
    /// The edges of a reception.
    edges: [Vec<LineEdge>; K],
    /// Symbols with their firing, and the time when they are available.
    received: [VecDeque<(Instant, Instant, Vec<u32>)>; K],
    is_on: [bool; K],
}

/// Idle threshold above the longest echo and below the 38 ms of a healthy module.
const IDLE: u32 = 37_000;

impl Rmt {
    fn new(modules: Modules) -> Self {
        let (edges, received) = (std::array::from_fn(|_| vec![]), std::array::from_fn(|_| VecDeque::new()));
        Self {
            modules,
            lines: [RmtLine::new(us(2), us(IDLE)); K],
            fired: [BEGIN; K],
            edges,
            received,
            is_on: [false; K],
        }
    }

    fn run(&mut self, x: usize, now: Instant) {
        let sensor = x as u8;
        while self.is_on[x] {
            let ends = self.edges[x].last().map(|edge| edge.at + us(IDLE));
            let until = ends.filter(|ends| now.has_reached(*ends)).unwrap_or(now);
            if let Some(edge) = self.modules.edge(sensor, until) {
                self.edges[x].push(edge);
                continue;
            }
            let Some(ends) = ends.filter(|ends| now.has_reached(*ends)) else { return };
            self.is_on[x] = false;
            let edges = std::mem::take(&mut self.edges[x]);
            let mut levels: Vec<u32> = edges
                .windows(2)
                .map(|pair| (u32::from(pair[0].high) << 15) | (pair[1].at.since(pair[0].at).as_micros() / 2))
                .collect();
            levels.extend(edges.last().map(|edge| u32::from(edge.high) << 15));
            levels.extend((levels.len() % 2 == 1).then_some(0));
            let symbols: Vec<u32> = levels.chunks(2).map(|pair| pair[0] | pair[1] << 16).collect();
            let (late, copies) = (self.modules.late(sensor), self.modules.copies(sensor));
            let report = (ends + late, self.fired[x], symbols);
            self.received[x].extend(std::iter::repeat_n(report, copies));
        }
    }
}

impl Captures for Rmt {
    fn fire(&mut self, sensor: u8, at: Instant, now: Instant) -> Option<Instant> {
        let x = usize::from(sensor);
        self.run(x, now);
        // Edges before the receiver is started are lost.
        let at = if now.has_reached(at) { now } else { at };
        while self.modules.edge(sensor, at).is_some() {}
        self.edges[x].clear();
        (self.fired[x], self.is_on[x]) = (at, true);
        self.modules.trigger(sensor, at);
        Some(at)
    }

    fn edge(&mut self, sensor: u8, now: Instant) -> Option<LineEdge> {
        let x = usize::from(sensor);
        self.run(x, now);
        loop {
            if let Some(edge) = self.lines[x].edge() {
                return Some(edge);
            }
            let (_, fired, symbols) = next_if(&mut self.received[x], |(at, ..)| now.has_reached(*at))?;
            self.lines[x].received(fired, &symbols);
        }
    }

    fn reports_within(&self) -> Micros {
        us(64_000)
    }
}

/// Two capture channels for each module, read on each turn of the loop.
struct Timer {
    modules: Modules,
    lines: [TimerLine; K],
    /// Registers that are read late, and the time when they were captured.
    kept: [(Captured, Option<Instant>); K],
    fires: [Option<Instant>; K],
    /// All firings.
    fired: Vec<(u8, Instant)>,
}

impl Timer {
    fn new(modules: Modules) -> Self {
        Self {
            modules,
            lines: [TimerLine::new(); K],
            kept: [(Captured::default(), None); K],
            fires: [None; K],
            fired: vec![],
        }
    }
}

fn counter(at: Instant) -> u16 {
    at.as_micros() as u16
}

impl Captures for Timer {
    fn fire(&mut self, sensor: u8, at: Instant, now: Instant) -> Option<Instant> {
        let at = if now.has_reached(at) { now + us(2) } else { at };
        self.fires[usize::from(sensor)] = Some(at);
        Some(at)
    }

    fn edge(&mut self, sensor: u8, now: Instant) -> Option<LineEdge> {
        let x = usize::from(sensor);
        if let Some(edge) = self.lines[x].edge() {
            return Some(edge);
        }
        let (mut registers, since) = self.kept[x];
        let mut take = |modules: &mut Modules, until| {
            while let Some(LineEdge { high, at }) = modules.edge(sensor, until) {
                let register = if high { &mut registers.rise } else { &mut registers.fall };
                registers.is_over |= register.replace(counter(at)).is_some();
            }
        };
        if let Some(at) = self.fires[x].take_if(|at| now.has_reached(*at)) {
            take(&mut self.modules, at);
            self.modules.trigger(sensor, at);
            self.fired.push((sensor, at));
        }
        take(&mut self.modules, now);
        let is_late = match self.modules.trouble(sensor) {
            Trouble::Late => self.modules.random.u32(..=1) == 0,
            Trouble::Stale => now.since(since.unwrap_or(now)) < us(90_000),
            _ => false,
        };
        self.kept[x] = (Captured::default(), None);
        if is_late {
            self.kept[x] = (registers, Some(since.unwrap_or(now)));
            return None;
        }
        if registers == Captured::default() {
            self.lines[x].captured(registers, counter(now), now);
            return None;
        }
        for _ in 0..self.modules.copies(sensor) {
            self.lines[x].captured(registers, counter(now), now);
        }
        self.lines[x].edge()
    }
}

type Driver<C> = CaptureRing<ScheduledRing<'static, K>, C, K>;

const CONFIG: RingConfig = RingConfig::new().with_window(Micros::new(40_000));

fn driver<C: Captures>(hardware: C) -> Driver<C> {
    CaptureRing::new(Ring::new(&PAPER_12, CONFIG, BEGIN).unwrap(), Settings::default(), hardware).unwrap()
}

fn run<C: Captures>(hardware: C, periods: u32) -> ([Tally<u32>; K], [Health; K], C, u32) {
    run_driver(driver(hardware), periods)
}

/// Runs a loop with a turn every 0 to 5 ms, for some periods.
fn run_driver<P: Plan, J: Judge, C: Captures, const H: usize>(
    mut driver: CaptureRing<Ring<P, J, K, 1, H>, C, K>,
    periods: u32,
) -> ([Tally<u32>; K], [Health; K], C, u32) {
    let (mut random, mut now) = (Rng::with_seed(20_000), BEGIN);
    let (mut tallies, mut ended, mut late) = ([Tally::default(); K], 0, 0);
    while ended < periods {
        now += us(random.u32(..=5_000));
        while let Some(event) = driver.poll(now) {
            match event {
                RingEvent::Fire { .. } => {}
                RingEvent::Reading(reading) => tallies[usize::from(reading.sensor)].count(reading.kind),
                RingEvent::PeriodEnded(stats) => {
                    ended += 1;
                    late = late.max(stats.sum_late.as_micros());
                }
            }
        }
    }
    let health = std::array::from_fn(|x| driver.driver().health(x as u8));
    (tallies, health, driver.into_hardware(), late)
}

fn fired(tally: &Tally<u32>) -> u32 {
    ReadingKind::ALL.iter().map(|&kind| tally.of(kind)).sum()
}

fn wall(sensor: u8) -> u32 {
    3_000 + 2_000 * u32::from(sensor)
}

/// The hardware gives the instant of every firing, so late loops cost time but no readings.
#[test]
fn flow_on_hardware_accepts_own_walls_in_late_loops() {
    fn accepted<C: Captures>(hardware: C) -> C {
        let ring = FlowRing::flow(K, TurnSettings::new(7), BeliefSettings::DEFAULT, CONFIG, BEGIN).unwrap();
        let driver = CaptureRing::new(ring, Settings::default(), hardware).unwrap();
        let (tallies, health, hardware, _) = run_driver(driver, 100);
        for (tally, health) in tallies.iter().zip(health) {
            let (all, accepted) = (fired(tally), tally.of(ReadingKind::Accepted));
            assert!(
                all >= 99 && 100 * accepted >= 95 * all && health == Health::Well,
                "{accepted} of {all}, {health:?}"
            );
        }
        hardware
    }
    let walls = |sensor| (Answer::Pulse(wall(sensor)), Trouble::None);
    assert_eq!(accepted(Pio::new(Modules::new(walls))).off, 0, "the trigger is exact");
    accepted(Timer::new(Modules::new(walls)));
}

/// A line of a single module: a state machine that is triggered once, and listens for 45 ms.
fn pio_edges(answer: fn(u8) -> (Answer, Trouble)) -> (Vec<(bool, u32)>, Pio) {
    let mut pio = Pio::new(Modules::new(answer));
    let fired = pio.fire(0, BEGIN + us(1_000), BEGIN).unwrap();
    let edges = std::iter::from_fn(|| pio.edge(0, fired + us(50_000)));
    let edges = edges.map(|LineEdge { high, at }| (high, at.since(fired).as_micros())).collect();
    (edges, pio)
}

#[test]
fn pio_program_times_edges_to_3_us() {
    let (edges, mut pio) = pio_edges(|_| (Answer::Gap(9_000), Trouble::None));
    let expected: Vec<_> = Answer::Gap(9_000).edges(0).into_iter().zip([true, false, true, false]).collect();
    assert_eq!(edges.len(), 4, "{edges:?}");
    for ((high, at), (exact, level)) in edges.into_iter().zip(expected) {
        // The gap of 5 us is seen, and each edge costs the count 2.5 us. The module's own jitter is up to 30 us.
        assert!(high == level && exact.saturating_sub(10) <= at && at <= exact + 31, "{at} for {exact}");
    }
    assert_eq!(pio.off, 0, "the trigger is exact");

    // The FIFO has no room for the word that ends the firing: the time tells when the state machine can fire again.
    let fired = pio.awaited[0];
    assert_eq!(pio.fire(0, fired + us(60_000), fired + us(45_500)), None);
    assert!(pio.fire(0, fired + us(60_000), fired + us(46_100)).is_some());

    let (edges, mut pio) = pio_edges(|_| (Answer::Held, Trouble::None));
    assert_eq!(edges.len(), 1, "{edges:?}");
    let fired = pio.awaited[0];
    assert!(pio.fire(0, fired, fired + us(45_100)).is_some_and(|at| at == fired + us(45_108)), "it was too late");
}

#[test]
fn pio_drops_words_of_earlier_firings() {
    let mut line = PioLine::new(us(45_000));
    let ([waits, command], at) = line.fire(BEGIN + us(500), BEGIN).unwrap();
    assert_eq!((at, waits, command), (BEGIN + us(500), 497, 1 << 24 | 45_000));
    let word = |tag: u32, left: u32, level: u32| tag << 24 | left << 1 | level;
    let rise = Some(LineEdge { high: true, at: at + us(11 + 450) });
    assert_eq!(line.edge(word(1, 44_550, 1)), rise);
    assert_eq!(line.edge(word(0, 44_550, 1)), None);
    assert_eq!(line.edge(word(1, 45_001, 1)), None, "more than it was to listen for");
    assert_eq!(line.edge(word(1, 0x7F_FFFF, 0)), None);
    assert!(line.fire(at + us(46_000), at + us(45_100)).is_some(), "it has said that it has listened");
    assert_eq!(line.edge(word(1, 44_550, 1)), None);
}

fn rmt_edges(symbols: &[u32]) -> Vec<(bool, u32)> {
    let mut line = RmtLine::<3>::new(us(2), us(IDLE));
    line.received(BEGIN, symbols);
    std::iter::from_fn(|| line.edge()).map(|LineEdge { high, at }| (high, at.since(BEGIN).as_micros())).collect()
}

#[test]
fn rmt_symbols_become_edges() {
    let high = |us: u32| 0x8000 | (us / 2);
    let symbol = |first: u32, second: u32| first | second << 16;
    assert_eq!(rmt_edges(&[]), []);
    assert_eq!(rmt_edges(&[symbol(high(9_000), 0)]), [(true, 450), (false, 9_450)]);
    assert_eq!(rmt_edges(&[symbol(high(0), 0)]), [(true, 450), (false, 450 + IDLE)], "held beyond the threshold");
    let gap = [symbol(high(2_000), 3), symbol(high(6_994), 0)];
    assert_eq!(rmt_edges(&gap), [(true, 450), (false, 2_450), (true, 2_456), (false, 9_450)]);
    assert_eq!(
        rmt_edges(&[symbol(10, high(0))]),
        [(false, 450), (true, 470), (false, 470 + IDLE)],
        "high at the start"
    );
    // The memory was full, so there is no end.
    assert_eq!(rmt_edges(&[symbol(high(100), high(100)); 4]).last(), Some(&(false, 450 + 600)));
    assert_eq!(
        rmt_edges(&[symbol(high(100), 50); 4]).last(),
        Some(&(false, 450 + 500)),
        "no more than it has room for"
    );
}

fn timer_edges(registers: Captured, after: u32) -> Vec<(bool, u32)> {
    let mut line = TimerLine::new();
    line.captured(Captured::default(), counter(BEGIN), BEGIN);
    let now = BEGIN + us(after);
    line.captured(registers, counter(now), now);
    std::iter::from_fn(|| line.edge()).map(|LineEdge { high, at }| (high, at.since(BEGIN).as_micros())).collect()
}

#[test]
fn timer_registers_become_edges() {
    let [early, late] = [10_000, 64_000].map(|after| Some(counter(BEGIN + us(after))));
    let pulse = Captured { rise: early, fall: late, is_over: false };
    assert_eq!(timer_edges(pulse, 65_000), [(true, 10_000), (false, 64_000)]);
    let gap = Captured { rise: late, fall: early, is_over: false };
    assert_eq!(timer_edges(gap, 65_000), [(false, 10_000), (true, 64_000)]);
    assert_eq!(timer_edges(Captured { rise: None, ..pulse }, 65_000), [(false, 64_000)]);
    assert_eq!(timer_edges(Captured { is_over: true, ..pulse }, 65_000), []);
    assert_eq!(timer_edges(pulse, 65_536), [], "a register may be from before the wrap");
    let mut unread = TimerLine::new();
    unread.captured(pulse, 7, BEGIN);
    assert_eq!(unread.edge(), None, "from before the first reading");
}

// Firings that the hardware holds happen, and reach the ring, before anything is changed.
#[test]
fn held_ring_lets_its_driver_be_changed() {
    let mut driver = driver(Timer::new(Modules::new(|sensor| (Answer::Pulse(wall(sensor)), Trouble::None))));
    let (mut now, mut readings) = (BEGIN, 0);
    while driver.driver_mut().is_some() {
        _ = driver.poll(now);
        now = driver.next_deadline();
    }
    driver.hold(true);
    let mut last = None;
    while driver.driver_mut().is_none() {
        now += us(300);
        while let Some(event) = driver.poll(now) {
            last = if let RingEvent::Fire { sensor, .. } = event { Some(sensor) } else { last };
        }
    }
    assert!(last.is_some());
    driver.driver_mut().unwrap().disable(3).unwrap();
    // A due firing does not happen while the ring is held.
    for _ in 0..100 {
        now += us(2_000);
        while let Some(event) = driver.poll(now) {
            assert!(!matches!(event, RingEvent::Fire { .. }), "{event:?}");
        }
    }
    driver.hold(false);
    while readings < 50 {
        now += us(300);
        while let Some(event) = driver.poll(now) {
            if let RingEvent::Fire { sensor, .. } = event {
                assert_ne!(sensor, 3);
            }
            readings += u32::from(matches!(event, RingEvent::Reading(_)));
        }
    }
}

// After a stalled loop firings come late, and all later ones move with them.
#[test]
fn ring_knows_each_firing_after_stalls() {
    let mut driver = driver(Timer::new(Modules::new(|sensor| (Answer::Pulse(wall(sensor)), Trouble::None))));
    let (mut random, mut now, mut fires, mut accepted) = (Rng::with_seed(3), BEGIN, vec![], 0);
    for turn in 1..20_000 {
        now += us(if turn % 100 == 0 { 5_000 + random.u32(..=60_000) } else { random.u32(..=2_000) });
        while let Some(event) = driver.poll(now) {
            match event {
                RingEvent::Fire { sensor, .. } => {
                    fires.push((sensor, driver.driver().ring().last_firing(sensor).unwrap()));
                }
                RingEvent::Reading(reading) => accepted += u32::from(reading.kind == ReadingKind::Accepted),
                RingEvent::PeriodEnded(_) => {}
            }
        }
    }
    let mut fired = driver.into_hardware().fired;
    // They were collected by sensor, not in order of time.
    fired.sort_by_key(|(_, at)| at.since(BEGIN));
    assert_eq!(fires[..], fired[..fires.len()]);
    assert!(fires.len() > 2_000 && accepted > 1_000, "{} firings, {accepted} accepted", fires.len());
}

#[test]
fn reports_later_than_the_next_firing_are_refused() {
    struct Slow;
    impl Captures for Slow {
        fn fire(&mut self, _: u8, at: Instant, _: Instant) -> Option<Instant> {
            Some(at)
        }
        fn edge(&mut self, _: u8, _: Instant) -> Option<LineEdge> {
            None
        }
        fn reports_within(&self) -> Micros {
            us(200_000)
        }
    }
    let ring = Ring::new(&PAPER_12, RingConfig::new(), BEGIN).unwrap();
    assert!(matches!(CaptureRing::new(ring, Settings::default(), Slow), Err(SetupError::Ring(_))));
}

/// Runs a test on all three peripherals.
fn each(answer: fn(u8) -> (Answer, Trouble), periods: u32, check: impl Fn(&str, [Tally<u32>; K], [Health; K])) {
    let (tallies, health, pio, late) = run(Pio::new(Modules::new(answer)), periods);
    assert_eq!((late, pio.off <= 1), (0, true), "a PIO fires when the table says: {} us off", pio.off);
    check("PIO", tallies, health);
    let (tallies, health, ..) = run(Rmt::new(Modules::new(answer)), periods);
    check("RMT", tallies, health);
    let (tallies, health, ..) = run(Timer::new(Modules::new(answer)), periods);
    check("timer", tallies, health);
}

#[test]
fn late_loop_accepts_walls_and_clears_space() {
    let space = |sensor| {
        // Sensors from 8 on have nothing in range; results of odd ones come late.
        let pulse = Answer::Pulse(if sensor < 8 { wall(sensor) } else { 37_900 });
        (pulse, if sensor % 2 == 1 { Trouble::Late } else { Trouble::None })
    };
    each(space, 120, |by, tallies, health| {
        let (mut all_right, mut all) = (0, 0);
        for (sensor, tally) in tallies.iter().enumerate() {
            let right = tally.of(if sensor < 8 { ReadingKind::Accepted } else { ReadingKind::Clear });
            assert!(fired(tally) > 115 && 100 * right >= 99 * (fired(tally) - 1), "{by}, sensor {sensor}: {tally:?}");
            (all_right, all) = (all_right + right, all + fired(tally));
        }
        println!("{by}: {all_right} of {all} readings right");
        assert_eq!(health, [Health::Well; K], "{by}");
    });
}

#[test]
fn faults_are_never_clear() {
    let faulty = |sensor| match sensor {
        0 => (Answer::Cut, Trouble::None),
        1 => (Answer::Held, Trouble::None),
        2 => (Answer::Pulse(wall(2)), Trouble::Lost),
        3 => (Answer::Pulse(wall(3)), Trouble::Twice),
        4 => (Answer::Pulse(wall(4)), Trouble::Stale),
        5 => (Answer::Twice(wall(5)), Trouble::None),
        6 => (Answer::Gap(wall(6)), Trouble::None),
        7 => (Answer::Gap(wall(7)), Trouble::Lost),
        sensor => (Answer::Pulse(wall(sensor)), Trouble::None),
    };
    each(faulty, 120, |by, tallies, health| {
        for (sensor, tally) in tallies.iter().enumerate() {
            assert_eq!(tally.of(ReadingKind::Clear), 0, "{by}, sensor {sensor}: {tally:?}");
        }
        let accepted = tallies.map(|tally| tally.of(ReadingKind::Accepted));
        assert_eq!([accepted[0], accepted[1], accepted[4]], [0; 3], "{by}");
        let least = |sensor: usize| assert!(accepted[sensor] > 115, "{by}, sensor {sensor}: {:?}", tallies[sensor]);
        // Two pulses between two looks at a timer's registers overwrite each other.
        let twice = (by != "timer").then_some(5);
        [3, 8, 9, 10, 11].into_iter().chain(twice).for_each(least);
        assert_eq!([health[0], health[8]], [Health::Missing, Health::Well], "{by}");
    });
}
