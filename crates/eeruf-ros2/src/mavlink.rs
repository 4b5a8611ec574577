//! `MAVLink` 2: `OBSTACLE_DISTANCE` of the whole ring, `DISTANCE_SENSOR` for sensors that a named rotation stands for,
//! and the `HEARTBEAT` by which others know of us. What autopilots make of them: `docs/how-to/autopilots.md`.
//!
//! Messages and numbers: <https://mavlink.io/en/messages/common.html>; frames:
//! <https://mavlink.io/en/guide/serialization.html>.

use std::net::{SocketAddr, ToSocketAddrs, UdpSocket};
use std::time::Instant;

use crc::{CRC_16_MCRF4XX, Crc};

use crate::parameters::{Parameters, UnansweredAs};
use crate::range::{Distance, Scale};
use crate::view::View;

const CRC: Crc<u16> = Crc::<u16>::new(&CRC_16_MCRF4XX);

/// A message's number, and the byte by which sender and receiver know that they mean the same fields.
type Kind = (u32, u8);
const HEARTBEAT: Kind = (0, 50);
const DISTANCE_SENSOR: Kind = (132, 85);
const OBSTACLE_DISTANCE: Kind = (330, 23);

const MAV_TYPE_ONBOARD_CONTROLLER: u8 = 18;
const MAV_AUTOPILOT_INVALID: u8 = 8;
const MAV_STATE_ACTIVE: u8 = 4;
const MAVLINK_VERSION: u8 = 3;
const MAV_DISTANCE_SENSOR_ULTRASOUND: u8 = 1;
const MAV_FRAME_BODY_FRD: u8 = 12;
/// `MAV_SENSOR_ROTATION_NONE`; the seven that follow are by 45 degrees each, clockwise.
const ROTATIONS: f32 = 8.0;
const COVARIANCE_UNKNOWN: u8 = 255;
const QUALITY_PERFECT: u8 = 100;

/// The sectors of `OBSTACLE_DISTANCE`, each five degrees wide.
const SECTORS: usize = 72;
const SECTOR_DEG: f32 = 5.0;
/// The middle of the first sector, clockwise from ahead. ArduPilot divides the circle into eight faces of 45 degrees
/// and keeps the last run of sectors in each: the array begins where a face does, so that no face has two runs.
const FIRST_SECTOR_DEG: f32 = -20.0;
/// A sensor covers this much to each side at least: PX4 reads every second sector.
const LEAST_HALF_VIEW_DEG: f32 = SECTOR_DEG;
/// Nothing is known of the sector.
const UNKNOWN: u16 = u16::MAX;

