//! Joins a domain, with a port for acknowledgements that belongs to this node.

use std::env;
use std::net::{IpAddr, Ipv4Addr, UdpSocket};

use ros2_client::dds::rustdds::{DomainParticipant, DomainParticipantBuilder};

/// Largest number of participant numbers that are skipped; the next one is used in any case.
const ATTEMPTS: usize = 10;

/// Joins a domain; only on this machine if `ROS_LOCALHOST_ONLY` is 1 or `ROS_AUTOMATIC_DISCOVERY_RANGE` is `LOCALHOST`.
///
/// `RustDDS` 0.15 takes the first number whose port for discovery is free. If another participant on this machine holds
/// that number's port for user traffic, as Fast DDS may when both start at the same time, `RustDDS` listens elsewhere
/// but still announces that port: acknowledgements go astray, and lost or latched samples never arrive. Such a number
/// is skipped.
pub(super) fn join(domain: u16) -> Result<DomainParticipant, String> {
    let mut passed_over = Vec::new();
    loop {
        let participant = build(domain)?;
        let [discovery, user] = ports(domain, participant.participant_id());
        if passed_over.len() == ATTEMPTS || is_own(user) {
            return Ok(participant);
        }
        drop(participant);
        passed_over.push(UdpSocket::bind((Ipv4Addr::UNSPECIFIED, discovery)));
    }
}

fn build(domain: u16) -> Result<DomainParticipant, String> {
    let mut participant = DomainParticipantBuilder::new(domain);
    let is = |variable: &str, value: &str| env::var(variable).is_ok_and(|set| set == value);
    if is("ROS_LOCALHOST_ONLY", "1") || is("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST") {
        participant = participant.with_only_networks([IpAddr::V4(Ipv4Addr::LOCALHOST)]);
    }
    participant.build().map_err(|error| format!("DDS: {error}"))
}

/// Ports of a participant for discovery and for user traffic (RTPS 2.5, 9.6.2.3). Domains end at 232.
fn ports(domain: u16, participant: u16) -> [u16; 2] {
    let first = 7400 + 250 * domain + 2 * participant;
    [first + 10, first + 11]
}

/// Returns true if a socket of this process has this port, or if that cannot be determined.
#[cfg(target_os = "linux")]
fn is_own(port: u16) -> bool {
    use nix::sys::socket::{SockaddrIn, getsockname};
    let Ok(open) = std::fs::read_dir("/proc/self/fd") else { return true };
    let numbers = open.filter_map(|entry| entry.ok()?.file_name().to_str()?.parse().ok());
    numbers.filter_map(|fd| getsockname::<SockaddrIn>(fd).ok()).any(|address| address.port() == port)
}

/// Returns true, since this system gives no answer.
#[cfg(not(target_os = "linux"))]
fn is_own(_: u16) -> bool {
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ports_are_those_of_the_specification() {
        assert_eq!(ports(0, 0), [7410, 7411]);
        assert_eq!(ports(3, 2), [8164, 8165]);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn port_is_own_while_a_socket_has_it() {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        let port = socket.local_addr().unwrap().port();
        assert!(is_own(port));
        drop(socket);
        assert!(!is_own(port));
    }
}
