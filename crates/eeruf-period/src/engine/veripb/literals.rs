//! The 0-1 variables of the model and their names in its file.

use core::fmt;

/// A 0-1 variable. Sensors are those of the merged problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) enum Variable {
    /// One summand of a firing time: phase, sensor, number of the summand.
    Bit(usize, usize, usize),
    /// `d_x` is at least this many ticks.
    D(usize, i32),
    /// `|d_x|` is at least this many ticks.
    Size(usize, i32),
    /// In this phase the first sensor fires before the second, which has the higher number.
    Order(usize, usize, usize),
    /// `|d|` of the first sensor is below that of the second, which has the higher number.
    Rank(usize, usize),
}

/// A variable, or its opposite.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Literal {
    pub(crate) variable: Variable,
    pub(crate) is_true: bool,
}

/// The truth of a literal, where the bounds of the model may settle it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Truth {
    Always,
    Never,
    If(Literal),
}

impl Variable {
    pub(crate) fn is_true(self) -> Literal {
        Literal { variable: self, is_true: true }
    }
}

impl core::ops::Not for Literal {
    type Output = Self;

    fn not(self) -> Self {
        Self { is_true: !self.is_true, ..self }
    }
}

impl core::ops::Not for Truth {
    type Output = Self;

    fn not(self) -> Self {
        match self {
            Self::Always => Self::Never,
            Self::Never => Self::Always,
            Self::If(literal) => Self::If(!literal),
        }
    }
}

/// In this phase x fires before y.
pub(crate) fn before(phase: usize, x: usize, y: usize) -> Literal {
    Literal { variable: Variable::Order(phase, x.min(y), x.max(y)), is_true: x < y }
}

/// `|d_x| < |d_y|`.
pub(crate) fn below(x: usize, y: usize) -> Literal {
    Literal { variable: Variable::Rank(x.min(y), x.max(y)), is_true: x < y }
}

impl fmt::Display for Variable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Bit(phase, x, bit) => write!(f, "{}{x}_{bit}", ["a", "b"][phase]),
            Self::D(x, v) if v < 0 => write!(f, "d{x}_m{}", -v),
            Self::D(x, v) => write!(f, "d{x}_{v}"),
            Self::Size(x, v) => write!(f, "s{x}_{v}"),
            Self::Order(phase, x, y) => write!(f, "{}{x}_{y}", ["oa", "ob"][phase]),
            Self::Rank(x, y) => write!(f, "r{x}_{y}"),
        }
    }
}

impl fmt::Display for Literal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", if self.is_true { "" } else { "~" }, self.variable)
    }
}

/// `sum of coefficient * literal >= least`, as it stands in a file.
pub(crate) fn inequality(terms: &[(i32, Literal)], least: i32) -> String {
    let sum: String = terms.iter().map(|(coefficient, literal)| format!("{coefficient:+} {literal} ")).collect();
    format!("{sum}>= {least}")
}

/// One of them holds; `None` if one always does.
pub(crate) fn clause(cases: &[Truth]) -> Option<String> {
    let mut terms = Vec::new();
    for case in cases {
        match case {
            Truth::Always => return None,
            Truth::Never => {}
            Truth::If(literal) => terms.push((1, *literal)),
        }
    }
    Some(inequality(&terms, 1))
}
