//! Ways of firing compared by their cost, as text.

use std::fmt::Write as _;

use eeruf_design::{BestWay, CostAnswer, KindCost};
use eeruf_sim::experiments::measure::Estimate;

use super::table::{markdown, or_dash};

/// Formats the table of costs, the best way under each condition, and the recommendation.
pub(crate) fn describe(answer: &CostAnswer) -> String {
    let CostAnswer { recommended, draw, speed_m_s, turn_deg_s, kinds, elsewhere, .. } = answer;
    let conditions = kinds.iter().map(|kind| &kind.best).max_by_key(|best| best.len());
    let mut header = vec!["kind", "cost"];
    header.extend(conditions.into_iter().flatten().map(|best| best.condition));
    let cell = |best: &BestWay| {
        let BestWay { way, votes, keeps, figures, .. } = best;
        let t95 = figures.t95_ms.value;
        let t95 = if t95.is_finite() { format!("{t95:.0} ms") } else { "never".to_owned() };
        let stops =
            if *keeps { String::new() } else { format!(", {:.1} stops/min", figures.false_stops_per_min.value) };
        format!("{t95} ({way} {votes}{stops})")
    };
    let row = |KindCost { kind, cost, best }: &KindCost| {
        let with_interval =
            |Estimate { value, interval_95: [low, high] }: Estimate| format!("{value:.2} ({low:.2}..{high:.2})");
        let cells = best.iter().map(cell);
        [kind.clone(), or_dash(*cost, with_interval)].into_iter().chain(cells).collect::<Vec<_>>()
    };
    let mut text = format!(
        "By the time in which 95 of 100 things that appear are seen (t95), driving at {speed_m_s} m/s and turning at \
         {turn_deg_s} degrees/s:\n\n{}\n\n",
        markdown(&header, kinds.iter().map(row))
    );
    let draw = draw.as_ref().map_or(String::new(), |other| format!("; {other} is not surely better"));
    _ = match recommended {
        Some(kind) => writeln!(text, "Least cost: {kind}{draw}."),
        None => writeln!(text, "No kind of way has at most one false stop a minute under each condition."),
    };
    let other = elsewhere.iter().filter(|(_, kind)| kind != recommended);
    let other = other.map(|(condition, kind)| format!("{condition}: {}", kind.as_deref().unwrap_or("none")));
    let other: Vec<_> = other.collect();
    if !other.is_empty() {
        _ = writeln!(text, "Under one condition alone it would be another: {}.", other.join("; "));
    }
    text.push('\n');
    text
}
