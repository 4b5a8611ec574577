//! Counts instructions like `instructions`, for the plan alone and the filter alone, which can be used separately.
#![no_std]
#![no_main]

use core::hint::black_box;

use eeruf_board::say::leave;
use eeruf_core::tables::TABLE_I_D;
use eeruf_core::{
    EchoFilter, Instant, Micros,
    judge::Verdict,
    plan::{Plan, ScheduledFiring, Upcoming},
};
use eeruf_measure::{Range, T_DELTA, counts};

eeruf_board::no_panic!();
eeruf_board::interrupts!(eeruf_board::clear_alarm, eeruf_board::clear_echo);

#[inline(never)]
fn fire(plan: &mut ScheduledFiring<'static, 12>, now: Instant) -> Option<Upcoming> {
    plan.poll(now)
}

#[inline(never)]
fn push(filter: &mut EchoFilter<12>, sensor: u8, t_echo: Option<Micros>) -> Option<Verdict> {
    filter.push(sensor, t_echo).ok()
}

#[eeruf_board::entry]
fn main() -> ! {
    eeruf_board::start();
    let mut firing = Range::new("scheduler_fire");
    let mut pushing = Range::new("filter_push");
    let mut plan = ScheduledFiring::new(&TABLE_I_D, Instant::from_micros(0));
    let Ok(mut filter) = EchoFilter::<12>::new(T_DELTA, 2) else { leave(2) };
    for round in 0..480_u32 {
        let now = plan.deadline();
        let (taken, step) = counts(|| fire(&mut plan, now));
        if step.is_some() {
            firing.note(taken);
        }
        let t_echo = black_box((round % 7 != 0).then_some(Micros::new(5_000 + 600 * (round / 50))));
        pushing.note(counts(|| push(&mut filter, (round % 12) as u8, t_echo)).0);
    }
    firing.say();
    pushing.say();
    leave(0)
}
