//! `MAVLink` 2: `OBSTACLE_DISTANCE` of the whole ring, `DISTANCE_SENSOR` for sensors with a named rotation, and
//! `HEARTBEAT`, `SYS_STATUS` and `STATUSTEXT` to announce the node and failing sensors. How autopilots use these
//! messages: `docs/how-to/autopilots.md`.
//!
//! Messages and numbers: <https://mavlink.io/en/messages/common.html>; frames:
//! <https://mavlink.io/en/guide/serialization.html>.

use std::net::{SocketAddr, ToSocketAddrs, UdpSocket};
use std::time::Instant;

use crc::{CRC_16_MCRF4XX, Crc};
use eeruf_files::rotation;

use crate::fan;
use crate::parameters::{Parameters, UnansweredAs};
use crate::placing::Place;
use crate::range::{Distance, Scale};
use crate::view::View;

const CRC: Crc<u16> = Crc::<u16>::new(&CRC_16_MCRF4XX);

/// A message's number, and the CRC byte that depends on its fields.
type Kind = (u32, u8);
const HEARTBEAT: Kind = (0, 50);
const SYS_STATUS: Kind = (1, 124);
const DISTANCE_SENSOR: Kind = (132, 85);
const STATUSTEXT: Kind = (253, 83);
const OBSTACLE_DISTANCE: Kind = (330, 23);

const MAV_TYPE_ONBOARD_CONTROLLER: u8 = 18;
const MAV_AUTOPILOT_INVALID: u8 = 8;
const MAV_STATE_ACTIVE: u8 = 4;
const MAV_STATE_CRITICAL: u8 = 5;
const MAV_MODE_FLAG_SAFETY_ARMED: u8 = 128;
const MAV_SYS_STATUS_SENSOR_PROXIMITY: u32 = 1 << 25;
const MAV_SEVERITY_CRITICAL: u8 = 2;
/// Longest text of one `STATUSTEXT`.
const TEXT: usize = 50;
const MAVLINK_VERSION: u8 = 3;
const MAV_DISTANCE_SENSOR_ULTRASOUND: u8 = 1;
const MAV_FRAME_BODY_FRD: u8 = 12;
const COVARIANCE_UNKNOWN: u8 = 255;
const QUALITY_PERFECT: u8 = 100;

/// The sectors of `OBSTACLE_DISTANCE`, each five degrees wide.
const SECTORS: usize = 72;
const SECTOR_DEG: f32 = 5.0;
/// The middle of the first sector, clockwise from ahead. ArduPilot divides the circle into eight faces of 45 degrees
/// and keeps the last run of sectors in each: the array starts with a face, so that no face has two runs.
const FIRST_SECTOR_DEG: f32 = -20.0;
/// Least half-width that a sensor covers: PX4 reads every second sector.
const LEAST_HALF_VIEW_DEG: f32 = SECTOR_DEG;
/// Value of a sector that is unknown.
const UNKNOWN: u16 = u16::MAX;

/// The `base_mode` of an autopilot's `HEARTBEAT` in a datagram, of `MAVLink` 1 or 2.
fn base_mode(datagram: &[u8], system: u8) -> Option<u8> {
    let frame = |begin: usize| {
        let frame = &datagram[begin..];
        // The places of the sender's system and of the payload; the message's number follows the component.
        let (of_system, payload) = match frame.first()? {
            0xFD => (5, 10),
            0xFE => (3, 6),
            _ => return None,
        };
        let is_heartbeat = frame.get(1) == Some(&9) && frame.get(of_system + 2..payload)?.iter().all(|&byte| byte == 0);
        let [body @ .., low, high] = frame.get(1..payload + 11)? else { return None };
        let mut digest = CRC.digest();
        digest.update(body);
        digest.update(&[HEARTBEAT.1]);
        let is_whole = digest.finalize().to_le_bytes() == [*low, *high];
        let is_autopilot = frame[of_system] == system && frame[payload + 5] != MAV_AUTOPILOT_INVALID;
        (is_heartbeat && is_whole && is_autopilot).then(|| frame[payload + 6])
    };
    (0..datagram.len()).find_map(frame)
}

/// Fields that all frames share, and the frame count.
struct Packer {
    sequence: u8,
    system: u8,
    component: u8,
}

