//! One question after another over the same memory: decide a problem, and find where "no" turns into "yes" along one of its numbers.

use super::bounds;
use super::classes::Classes;
use super::control::{Control, POLL, Progress};
use super::problem::Needs;
use super::random::Random;
use super::schedule::{self, Firing};
#[cfg(feature = "std")]
use super::threads::Replay;
use super::tree::{Outcome, Tree};

/// The number that is varied while all others stay.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Axis {
    /// The shortest period.
    Period,
    /// The largest separation.
    Separation,
    /// The largest interval.
    Interval,
    /// The largest window.
    Window,
}

/// A problem at a period.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct Question {
    pub(crate) needs: Needs,
    pub(crate) period: i32,
}

/// A question as [`Hunt::decide`] gets it; the answer, and the nodes that it takes, depend on nothing else while the budget of the hunt lasts.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct Ask {
    pub(crate) question: Question,
    pub(crate) budget: u64,
    pub(crate) guide: Option<Firing>,
    pub(crate) thorough: bool,
}

impl Question {
    /// The question with the number on `axis` replaced; larger `ease` is easier.
    pub(crate) fn at(&self, axis: Axis, ease: i32) -> Self {
        let mut question = *self;
        match axis {
            Axis::Period => question.period = ease,
            Axis::Separation => {
                question.needs.separation = -ease;
                if self.needs.least > 0 {
                    question.needs.least = (1 - ease) / 2;
                }
            }
            Axis::Interval => question.needs.interval = -ease,
            Axis::Window => question.needs.window = -ease,
        }
        question
    }

    /// The smallest ease at which the firing times serve.
    pub(crate) fn ease_of(&self, axis: Axis, firing: &Firing) -> i32 {
        let needs = &self.needs;
        match axis {
            Axis::Period => firing.period(needs),
            // Twice `|d|` of a single sensor with the stale-echo option can exceed the period.
            Axis::Separation => -firing.separation(needs, 2 * self.period),
            Axis::Interval => -firing.interval(needs, self.period, self.period),
            Axis::Window => -firing.window(self.period),
        }
    }
}

/// Where "no" turns into "yes".
pub(crate) struct Border {
    /// The largest ease known to be impossible.
    pub(crate) no: i32,
    /// The smallest ease known to be possible.
    pub(crate) yes: i32,
    /// Firing times at `yes`.
    pub(crate) firing: Firing,
    /// Whether these times came from a search, so that looking for something similar is worth while.
    pub(crate) guide: bool,
}

/// Counts nodes against the budget and asks the control.
pub(crate) struct Meter<'h, C> {
    control: &'h mut C,
    pub(crate) nodes: u64,
    /// The search ends when `nodes` reaches this.
    pub(crate) limit: u64,
    /// Shown to the control, with the period and the nodes of the moment.
    pub(crate) bound: u32,
    pub(crate) best: u32,
    /// The length of a tick of the questions asked, in the caller's ticks.
    pub(crate) ticks: u32,
    pub(crate) stopped: bool,
}

impl<C: Control> Meter<'_, C> {
    /// Whether budget and control allow going on.
    fn may_go_on(&self) -> bool {
        !self.stopped && self.nodes < self.limit
    }

    /// Runs the tree for `budget` nodes, polling.
    fn run(&mut self, tree: &mut Tree<'_, '_>, budget: u64, period: i32) -> Outcome {
        let end = tree.nodes() + budget;
        loop {
            let before = tree.nodes();
            let step = POLL.min(end - before).min(self.limit.saturating_sub(self.nodes));
            let outcome = tree.run(step);
            self.nodes += tree.nodes() - before;
            if outcome != Outcome::Spent || tree.nodes() >= end || tree.nodes() == before {
                return outcome;
            }
            let period = period as u32 * self.ticks;
            let progress = Progress { nodes: self.nodes, period, bound: self.bound, best: self.best };
            self.stopped |= self.control.poll(&progress).is_break();
            if !self.may_go_on() {
                return Outcome::Spent;
            }
        }
    }
}

/// Lent memory, and the meter.
pub(crate) struct Hunt<'h, C> {
    memory: &'h mut [i32],
    pub(crate) meter: Meter<'h, C>,
    /// Answers found on other threads, instead of memory to search in.
    #[cfg(feature = "std")]
    pub(crate) replay: Option<&'h mut Replay>,
}

