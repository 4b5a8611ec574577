//! `MAVLink` 2: `DISTANCE_SENSOR` for each sensor, and the `HEARTBEAT` by which others know of us.
//!
//! Messages and numbers: <https://mavlink.io/en/messages/common.html>; frames:
//! <https://mavlink.io/en/guide/serialization.html>.

use std::net::{SocketAddr, ToSocketAddrs, UdpSocket};
use std::time::Instant;

use crc::{CRC_16_MCRF4XX, Crc};

use crate::parameters::Parameters;
use crate::range::{Distance, Scale};

const CRC: Crc<u16> = Crc::<u16>::new(&CRC_16_MCRF4XX);

/// A message's number, and the byte by which sender and receiver know that they mean the same fields.
type Kind = (u32, u8);
const HEARTBEAT: Kind = (0, 50);
const DISTANCE_SENSOR: Kind = (132, 85);

const MAV_TYPE_ONBOARD_CONTROLLER: u8 = 18;
const MAV_AUTOPILOT_INVALID: u8 = 8;
const MAV_STATE_ACTIVE: u8 = 4;
const MAVLINK_VERSION: u8 = 3;
const MAV_DISTANCE_SENSOR_ULTRASOUND: u8 = 1;
/// `MAV_SENSOR_ROTATION_NONE`; the seven that follow are by 45 degrees each, clockwise.
const ROTATIONS: u8 = 8;
const MAV_SENSOR_ROTATION_CUSTOM: u8 = 100;
const COVARIANCE_UNKNOWN: u8 = 255;
const QUALITY_PERFECT: u8 = 100;

/// What is the same in all frames, and counts them.
struct Packer {
    sequence: u8,
    system: u8,
    component: u8,
}

impl Packer {
    /// A frame: zeros at the payload's end are left out.
    fn frame(&mut self, (number, extra): Kind, payload: &[u8]) -> Vec<u8> {
        let kept = payload.iter().rposition(|&byte| byte != 0).map_or(1, |last| last + 1);
        let payload = &payload[..kept];
        // No flags; the payload has at most 255 bytes.
        let mut frame = vec![0xFD, payload.len() as u8, 0, 0, self.sequence, self.system, self.component];
        self.sequence = self.sequence.wrapping_add(1);
        frame.extend(&number.to_le_bytes()[..3]);
        frame.extend(payload);
        let mut digest = CRC.digest();
        digest.update(&frame[1..]);
        digest.update(&[extra]);
        frame.extend(digest.finalize().to_le_bytes());
        frame
    }
}

pub(crate) struct Mavlink {
    socket: UdpSocket,
    to: SocketAddr,
    packer: Packer,
    began: Instant,
    scale: Scale,
    field_of_view_rad: f32,
    /// Clockwise, in degrees.
    yaws: Vec<f32>,
}

impl Mavlink {
    /// To `udp:HOST:PORT`.
    pub(crate) fn open(parameters: &Parameters) -> Result<Self, String> {
        let to = &parameters.mavlink;
        let wrong = |why: &str| format!("mavlink: {to}: {why}; expected udp:HOST:PORT");
        let address = to.strip_prefix("udp:").ok_or_else(|| wrong("not by UDP"))?;
        let mut addresses = address.to_socket_addrs().map_err(|error| wrong(&error.to_string()))?;
        let address = addresses.next().ok_or_else(|| wrong("no such host"))?;
        let any = if address.is_ipv4() { "0.0.0.0:0" } else { "[::]:0" };
        let socket = UdpSocket::bind(any).map_err(|error| wrong(&error.to_string()))?;
        let sensors = parameters.sensors;
        let around = |n: u8| 360.0 / f32::from(sensors) * f32::from(n);
        let yaw = |n: u8| -parameters.yaws_deg.get(usize::from(n)).copied().unwrap_or_else(|| around(n));
        Ok(Self {
            socket,
            to: address,
            packer: Packer { sequence: 0, system: parameters.mavlink_system, component: parameters.mavlink_component },
            began: Instant::now(),
            scale: Scale::new(parameters),
            field_of_view_rad: parameters.field_of_view_rad,
            yaws: (0..sensors).map(yaw).collect(),
        })
    }

