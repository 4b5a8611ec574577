//! Shares in per cent.

use eeruf_sim::experiments::Spread;

use super::table::or_dash;

/// Formats a share in per cent, with one decimal below ten.
pub(crate) fn percent(share: f64) -> String {
    let digits = usize::from(share < 0.0995);
    format!("{:.digits$}", 100.0 * share)
}

/// Formats a share in per cent with one, two or three decimals, more for smaller shares.
pub(crate) fn fine_percent(share: f64) -> String {
    let digits = match share {
        _ if share > 0.0 && share < 0.000_95 => 3,
        _ if share < 0.095 => 2,
        _ => 1,
    };
    format!("{:.digits$}", 100.0 * share)
}

/// Formats 10 %, median and 90 % of shares, in per cent.
pub(crate) fn percents(spread: Option<Spread>) -> String {
    or_dash(spread, |Spread { p10, median, p90, .. }| {
        format!("{} / {} / {}", percent(p10), percent(median), percent(p90))
    })
}

/// Formats median and 90 % of shares, in per cent, each with its 95 % interval.
pub(crate) fn percents_95(spread: Option<Spread>) -> String {
    let with = |value, [low, high]: [f64; 2]| {
        format!("{} ({}-{})", fine_percent(value), fine_percent(low), fine_percent(high))
    };
    or_dash(spread, |of| format!("{}, {}", with(of.median, of.median_95), with(of.p90, of.p90_95)))
}

/// Formats the median with its 95 % interval.
pub(crate) fn median_95(spread: Option<Spread>, digits: usize) -> String {
    or_dash(spread, |Spread { median, median_95: [low, high], .. }| {
        format!("{median:.digits$} ({low:.digits$}-{high:.digits$})")
    })
}

/// Formats the mean with its 95 % interval.
pub(crate) fn mean_95(spread: Option<Spread>, scale: f64, digits: usize) -> String {
    or_dash(spread, |Spread { mean, mean_95: [low, high], .. }| {
        format!("{:.digits$} ({:.digits$}-{:.digits$})", scale * mean, scale * low, scale * high)
    })
}

/// Formats the median.
pub(crate) fn median(spread: Option<Spread>, digits: usize) -> String {
    or_dash(spread, |spread| format!("{:.digits$}", spread.median))
}
