//! Settings of flow: a dict of those that differ from the default.

use std::hash::{BuildHasher as _, RandomState};

use eeruf_core::{
    Micros,
    flow::{BeliefSettings, TurnSettings, Votes},
};
use eeruf_sim::FlowOptions;
use pyo3::{prelude::*, types::PyDict};

use crate::{
    arguments::{choice, flag, number, shown, text, whole, wrong},
    errors::EerufError,
};

/// Rest of an HC-SR04 module.
const REST: Micros = Micros::from_millis(60);

/// Settings from a dict; the rest follows from the ring's listening times.
#[derive(Default)]
pub(crate) struct FlowSettings {
    least: Option<Micros>,
    most: Option<Micros>,
    rest: Option<Micros>,
    dice: Option<Micros>,
    seed: Option<u32>,
    alone: Option<bool>,
    belief: Option<BeliefSettings>,
}

/// A setting of the plan, which is a time. Settings of belief are times or counts.
type Planned = (&'static str, fn(&mut FlowSettings) -> &mut Option<Micros>);
type Believed = (&'static str, fn(&mut BeliefSettings) -> &mut Micros);
type Counted = (&'static str, fn(&mut BeliefSettings) -> &mut u8);

const PLANNED: [Planned; 4] = [
    ("least_us", |settings| &mut settings.least),
    ("most_us", |settings| &mut settings.most),
    ("rest_us", |settings| &mut settings.rest),
    ("dice_us", |settings| &mut settings.dice),
];
const BELIEVED: [Believed; 3] = [
    ("t_delta_us", |settings| &mut settings.t_delta),
    ("near_us", |settings| &mut settings.near),
    ("path_change_us", |settings| &mut settings.path_change),
];
const COUNTED: [Counted; 2] = [("memory", |settings| &mut settings.memory), ("hold", |settings| &mut settings.hold)];
const SEED: &str = "seed";
const TOP_SPEED: &str = "top_speed_m_s";
const ALONE: &str = "alone";
const VOTES: &str = "votes";
const VOTING: [(&str, Votes); 3] =
    [("by_motion", Votes::ByMotion), ("two_in_a_row", Votes::TwoInARow), ("every_echo", Votes::EveryEcho)];

/// Finds a setting by its name.
fn named<F: Copy>(fields: &[(&'static str, F)], name: &str) -> Option<F> {
    fields.iter().find(|(known, _)| *known == name).map(|(_, field)| *field)
}

impl FlowSettings {
    /// The settings in an argument.
    pub(crate) fn of(value: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        Self::over(value, BeliefSettings::default())
    }

    /// The settings in an argument, which override the belief settings of a ring file.
    pub(crate) fn over(value: Option<&Bound<'_, PyAny>>, file: BeliefSettings) -> PyResult<Self> {
        let mut settings = Self::default();
        let Some(value) = value else { return Ok(settings) };
        let expected = "a dict such as {\"rest_us\": 60_000}";
        for (key, value) in value.cast::<PyDict>().map_err(|_| wrong("settings", shown(value), expected))? {
            let key = text("key of settings", &key, "the name of a setting of flow")?;
            let time = || whole(&key, &value, 0..=u32::MAX).map(Micros::new);
            let belief = settings.belief.unwrap_or(file);
            if let Some(field) = named(&PLANNED, &key) {
                *field(&mut settings) = Some(time()?);
            } else if key == SEED {
                settings.seed = Some(whole(&key, &value, 1..=u32::MAX)?);
            } else if let Some(field) = named(&BELIEVED, &key) {
                *field(settings.belief.insert(belief)) = time()?;
            } else if let Some(field) = named(&COUNTED, &key) {
                *field(settings.belief.insert(belief)) = whole(&key, &value, 0..=u8::MAX)?;
            } else if key == TOP_SPEED {
                // At most 65,535.
                let speed = number(&key, &value, 0.0..=65.535)?;
                settings.belief.insert(belief).top_speed_mm_s = (1e3 * speed).ceil() as u16;
            } else if key == ALONE {
                settings.alone = Some(flag(&key, Some(&value), false)?);
            } else if key == VOTES {
                settings.belief.insert(belief).votes = choice(&key, Some(&value), &VOTING)?;
            } else {
                let names =
                    PLANNED.iter().map(|(name, _)| *name).chain([SEED]).chain(BELIEVED.iter().map(|(name, _)| *name));
                let names: Vec<_> =
                    names.chain(COUNTED.iter().map(|(name, _)| *name)).chain([TOP_SPEED, ALONE, VOTES]).collect();
                return Err(EerufError::new_err(format!(
                    "no setting {key} of flow; expected one of {}",
                    names.join(", ")
                )));
            }
        }
        Ok(settings)
    }

    /// Settings of belief.
    pub(crate) fn belief(&self) -> BeliefSettings {
        BeliefSettings { alone: self.alone.unwrap_or(false), ..self.belief.unwrap_or_default() }
    }

    /// Returns these belief settings, or else the ring file's.
    pub(crate) fn belief_over(&self, file: BeliefSettings) -> BeliefSettings {
        BeliefSettings { alone: self.alone.unwrap_or(file.alone), ..self.belief.unwrap_or(file) }
    }

    /// Returns these settings of the plan, completed by the ring file's.
    pub(crate) fn turns_over(&self, file: TurnSettings) -> TurnSettings {
        let mut turns = TurnSettings { seed: self.drawn_seed(), ..file };
        turns.least = self.least.unwrap_or(turns.least);
        turns.most = self.most.unwrap_or(turns.most);
        turns.rest = self.rest.unwrap_or(turns.rest);
        turns.dice = self.dice.unwrap_or(turns.dice);
        turns
    }

    /// The seed of the random gaps. Robots with the same program must not draw the same gaps.
    pub(crate) fn drawn_seed(&self) -> u32 {
        self.seed.unwrap_or_else(|| RandomState::new().hash_one(0) as u32 | 1)
    }

    /// Returns the settings of a method; the scene gives the rest.
    pub(crate) fn options(&self) -> PyResult<FlowOptions> {
        let &Self { least, most, rest, dice, seed, alone, belief } = self;
        let expected = "none for a method: its scene says it";
        match (seed, alone) {
            (Some(seed), _) => return Err(wrong(SEED, seed, expected)),
            (_, Some(alone)) => return Err(wrong(ALONE, if alone { "True" } else { "False" }, expected)),
            (None, None) => {}
        }
        let mut options = FlowOptions::default();
        (options.least, options.most, options.rest, options.dice) = (least, most, rest, dice);
        options.belief = belief;
        Ok(options)
    }

    /// The turn settings of a ring whose sensors listen for `window`, and whose sound is heard for `reach` if known.
    pub(crate) fn turns(&self, window: Micros, blanking: Micros, reach: Option<Micros>) -> PyResult<TurnSettings> {
        if let (Some(reach), Some(_)) = (reach, self.most) {
            return Err(wrong("reach_us", reach.as_micros(), "none beside the setting most_us, which says the same"));
        }
        // Long enough for the tail of the sound.
        let tail = Micros::new(window.as_micros() / 9 * 2);
        let rest = self.rest.unwrap_or_else(|| REST.max(window.saturating_add(tail)));
        let mut turns = TurnSettings::for_module(self.drawn_seed(), window, rest, blanking);
        turns.most = self.most.or(reach).unwrap_or(turns.most);
        turns.least = self.least.unwrap_or(Micros::new(turns.most.as_micros() / 11 * 2));
        turns.dice = self.dice.unwrap_or(turns.dice);
        Ok(turns)
    }
}