/// Fields that are the same in all frames, and their count.
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
    unanswered_as: UnansweredAs,
    /// Clockwise, in degrees.
    yaws: Vec<f32>,
    /// The named rotation of each sensor that has one to itself.
    rotations: Vec<Option<u8>>,
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
        let yaws: Vec<f32> = (0..sensors).map(yaw).collect();
        Ok(Self {
            socket,
            to: address,
            packer: Packer { sequence: 0, system: parameters.mavlink_system, component: parameters.mavlink_component },
            began: Instant::now(),
            scale: Scale::new(parameters),
            field_of_view_rad: parameters.field_of_view_rad,
            unanswered_as: parameters.mavlink_unanswered_as,
            rotations: (0..yaws.len()).map(|sensor| rotation(&yaws, sensor)).collect(),
            yaws,
        })
    }

    /// Says that we are here; each second.
    pub(crate) fn heartbeat(&mut self) -> std::io::Result<()> {
        let custom_mode = [0; 4];
        let rest = [MAV_TYPE_ONBOARD_CONTROLLER, MAV_AUTOPILOT_INVALID, 0, MAV_STATE_ACTIVE, MAVLINK_VERSION];
        let frame = self.packer.frame(HEARTBEAT, &[&custom_mode[..], &rest].concat());
        self.socket.send_to(&frame, self.to).map(|_| ())
    }

    /// Sends a sensor's distance, if it has a named rotation to itself.
    pub(crate) fn distance(&mut self, sensor: u8, distance: Distance) -> std::io::Result<()> {
        let Some(&Some(rotation)) = self.rotations.get(usize::from(sensor)) else { return Ok(()) };
        // Wraps after 49 days, as the field does.
        let time_boot_ms = self.began.elapsed().as_millis() as u32;
        let payload = self.distance_sensor(sensor, rotation, distance, time_boot_ms);
        let frame = self.packer.frame(DISTANCE_SENSOR, &payload);
        self.socket.send_to(&frame, self.to).map(|_| ())
    }

    /// Sends what each sensor sees, in their order. While none sees anything nothing is sent: both autopilots then find
    /// after half a second that they have no data.
    pub(crate) fn picture(&mut self, views: &[(View, f32)]) -> std::io::Result<()> {
        if !views.iter().any(|(view, _)| matches!(view, View::Sees(_))) {
            return Ok(());
        }
        let time_us = self.began.elapsed().as_micros() as u64;
        let payload = self.obstacle_distance(views, time_us);
        let frame = self.packer.frame(OBSTACLE_DISTANCE, &payload);
        self.socket.send_to(&frame, self.to).map(|_| ())
    }

    /// The least and the greatest distance, in centimetres.
    fn limits(&self) -> [u16; 2] {
        [self.scale.min_m, self.scale.max_m].map(centimetres)
    }

    fn centimetres_of(&self, distance: Distance) -> u16 {
        let [least, most] = self.limits();
        match distance {
            Distance::At(metres) => centimetres(metres).clamp(least, most),
            // More than the maximum is what flight controllers take for nothing.
            Distance::Clear => most.saturating_add(1),
            // Less than the minimum they take for nothing, too; but something is there.
            Distance::TooClose => least,
        }
    }

    /// The payload: first the large fields, then the small ones, then what `MAVLink` 2 added.
    fn distance_sensor(&self, sensor: u8, rotation: u8, distance: Distance, time_boot_ms: u32) -> Vec<u8> {
        let [least, most] = self.limits();
        let mut payload = time_boot_ms.to_le_bytes().to_vec();
        payload.extend([least, most, self.centimetres_of(distance)].iter().flat_map(|field| field.to_le_bytes()));
        payload.extend([MAV_DISTANCE_SENSOR_ULTRASOUND, sensor, rotation, COVARIANCE_UNKNOWN]);
        payload.extend([self.field_of_view_rad; 2].iter().flat_map(|field| field.to_le_bytes()));
        // The quaternion is for rotations without a name.
        payload.extend([0; 16]);
        payload.push(QUALITY_PERFECT);
        payload
    }

    fn obstacle_distance(&self, views: &[(View, f32)], time_us: u64) -> Vec<u8> {
        let mut payload = time_us.to_le_bytes().to_vec();
        let sectors = self.sectors(views);
        payload.extend(sectors.iter().chain(&self.limits()).flat_map(|field| field.to_le_bytes()));
        payload.extend([MAV_DISTANCE_SENSOR_ULTRASOUND, SECTOR_DEG as u8]);
        payload.extend([SECTOR_DEG, FIRST_SECTOR_DEG].iter().flat_map(|field| field.to_le_bytes()));
        payload.push(MAV_FRAME_BODY_FRD);
        payload
    }

    /// The distance of each sector. Where views overlap, the nearest obstacle counts, then what is not known, and a
    /// sector is clear only if all of its sensors say so.
    fn sectors(&self, views: &[(View, f32)]) -> [u16; SECTORS] {
        let half_view = (self.field_of_view_rad.to_degrees() / 2.0).max(LEAST_HALF_VIEW_DEG) + 1e-3;
        let clear = self.centimetres_of(Distance::Clear);
        let mut sectors = [None::<u16>; SECTORS];
        for (&yaw, &(view, _)) in self.yaws.iter().zip(views) {
            let said = match (view, self.unanswered_as) {
                (View::Sees(distance), _) => self.centimetres_of(distance),
                (View::Unanswered, UnansweredAs::Obstacle) => self.centimetres_of(Distance::TooClose),
                (View::Unanswered, UnansweredAs::Unknown) | (View::Unknown, _) => UNKNOWN,
            };
            for (sector, place) in (0_u8..).zip(&mut sectors) {
                let middle = FIRST_SECTOR_DEG + SECTOR_DEG * f32::from(sector);
                if between(middle, yaw) > half_view {
                    continue;
                }
                *place = Some(match *place {
                    Some(other) if other < clear && said < clear => other.min(said),
                    Some(other) if other < clear => other,
                    Some(UNKNOWN) if said == clear => UNKNOWN,
                    _ => said,
                });
            }
        }
        sectors.map(|said| said.unwrap_or(UNKNOWN))
    }
}

fn centimetres(metres: f32) -> u16 {
    (100.0 * metres).round() as u16
}

/// The angle between two directions, in degrees, 0 to 180.
fn between(one: f32, other: f32) -> f32 {
    let apart = (one - other).rem_euclid(360.0);
    apart.min(360.0 - apart)
}