impl<'h, C: Control> Hunt<'h, C> {
    pub(crate) fn new(memory: &'h mut [i32], control: &'h mut C, limit: u64) -> Self {
        Self {
            memory,
            meter: Meter { control, nodes: 0, limit, bound: 0, best: 0, ticks: 1, stopped: false },
            #[cfg(feature = "std")]
            replay: None,
        }
    }

    /// Decides a question with about `budget` nodes.
    ///
    /// Most schedules are found by a lucky descent or not for long: a small part of the budget goes to an ordinary search, led by `guide`, and
    /// the rest to descents of few nodes that begin in different ways. For a proof, `thorough`, all goes to the ordinary search.
    pub(crate) fn decide(&mut self, ask: &Ask) -> Outcome {
        #[cfg(feature = "std")]
        if let Some(replay) = &mut self.replay {
            return replay.answer(ask, &mut self.meter);
        }
        let Ask { question, budget, guide, thorough } = *ask;
        let mut tree = Tree::new(&question.needs, question.period, self.memory);
        let unit = 32 + 6 * question.needs.sensors as u64;
        let full = if thorough { budget } else { unit.max(budget / 8).min(budget) };
        tree.restart(None, guide);
        let outcome = self.meter.run(&mut tree, full, question.period);
        if outcome != Outcome::Spent {
            return outcome;
        }
        // Another budget, other descents: nothing lucky is tried twice while a budget grows.
        let seed = budget.wrapping_shl(20);
        let mut descents = 0;
        let classes = Classes::new(&question.needs);
        while tree.nodes() < budget && self.meter.may_go_on() {
            descents += 1;
            let mut random = Random::new(seed.wrapping_add(descents));
            // Every other descent begins with orders for whose classes there is room.
            let orders = classes.filter(|_| descents % 2 == 1);
            let orders = orders.and_then(|classes| classes.draw(&question.needs, question.period, &mut random));
            tree.restart(Some(random), None);
            if let Some(orders) = orders {
                tree.like(orders);
            }
            let run = (unit * luby(descents)).min(budget - tree.nodes());
            let outcome = self.meter.run(&mut tree, run, question.period);
            if outcome != Outcome::Spent {
                return outcome;
            }
        }
        Outcome::Spent
    }

    /// Decides a question with `budget` nodes, of which it spends more and more at a time.
    pub(crate) fn settle(&mut self, question: &Question, budget: u64) -> Outcome {
        let end = self.meter.nodes.saturating_add(budget).min(self.meter.limit);
        let mut part = 64 * question.needs.sensors as u64;
        loop {
            for (thorough, part) in [(false, part), (true, part.saturating_mul(4))] {
                let outcome = {
                    let budget = part.min(end.saturating_sub(self.meter.nodes));
                    self.decide(&Ask { question: *question, budget, guide: None, thorough })
                };
                if outcome != Outcome::Spent || self.meter.nodes >= end || !self.meter.may_go_on() {
                    return outcome;
                }
            }
            part = part.saturating_mul(4);
        }
    }

    /// Narrows the border along `axis` until nothing is between, or the budget is spent. What can be met at some ease can be at any larger.
    pub(crate) fn narrow(&mut self, question: &Question, axis: Axis, border: &mut Border) {
        let budget = self.climb(question, axis, border);
        self.close(question, axis, budget, border);
    }

    /// Narrows the border on the period in ticks of which each is `ticks` of the border's, and leaves the best found, with the budget that was last
    /// given to a question. At most half of all nodes that are left go into this.
    pub(crate) fn narrow_in_coarse_ticks(&mut self, coarse: &Needs, ticks: i32, border: &mut Border) -> u64 {
        let (limit, begin) = (self.meter.limit, self.meter.nodes);
        self.meter.limit = begin + limit.saturating_sub(begin) / 2;
        (self.meter.ticks, self.meter.bound) = (ticks as u32, border.no as u32 + 1);
        let firing = schedule::one_by_one(coarse);
        // No coarse period below the fine bound, rounded up.
        let mut found = Border { no: border.no / ticks, yes: firing.period(coarse), firing, guide: false };
        let question = Question { needs: *coarse, period: found.yes };
        self.narrow(&question, Axis::Period, &mut found);
        (border.firing, border.guide) = (found.firing.in_fine_ticks(ticks as u32), found.guide);
        (self.meter.limit, self.meter.ticks) = (limit, 1);
        (16 * coarse.sensors as u64).max((self.meter.nodes - begin) / 4)
    }

