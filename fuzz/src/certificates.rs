//! Certificates: none that passes is wrong. Trying all firing times judges those that are small enough.

#[path = "../../crates/eeruf-period/tests/common/mod.rs"]
#[allow(unreachable_pub)]
mod judge;

use eeruf_period::engine::prove::{NoProof, prove};

use crate::one_line;

/// Number of schedules that are tried at most for one period.
const MOST: u32 = 20_000;

/// Checks the text, and where a certificate passes, what it claims.
pub fn check(bytes: &[u8]) {
    let Ok(text) = str::from_utf8(bytes) else { return };
    let certified = match eeruf_check::check(text) {
        Ok(certified) => certified,
        Err(error) => {
            let lines = text.split('\n').count() + 1;
            assert!((1..=lines).contains(&error.line), "{error}");
            return one_line(&error.to_string());
        }
    };
    one_line(&certified.to_string());
    let certified = certified.claim;
    assert_eq!(eeruf_check::read_claim(text).as_ref(), Ok(&certified));
    let claim = judge::claim_of(&certified);
    let sensors = claim.problem.sensors() as u32;
    let small = claim.bound.checked_pow(2 * sensors).is_some_and(|schedules| schedules <= MOST);
    // Times that are no whole ticks are not tried.
    if small && claim.period <= 40 {
        for period in 1..claim.bound {
            assert_eq!(
                judge::feasible(&claim.problem, period),
                None,
                "a period of {period} ticks, shorter than proven"
            );
        }
    }
    if small {
        // The engine finds a proof of what the checker lets pass, or at least no schedule that refutes it.
        match prove(&claim, 2_000) {
            Ok(text) => assert_eq!(eeruf_check::check(&text).map(|again| again.claim), Ok(certified)),
            Err(error) => assert!(!matches!(error, NoProof::Feasible(_)), "{error:?}: {text}"),
        }
    }
}
