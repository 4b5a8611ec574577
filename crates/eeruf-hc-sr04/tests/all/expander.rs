//! Four modules in two pairs; each pair shares a trigger line behind a port expander, whose pins are slow and can fail.

use core::cell::{Cell, RefCell};

use eeruf_core::{
    EachSensor, EchoFilter, Edge, Instant, Layout, Micros, ReadingKind, Requirements, Ring, RingConfig, RingEvent,
    Uneven, VerifiedSchedule, plan::ScheduledFiring, schedule,
};
use eeruf_hc_sr04::{HcSr04Ring, Health, Pins, Settings};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{Error, ErrorKind, ErrorType, InputPin, OutputPin};

/// Modules 0 and 2 fire together, as do 1 and 3.
static RING: VerifiedSchedule<4, 2, EachSensor<4>> = schedule! {
    period_us: 76_000,
    t_fire_a_us: [0, 32_000, 0, 32_000],
    t_fire_b_us: [0, 40_000, 0, 40_000],
    each_meets: Requirements {
        layout: Layout::Ring(3),
        window: Micros::from_millis(25),
        uneven: Some(Uneven { together: &[0b101, 0b1010], ..Uneven::NONE }),
        ..Requirements::new(Micros::new(300))
    },
};
/// A byte over I2C at 100 kHz, with its address.
const TRANSFER_US: u32 = 190;
const RISES_AFTER_US: u32 = 450;
const WALLS_US: [u32; 4] = [3_000, 9_000, 15_000, 21_000];

/// The clock, the two trigger lines behind the expander, and the start and end of each module's pulse.
#[derive(Default)]
struct World {
    now_us: Cell<u32>,
    outputs: Cell<u8>,
    fails: Cell<bool>,
    pulses: RefCell<[Option<(u32, u32)>; 4]>,
    edges: RefCell<Vec<Edge>>,
}

impl World {
    /// Writes the expander's outputs. When a line falls, its modules start unless they are measuring.
    fn write(&self, outputs: u8) -> Result<(), Failed> {
        self.now_us.set(self.now_us.get() + TRANSFER_US);
        if self.fails.get() {
            return Err(Failed);
        }
        let fell = self.outputs.replace(outputs) & !outputs;
        let now = self.now_us.get();
        for sensor in (0..4_u8).filter(|sensor| fell >> (sensor % 2) & 1 == 1) {
            let pulse = &mut self.pulses.borrow_mut()[usize::from(sensor)];
            if pulse.is_some_and(|(_, falls)| falls > now) {
                continue;
            }
            let rises = now + RISES_AFTER_US;
            let falls = rises + WALLS_US[usize::from(sensor)];
            *pulse = Some((rises, falls));
            let edge = |high, at| Edge { sensor, high, at: Instant::from_micros(at) };
            self.edges.borrow_mut().extend([edge(true, rises), edge(false, falls)]);
        }
        Ok(())
    }
}

#[derive(Debug)]
struct Failed;

impl Error for Failed {
    fn kind(&self) -> ErrorKind {
        ErrorKind::Other
    }
}

/// An output of the expander.
struct Trigger<'w>(&'w World, u8);

impl ErrorType for Trigger<'_> {
    type Error = Failed;
}

impl OutputPin for Trigger<'_> {
    fn set_low(&mut self) -> Result<(), Failed> {
        self.0.write(self.0.outputs.get() & !(1 << self.1))
    }

    fn set_high(&mut self) -> Result<(), Failed> {
        self.0.write(self.0.outputs.get() | 1 << self.1)
    }
}

/// A module's echo line, on a pin of the board itself.
struct Echo<'w>(&'w World, usize);

impl ErrorType for Echo<'_> {
    type Error = Failed;
}

impl InputPin for Echo<'_> {
    fn is_high(&mut self) -> Result<bool, Failed> {
        let now = self.0.now_us.get();
        Ok(self.0.pulses.borrow()[self.1].is_some_and(|(rises, falls)| (rises..falls).contains(&now)))
    }

    fn is_low(&mut self) -> Result<bool, Failed> {
        self.is_high().map(|high| !high)
    }
}

struct Delay<'w>(&'w World);

impl DelayNs for Delay<'_> {
    fn delay_ns(&mut self, ns: u32) {
        self.0.now_us.set(self.0.now_us.get() + ns.div_ceil(1000));
    }
}

type Driver<'w> = HcSr04Ring<
    Ring<ScheduledFiring<'static, 4, 2, &'static EachSensor<4>>, EchoFilter<4>, 4>,
    Trigger<'w>,
    Echo<'w>,
    Delay<'w>,
    4,
>;

fn driver(world: &World) -> Driver<'_> {
    let ring = Ring::new(&RING, RingConfig::new(), Instant::default()).unwrap();
    let pins = [0, 1, 2, 3].map(|sensor| Pins { trigger: Trigger(world, sensor as u8 % 2), echo: Echo(world, sensor) });
    HcSr04Ring::new(ring, pins, Delay(world), Settings::default()).unwrap()
}

/// The kinds of at least `count` readings of each module, and the greatest error of an echo time.
fn readings(driver: &mut Driver<'_>, world: &World, count: usize) -> ([Vec<ReadingKind>; 4], u32) {
    let (mut kinds, mut off) = ([vec![], vec![], vec![], vec![]], 0);
    while kinds.iter().any(|of| of.len() < count) {
        let due = driver.next_deadline().as_micros();
        let mut edges = world.edges.take();
        edges.sort_by_key(|edge| edge.at.as_micros());
        let next = edges.first().map_or(due, |edge| edge.at.as_micros().min(due));
        world.now_us.set(world.now_us.get().max(next));
        // Interrupts of the lines are immediate.
        let later = edges.split_off(edges.partition_point(|edge| edge.at.as_micros() <= world.now_us.get()));
        world.edges.borrow_mut().extend(later);
        edges.into_iter().for_each(|edge| driver.edge(edge).unwrap());
        while let Some(event) = driver.poll(Instant::from_micros(world.now_us.get())) {
            if let RingEvent::Reading(reading) = event {
                let sensor = usize::from(reading.sensor);
                off = reading.t_echo.map_or(off, |t_echo| off.max(t_echo.as_micros().abs_diff(WALLS_US[sensor])));
                kinds[sensor].push(reading.kind);
            }
        }
    }
    (kinds, off)
}

#[test]
fn pairs_that_share_a_trigger_behind_an_expander_see_walls() {
    let world = World::default();
    let (kinds, off) = readings(&mut driver(&world), &world, 100);
    for (sensor, kinds) in kinds.iter().enumerate() {
        let accepted = kinds.iter().filter(|&&kind| kind == ReadingKind::Accepted).count();
        assert!(accepted >= kinds.len() - 1, "{sensor}: {accepted} of {}", kinds.len());
    }
    assert!(off <= 1, "{off} us");
}

#[test]
fn expander_that_fails_leaves_no_sensor_clear() {
    let world = World::default();
    let mut driver = driver(&world);
    readings(&mut driver, &world, 5);
    world.fails.set(true);
    let (kinds, _) = readings(&mut driver, &world, 5);
    assert!(kinds.iter().all(|kinds| kinds[1..].iter().all(|&kind| kind == ReadingKind::Unanswered)), "{kinds:?}");
    assert!((0..4).all(|sensor| driver.health(sensor) == Health::PinError));
    world.fails.set(false);
    let (kinds, _) = readings(&mut driver, &world, 5);
    assert!(kinds.iter().all(|kinds| kinds[2..].iter().all(|&kind| kind == ReadingKind::Accepted)), "{kinds:?}");
}