    /// Bounds are often met, so this starts at `border.no + 1` and goes up in growing steps until something is found, a few times with growing
    /// budgets: what is much easier is not much easier to find. Returns the last budget.
    fn climb(&mut self, question: &Question, axis: Axis, border: &mut Border) -> u64 {
        let mut budget = 16 * question.needs.sensors as u64;
        let first = ((border.yes - border.no) >> 8).max(1);
        for _ in 0..6 {
            let (mut step, mut ease) = (first, border.no + 1);
            for budget in [4 * budget, budget, budget, budget, budget, budget] {
                if ease >= border.yes
                    || !self.meter.may_go_on()
                    || matches!(self.ask(question, axis, ease, budget, false, border), Outcome::Found(_))
                {
                    return budget;
                }
                ease = ease.max(border.no) + step;
                step *= 2;
            }
            budget *= 2;
        }
        budget
    }

    /// Closes the border. The ease just below the best decides all: either it is possible, or nothing better is. In turns with growing budgets
    /// this tries to prove that it is impossible, and to find something better, by halving. When the budget is nearly spent on that, the
    /// rest goes into the bound.
    pub(crate) fn close(&mut self, question: &Question, axis: Axis, budget: u64, border: &mut Border) {
        let mut budget = budget;
        loop {
            let rest = self.meter.limit.saturating_sub(self.meter.nodes);
            if border.no + 1 >= border.yes || !self.meter.may_go_on() {
                return;
            }
            let most = rest - rest / 4;
            let outcome = self.ask(question, axis, border.yes - 1, (4 * budget).min(most), true, border);
            if outcome == Outcome::Spent && most <= 4 * budget {
                break;
            }
            // The tightest problem leaves the least to guess, so it comes first; then halving.
            let mut unknown = border.no;
            let mut ease = border.no + 1;
            while unknown + 1 < border.yes && self.meter.may_go_on() {
                if !self.finds(question, axis, ease, budget, border) {
                    unknown = ease;
                }
                ease = unknown + (border.yes - unknown) / 2;
            }
            budget *= 4;
        }
        let mut unknown = border.yes - 1;
        let budget = self.meter.limit.saturating_sub(self.meter.nodes) / 8;
        while border.no + 1 < unknown && self.meter.may_go_on() {
            let ease = border.no + (unknown - border.no) / 2;
            if self.ask(question, axis, ease, budget, true, border) != Outcome::Exhausted {
                unknown = ease.min(border.yes - 1);
            }
        }
    }

    /// Whether a schedule is found at `ease` with a little luck.
    pub(crate) fn finds(
        &mut self,
        question: &Question,
        axis: Axis,
        ease: i32,
        budget: u64,
        border: &mut Border,
    ) -> bool {
        matches!(self.ask(question, axis, ease, budget, false, border), Outcome::Found(_))
    }

    /// Decides at `ease` and moves the border accordingly.
    fn ask(
        &mut self,
        question: &Question,
        axis: Axis,
        ease: i32,
        budget: u64,
        thorough: bool,
        border: &mut Border,
    ) -> Outcome {
        if !self.meter.may_go_on() {
            return Outcome::Spent;
        }
        let asked = question.at(axis, ease);
        // Along the period the border already begins at the bound.
        let outcome = if axis != Axis::Period && bounds::largest(&asked.needs).period() as i32 > asked.period {
            Outcome::Exhausted
        } else {
            self.decide(&Ask { question: asked, budget, guide: border.guide.then_some(border.firing), thorough })
        };
        match &outcome {
            Outcome::Found(firing) => {
                border.firing = *firing;
                border.guide = true;
                border.yes = asked.ease_of(axis, firing).max(border.no + 1).min(ease);
            }
            Outcome::Exhausted => border.no = border.no.max(ease),
            Outcome::Spent => {}
        }
        if axis == Axis::Period {
            self.meter.best = border.yes as u32 * self.meter.ticks;
            // That there is no schedule in coarse ticks does not exclude one in fine ticks.
            if self.meter.ticks == 1 {
                self.meter.bound = border.no as u32 + 1;
            }
        }
        outcome
    }
}

/// The sequence 1 1 2 1 1 2 4 ... (Luby, Sinclair, Zuckerman), which is never far from the best lengths of restarts; `i` from 1.
fn luby(i: u64) -> u64 {
    let mut i = i;
    loop {
        let size = (i + 1).next_power_of_two();
        if size == i + 1 {
            return size / 2;
        }
        i -= size / 2 - 1;
    }
}