impl Packer {
    /// Makes a frame, without the zeros at the payload's end.
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
    system: u8,
    /// True if the autopilot's last heartbeat says that it is armed; false before the first.
    armed: bool,
    /// Sensors that did not answer when the ring was last sent.
    failed: Vec<bool>,
    /// True for sensors reported as failed since arming.
    reported: Vec<bool>,
    /// Poses in clockwise order, all at the vehicle's centre.
    places: Vec<Place>,
    /// The named rotation of each sensor; `None` without one, or if another sensor shares it.
    rotations: Vec<Option<u8>>,
}

impl Mavlink {
    /// Opens the connection `udp:HOST:PORT`.
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
        socket.set_nonblocking(true).map_err(|error| wrong(&error.to_string()))?;
        let place = |yaw: &f32| Place { x_m: 0.0, y_m: 0.0, z_m: 0.0, yaw_rad: f64::from(*yaw).to_radians() };
        Ok(Self {
            socket,
            to: address,
            packer: Packer { sequence: 0, system: parameters.mavlink_system, component: parameters.mavlink_component },
            began: Instant::now(),
            scale: Scale::new(parameters),
            field_of_view_rad: parameters.field_of_view_rad,
            unanswered_as: parameters.mavlink_unanswered_as,
            system: parameters.mavlink_system,
            armed: false,
            failed: vec![false; yaws.len()],
            reported: vec![false; yaws.len()],
            rotations: (0..yaws.len()).map(|sensor| rotation(&yaws, sensor)).collect(),
            places: yaws.iter().map(place).collect(),
        })
    }

    fn send(&mut self, kind: Kind, payload: &[u8]) -> std::io::Result<()> {
        let frame = self.packer.frame(kind, payload);
        self.socket.send_to(&frame, self.to).map(|_| ())
    }

    /// Learns from the autopilot's heartbeats whether it is armed.
    fn listen(&mut self) {
        let mut datagram = [0; 2048];
        while let Ok(length) = self.socket.recv(&mut datagram) {
            let Some(mode) = base_mode(&datagram[..length], self.system) else { continue };
            let is_armed = mode & MAV_MODE_FLAG_SAFETY_ARMED != 0;
            if is_armed && !self.armed {
                self.reported.fill(false);
            }
            self.armed = is_armed;
        }
    }

    /// Returns true while a failed sensor holds back the distances, so that the vehicle's proximity check fails.
    fn holds_back(&self) -> bool {
        self.unanswered_as == UnansweredAs::Hold && !self.armed && self.failed.contains(&true)
    }

    /// Sends a heartbeat and the sensors' status, once per second.
    pub(crate) fn heartbeat(&mut self) -> std::io::Result<()> {
        self.listen();
        let is_well = !self.failed.contains(&true);
        let state = if is_well { MAV_STATE_ACTIVE } else { MAV_STATE_CRITICAL };
        let custom_mode = [0; 4];
        let rest = [MAV_TYPE_ONBOARD_CONTROLLER, MAV_AUTOPILOT_INVALID, 0, state, MAVLINK_VERSION];
        self.send(HEARTBEAT, &[&custom_mode[..], &rest].concat())?;
        let proximity = MAV_SYS_STATUS_SENSOR_PROXIMITY;
        // Present, enabled, healthy; load, battery and errors are unknown.
        let sensors = [proximity, proximity, if is_well { proximity } else { 0 }].map(u32::to_le_bytes).concat();
        let battery = [[0xFF; 2], [0xFF; 2]].concat();
        self.send(SYS_STATUS, &[&sensors[..], &[0; 2], &battery, &[0; 12], &[0xFF]].concat())
    }

    /// Sends a sensor's distance, if it has a named rotation of its own.
    pub(crate) fn distance(&mut self, sensor: u8, distance: Distance) -> std::io::Result<()> {
        let Some(&Some(rotation)) = self.rotations.get(usize::from(sensor)) else { return Ok(()) };
        if self.holds_back() {
            return Ok(());
        }
        // Wraps after 49 days, as the field does.
        let time_boot_ms = self.began.elapsed().as_millis() as u32;
        let payload = self.distance_sensor(sensor, rotation, distance, time_boot_ms);
        self.send(DISTANCE_SENSOR, &payload)
    }

    /// Sends the views of all sensors, and names those that do not answer. While no sensor sees anything, or one holds
    /// the others back, no distances are sent: both autopilots notice after half a second that they have no data.
    pub(crate) fn picture(&mut self, views: &[(View, f32)]) -> std::io::Result<()> {
        self.listen();
        self.failed = views.iter().map(|(view, _)| *view == View::Unanswered).collect();
        for sensor in 0..self.failed.len().min(self.reported.len()) {
            if self.failed[sensor] && !std::mem::replace(&mut self.reported[sensor], true) {
                let yaw = self.places[sensor].yaw_rad.to_degrees().rem_euclid(360.0) + 0.0;
                let mut text = format!("eeruf: sensor {} ({yaw:.0} deg) does not answer", sensor + 1);
                text.truncate(TEXT);
                self.send(STATUSTEXT, &[&[MAV_SEVERITY_CRITICAL], text.as_bytes()].concat())?;
            }
        }
        if self.holds_back() || !views.iter().any(|(view, _)| matches!(view, View::Sees(_))) {
            return Ok(());
        }
        let time_us = self.began.elapsed().as_micros() as u64;
        let payload = self.obstacle_distance(views, time_us);
        self.send(OBSTACLE_DISTANCE, &payload)
    }

    /// The least and the greatest distance, in centimetres.
    fn limits(&self) -> [u16; 2] {
        [self.scale.min_m, self.scale.max_m].map(centimetres)
    }

    fn centimetres_of(&self, distance: Distance) -> u16 {
        let [least, most] = self.limits();
        match distance {
            Distance::At(metres) => centimetres(metres).clamp(least, most),
            // Flight controllers take more than the maximum for nothing in range.
            Distance::Clear => most.saturating_add(1),
            // They take less than the minimum for nothing, too, but something is there.
            Distance::TooClose => least,
        }
    }

    /// The payload: first the large fields, then the small ones, then the fields that `MAVLink` 2 added.
    fn distance_sensor(&self, sensor: u8, rotation: u8, distance: Distance, time_boot_ms: u32) -> Vec<u8> {
        let [least, most] = self.limits();
        let mut payload = time_boot_ms.to_le_bytes().to_vec();
        payload.extend([least, most, self.centimetres_of(distance)].iter().flat_map(|field| field.to_le_bytes()));
        payload.extend([MAV_DISTANCE_SENSOR_ULTRASOUND, sensor, rotation, COVARIANCE_UNKNOWN]);
        payload.extend([self.field_of_view_rad; 2].iter().flat_map(|field| field.to_le_bytes()));
        // The quaternion is for custom rotations.
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

    /// The distance of each sector, taken at its middle.
    fn sectors(&self, views: &[(View, f32)]) -> [u16; SECTORS] {
        let half_view_deg = (self.field_of_view_rad.to_degrees() / 2.0).max(LEAST_HALF_VIEW_DEG) + 1e-3;
        let half_view = f64::from(half_view_deg).to_radians();
        let as_obstacle = |&(view, age): &(View, f32)| match (view, self.unanswered_as) {
            (View::Unanswered, UnansweredAs::Obstacle) => (View::Sees(Distance::TooClose), age),
            _ => (view, age),
        };
        let views: Vec<_> = views.iter().map(as_obstacle).collect();
        std::array::from_fn(|sector| {
            let middle = f64::from(FIRST_SECTOR_DEG + SECTOR_DEG * sector as f32).to_radians();
            match fan::along(middle, &self.places, &views, half_view, &self.scale) {
                View::Sees(distance) => self.centimetres_of(distance),
                View::Unanswered | View::Unknown => UNKNOWN,
            }
        })
    }
}

