//! The pilots that a search found, one for each method, as `cargo lab tune` of commit 554cf2c9 printed them: change
//! none by hand.
//!
//! 48 pilots on courses 0 to 7,
//! the best 12 on courses 8 to 31,
//! the best 4 on courses 32 to 103. The best is taken.
//! Every course is driven alone, with a second robot behind, and with one ahead.

use crate::methods::Method;
use crate::navigation::{Piloting, tuned};

/// Smoothing, threshold, width of a wide valley, highest density, rate of turn in degrees/s, gain, range
/// in metres, growth rate operator; of the last 72 courses how many were finished alone, behind and
/// ahead.
#[rustfmt::skip]
pub(super) const OWN: [(Method, Piloting); 13] = [
    (Method::Simultaneous, tuned(4, 0.18, 14, 2.2, 230.0, 1.9, 1.55, false)), // 62, 65, 45
    (Method::Sequential, tuned(5, 0.071, 14, 1.3, 380.0, 2.6, 2.55, true)), // 66, 62, 58
    (Method::FarGroups, tuned(6, 0.19, 24, 0.67, 330.0, 2.2, 3.3, false)), // 72, 69, 66
    (Method::Dither, tuned(3, 0.02, 12, 0.47, 330.0, 2.4, 2.2, false)), // 72, 70, 64
    (Method::Conventional, tuned(4, 0.18, 14, 2.2, 230.0, 1.9, 1.55, false)), // 65, 61, 58
    (Method::Comparison, tuned(4, 0.18, 14, 2.2, 230.0, 1.9, 1.55, false)), // 66, 55, 35
    (Method::Median, tuned(4, 0.18, 14, 2.2, 230.0, 1.9, 1.55, false)), // 60, 61, 46
    (Method::EerufImmediate, tuned(3, 0.02, 12, 0.47, 330.0, 2.4, 2.2, false)), // 71, 70, 65
    (Method::Eeruf, tuned(3, 0.02, 12, 0.47, 330.0, 2.4, 2.2, false)), // 71, 70, 62
    (Method::EerufBest, tuned(4, 0.047, 16, 0.7, 250.0, 2.7, 1.9, true)), // 70, 69, 69
    (Method::Adaptive, tuned(1, 0.011, 15, 0.12, 320.0, 1.9, 3.2, true)), // 69, 62, 49
    (Method::Flow, tuned(4, 0.015, 19, 0.25, 100.0, 2.6, 1.45, true)), // 72, 71, 70
    (Method::MultiEcho, tuned(2, 0.1, 21, 0.37, 270.0, 4.7, 1.3, true)), // 72, 72, 72
];