/// The named rotation of a sensor. None if it looks elsewhere, or if another sensor looks into the same 45 degrees:
/// `ArduPilot` keeps one distance for them, and each `DISTANCE_SENSOR` would replace what `OBSTACLE_DISTANCE` said.
fn rotation(yaws: &[f32], sensor: usize) -> Option<u8> {
    let eighth = (yaws.get(sensor)? / 45.0).round();
    let named = |yaw| between(yaw, 45.0 * eighth);
    let alone = yaws.iter().enumerate().all(|(other, &yaw)| other == sensor || named(yaw) > 22.5);
    (alone && named(*yaws.get(sensor)?) < 0.5).then_some(eighth.rem_euclid(ROTATIONS) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn opened(given: Parameters) -> Mavlink {
        Mavlink::open(&Parameters { mavlink: "udp:127.0.0.1:14550".to_owned(), ..given }).unwrap()
    }

    /// The sector whose middle looks there, clockwise from ahead.
    fn sector(deg: f32) -> usize {
        ((deg - FIRST_SECTOR_DEG) / SECTOR_DEG).rem_euclid(SECTORS as f32) as usize
    }

    #[test]
    fn rotation_is_sent_only_if_named_and_alone() {
        let rotations = |yaws_deg: &[f32]| {
            let sensors = yaws_deg.len() as u8;
            opened(Parameters { sensors, yaws_deg: yaws_deg.to_vec(), ..Parameters::default() }).rotations
        };
        // Counter-clockwise is given, clockwise sent.
        assert_eq!(rotations(&[90.0, -30.0, 359.9, 180.0]), [Some(6), None, Some(0), Some(4)]);
        assert_eq!(rotations(&[0.0, 22.5, 45.0]), [None, None, None]);
        assert_eq!(rotations(&[-45.0, -67.6]), [Some(1), None]);
        let around = |sensors| opened(Parameters { sensors, ..Parameters::default() }).rotations;
        assert_eq!(around(8).into_iter().flatten().collect::<Vec<_>>(), [0, 7, 6, 5, 4, 3, 2, 1]);
        assert_eq!(around(12).into_iter().flatten().collect::<Vec<_>>(), [0, 6, 4, 2]);
        assert!(around(16).iter().all(Option::is_none));
    }

    #[test]
    fn sectors_hold_the_nearest_then_the_unknown_then_clear() {
        use Distance::{At, Clear, TooClose};
        // Two sensors ahead share the sector straight ahead, and one looks back.
        let parameters = |mavlink_unanswered_as| Parameters {
            sensors: 3,
            yaws_deg: vec![10.0, -10.0, 180.0],
            mavlink_unanswered_as,
            ..Parameters::default()
        };
        let said = |unanswered_as, left, right| {
            let mavlink = opened(parameters(unanswered_as));
            let sectors = mavlink.sectors(&[left, right, View::Sees(TooClose)].map(|view| (view, 0.0)));
            assert_eq!((sectors[sector(180.0)], sectors[sector(170.0)], sectors[sector(160.0)]), (2, 2, UNKNOWN));
            [-10.0, 0.0, 10.0].map(|deg| sectors[sector(deg)])
        };
        let (clear, near, far) = (View::Sees(Clear), View::Sees(At(1.0)), View::Sees(At(3.0)));
        let obstacle = |left, right| said(UnansweredAs::Obstacle, left, right);
        assert_eq!(obstacle(near, far), [100, 100, 300]);
        assert_eq!(obstacle(far, near), [300, 100, 100]);
        assert_eq!(obstacle(clear, clear), [401, 401, 401]);
        for (one, other) in [(clear, View::Unknown), (View::Unknown, clear)] {
            assert_eq!(obstacle(one, other)[1], UNKNOWN);
        }
        assert_eq!(obstacle(near, View::Unknown), [100, 100, UNKNOWN]);
        assert_eq!(obstacle(View::Unknown, near), [UNKNOWN, 100, 100]);
        assert_eq!(obstacle(clear, View::Unanswered), [401, 2, 2]);
        assert_eq!(said(UnansweredAs::Unknown, clear, View::Unanswered), [401, UNKNOWN, UNKNOWN]);
        assert_eq!(said(UnansweredAs::Unknown, View::Unanswered, near), [UNKNOWN, 100, 100]);
    }

    #[test]
    fn narrow_beams_reach_the_sectors_that_px4_reads() {
        for yaw in 0_u16..360 {
            let yaws_deg = vec![f32::from(yaw)];
            let mavlink = opened(Parameters { sensors: 1, yaws_deg, field_of_view_rad: 0.01, ..Parameters::default() });
            let sectors = mavlink.sectors(&[(View::Sees(Distance::At(1.0)), 0.0)]);
            assert!(sectors.iter().step_by(2).any(|&said| said == 100), "{yaw} degrees");
        }
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