    /// Says that we are here; each second.
    pub(crate) fn heartbeat(&mut self) -> std::io::Result<()> {
        let custom_mode = [0; 4];
        let rest = [MAV_TYPE_ONBOARD_CONTROLLER, MAV_AUTOPILOT_INVALID, 0, MAV_STATE_ACTIVE, MAVLINK_VERSION];
        let frame = self.packer.frame(HEARTBEAT, &[&custom_mode[..], &rest].concat());
        self.socket.send_to(&frame, self.to).map(|_| ())
    }

    /// What a sensor says of the world.
    pub(crate) fn distance(&mut self, sensor: u8, distance: Distance) -> std::io::Result<()> {
        // Wraps after 49 days, as the field does.
        let time_boot_ms = self.began.elapsed().as_millis() as u32;
        let payload = self.distance_sensor(sensor, distance, time_boot_ms);
        let frame = self.packer.frame(DISTANCE_SENSOR, &payload);
        self.socket.send_to(&frame, self.to).map(|_| ())
    }

    /// The payload: first the large fields, then the small ones, then what `MAVLink` 2 added.
    fn distance_sensor(&self, sensor: u8, distance: Distance, time_boot_ms: u32) -> Vec<u8> {
        let centimetres = |metres: f32| (100.0 * metres).round() as u16;
        let (least, most) = (centimetres(self.scale.min_m), centimetres(self.scale.max_m));
        let current = match distance {
            Distance::At(metres) => centimetres(metres).clamp(least, most),
            // More than the maximum is what flight controllers take for nothing.
            Distance::Clear => most.saturating_add(1),
            // Less than the minimum they take for nothing, too; but something is there.
            Distance::TooClose => least,
        };
        let yaw = self.yaws.get(usize::from(sensor)).copied().unwrap_or_default();
        let eighth = (yaw / 45.0).round();
        let (orientation, quaternion) = if (yaw - 45.0 * eighth).abs() < 0.5 {
            (eighth.rem_euclid(f32::from(ROTATIONS)) as u8, [0.0; 4])
        } else {
            let (sin, cos) = (yaw.to_radians() / 2.0).sin_cos();
            (MAV_SENSOR_ROTATION_CUSTOM, [cos, 0.0, 0.0, sin])
        };
        let mut payload = time_boot_ms.to_le_bytes().to_vec();
        payload.extend([least, most, current].iter().flat_map(|field| field.to_le_bytes()));
        payload.extend([MAV_DISTANCE_SENSOR_ULTRASOUND, sensor, orientation, COVARIANCE_UNKNOWN]);
        payload.extend([self.field_of_view_rad; 2].iter().flat_map(|field| field.to_le_bytes()));
        payload.extend(quaternion.iter().flat_map(|field| field.to_le_bytes()));
        payload.push(QUALITY_PERFECT);
        payload
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sensor_between_the_named_rotations_is_sent_with_a_quaternion() {
        let parameters = Parameters {
            sensors: 3,
            mavlink: "udp:127.0.0.1:14550".to_owned(),
            // Counter-clockwise.
            yaws_deg: vec![90.0, -30.0, 359.9],
            ..Parameters::default()
        };
        let mavlink = Mavlink::open(&parameters).unwrap();
        let faced = |sensor| {
            let payload = mavlink.distance_sensor(sensor, Distance::At(1.0), 7);
            assert_eq!(payload.len(), 39);
            let number =
                |at: usize| f32::from_le_bytes([payload[at], payload[at + 1], payload[at + 2], payload[at + 3]]);
            (payload[12], [22, 26, 30, 34].map(number))
        };
        assert_eq!(faced(0), (6, [0.0; 4]));
        // 30 degrees clockwise about the axis that points down.
        assert_eq!(faced(1), (100, [15.0_f32.to_radians().cos(), 0.0, 0.0, 15.0_f32.to_radians().sin()]));
        assert_eq!(faced(2), (0, [0.0; 4]));
    }

    #[test]
    fn what_is_no_address_is_named() {
        let wrong = |mavlink: &str| {
            let parameters = Parameters { mavlink: mavlink.to_owned(), ..Parameters::default() };
            Mavlink::open(&parameters).err().unwrap()
        };
        assert_eq!(wrong("serial:/dev/ttyS0"), "mavlink: serial:/dev/ttyS0: not by UDP; expected udp:HOST:PORT");
        assert!(wrong("udp:127.0.0.1").ends_with("expected udp:HOST:PORT"));
    }
}