fn centimetres(metres: f32) -> u16 {
    (100.0 * metres).round() as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    fn opened(given: Parameters) -> Mavlink {
        Mavlink::open(&Parameters { mavlink: "udp:127.0.0.1:14550".to_owned(), ..given }).unwrap()
    }

    /// The sector whose middle is nearest to a direction, in degrees clockwise from straight ahead.
    fn sector(deg: f32) -> usize {
        ((deg - FIRST_SECTOR_DEG) / SECTOR_DEG).rem_euclid(SECTORS as f32) as usize
    }

    #[test]
    fn rotation_is_sent_only_if_named_and_alone() {
        let rotations = |yaws_deg: &[f32]| {
            let sensors = yaws_deg.len() as u8;
            opened(Parameters { sensors, yaws_deg: yaws_deg.to_vec(), ..Parameters::default() }).rotations
        };
        // Parameters count counter-clockwise, messages clockwise.
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
        // Two front sensors share the sector straight ahead, and one looks back.
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

    /// Number and payload of each frame that a receiver gets within a short time.
    fn received(receiver: &UdpSocket) -> Vec<(u8, Vec<u8>)> {
        let mut buffer = [0; 512];
        let mut frames = Vec::new();
        while let Ok(length) = receiver.recv(&mut buffer) {
            // OBSTACLE_DISTANCE's number has a second byte.
            frames.push((buffer[7], buffer[10..length - 2].to_vec()));
        }
        frames
    }

    #[test]
    fn failed_sensor_holds_back_before_arming() {
        let receiver = UdpSocket::bind("127.0.0.1:0").unwrap();
        receiver.set_read_timeout(Some(std::time::Duration::from_millis(50))).unwrap();
        let mavlink = format!("udp:{}", receiver.local_addr().unwrap());
        let mut sender = Mavlink::open(&Parameters { mavlink, sensors: 2, ..Parameters::default() }).unwrap();
        let here = SocketAddr::from(([127, 0, 0, 1], sender.socket.local_addr().unwrap().port()));
        let mut autopilot = Packer { sequence: 0, system: 1, component: 1 };
        let mut heartbeat = |system: u8, mode: u8| {
            autopilot.system = system;
            let frame = autopilot.frame(HEARTBEAT, &[0, 0, 0, 0, 2, 3, mode, 4, 3]);
            receiver.send_to(&[&[0xFD, 9], &frame[..]].concat(), here).unwrap();
            std::thread::sleep(std::time::Duration::from_millis(20));
        };
        let [well, cut] = [View::Sees(Distance::Clear), View::Unanswered].map(|view| [(view, 0.0), (well_view(), 0.0)]);
        let numbers = |frames: Vec<(u8, Vec<u8>)>| frames.into_iter().map(|(number, _)| number).collect::<Vec<_>>();
        let sent = |sender: &mut Mavlink, views: [(View, f32); 2]| {
            sender.picture(&views).unwrap();
            sender.distance(1, Distance::Clear).unwrap();
            received(&receiver)
        };
        let (status, obstacles, distance) = (253, (330 % 256) as u8, 132);
        assert_eq!(numbers(sent(&mut sender, well)), [obstacles, distance]);
        let said = sent(&mut sender, cut);
        assert_eq!(said.len(), 1);
        assert_eq!((said[0].0, &said[0].1[1..]), (status, &b"eeruf: sensor 1 (0 deg) does not answer"[..]));
        assert!(sent(&mut sender, cut).is_empty());
        // Heartbeats of another vehicle do not count.
        heartbeat(2, MAV_MODE_FLAG_SAFETY_ARMED);
        assert!(sent(&mut sender, cut).is_empty());
        heartbeat(1, MAV_MODE_FLAG_SAFETY_ARMED);
        let said = sent(&mut sender, cut);
        assert_eq!(numbers(said.clone()), [status, obstacles, distance]);
        // Its sectors are unknown, those of the other clear.
        let at = |deg: f32| said[1].1[8 + 2 * sector(deg)..][..2].to_vec();
        assert_eq!((at(0.0), at(180.0)), (vec![0xFF, 0xFF], 401_u16.to_le_bytes().to_vec()));
        sender.heartbeat().unwrap();
        let beats = received(&receiver);
        assert_eq!((numbers(beats.clone()), beats[0].1[7]), (vec![0, 1], MAV_STATE_CRITICAL));
        assert_eq!(beats[1].1[..12], [[0, 0, 0, 2], [0, 0, 0, 2], [0, 0, 0, 0]].concat());
        heartbeat(1, 0);
        assert!(sent(&mut sender, cut).is_empty());
    }

    fn well_view() -> View {
        View::Sees(Distance::Clear)
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
