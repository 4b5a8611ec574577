//! A diagnosis as JSON. Sensors count from 0, shares are fractions of 1 with their 95 % intervals.

use eeruf_logs::Share;
use serde_json::{Value, json as object};

use super::DiagnosisReport;

/// Output of `--json`.
pub(crate) fn json(found: &DiagnosisReport<'_>) -> Value {
    let diagnosis = found.diagnosis;
    let paths: Vec<_> = diagnosis
        .paths
        .iter()
        .map(|path| {
            object!({
                "sender": path.sender, "receiver": path.receiver,
                "travel_us": path.travel_us, "travel_error_us": path.travel_error_us,
                "length_m": found.length_m(path), "scatter_us": path.scatter_us,
                "readings": path.readings, "heard": path.heard,
                "first_period": path.periods.0, "last_period": path.periods.1,
                "offsets": path.offsets.0, "of_offsets": path.offsets.1, "accidents": path.accidents,
            })
        })
        .collect();
    let hearing: Vec<_> = diagnosis
        .hearing
        .iter()
        .map(|of| {
            object!({
                "sensor": of.sensor, "echoes": share(of.echoes), "own": share(of.own), "foreign": share(of.foreign),
                "unnamed": share(of.unnamed),
                "unexplained": share(of.unexplained), "has_own_path": of.has_own_path,
                "blind_phases": of.blind_phases.iter().map(|phase| phase.0).collect::<Vec<_>>(),
            })
        })
        .collect();
    let faults = diagnosis
        .faults
        .iter()
        .map(|fault| object!({"kind": fault.symptom.as_str(), "sensors": [fault.sensor], "said": fault.said}));
    let faults: Vec<_> = faults.collect();
    let timing = found.timing.map(|timing| {
        object!({
            "drift_ppm": timing.drift_ppm, "drift_error_ppm": timing.drift_error_ppm,
            "jitter_us": timing.jitter_us, "late_99_us": timing.late_99_us,
        })
    });
    object!({
        "clock": found.log.clock, "firings": found.log.firings.len(), "phases": found.phases(),
        "rejected": found.rejected().map(|(rejected, _)| rejected),
        "rejected_foreign": found.rejected().map(|(_, named)| named),
        "most_offsets": diagnosis.most_offsets, "moved": diagnosis.moved,
        "silent": diagnosis.silent(), "tolerance_us": found.tolerance_us,
        "paths": paths, "sensors": hearing, "faults": faults, "timing": timing,
        "advice": found.advice(),
    })
}

fn share(share: Share) -> Value {
    let (low, high) = share.interval_95();
    object!({"value": share.value(), "low": low, "high": high, "count": share.count, "of": share.of})
}
