//! The line between board and host: messages arrive, and a damaged message is never taken for another.

use eeruf_core::{Instant, Micros, ReadingKind, Ring, RingConfig, RingEvent, judge::Explanation, tables::PAPER_12};
use eeruf_serial::{Decoder, Encoder, FiringMessage, Frame, FrameError, LONGEST_FRAME, Message, Received, Recorder};
use fastrand::Rng;
use proptest::prelude::*;

fn received(bytes: &[u8]) -> Vec<Result<Received, FrameError>> {
    let mut decoder = Decoder::default();
    bytes.iter().filter_map(|&byte| decoder.push(byte)).collect()
}

fn explanation() -> impl Strategy<Value = Option<Explanation>> {
    prop_oneof![
        Just(None),
        Just(Some(Explanation::History)),
        (0..64_u8).prop_map(|sensor| Some(Explanation::Sensor(sensor)))
    ]
}

fn firings() -> impl Strategy<Value = FiringMessage> {
    let numbers = (any::<u32>(), any::<u32>(), any::<u16>(), any::<u32>());
    let kinds = 0..ReadingKind::ALL.len();
    (0..64_u8, 0..8_u8, kinds, prop::option::of(0..u32::MAX), numbers, explanation()).prop_map(
        |(sensor, phase, kind, t_echo, (fired, period, late, age), explained_by)| FiringMessage {
            sensor,
            phase,
            kind: ReadingKind::ALL[kind],
            fired: Instant::from_micros(fired),
            period,
            t_echo: t_echo.map(Micros::new),
            late: Micros::new(late.into()),
            age: Micros::new(age),
            explained_by,
        },
    )
}

fn messages() -> impl Strategy<Value = Message> {
    prop_oneof![
        firings().prop_map(Message::Firing),
        (1..=64_u8, "[ -~]{0,16}").prop_map(|(sensors, clock)| Message::Hello { sensors, clock }),
        (any::<u32>(), any::<u16>(), any::<u8>(), prop::collection::vec(any::<u8>(), 1..=64)).prop_map(
            |(period, late, edges_lost, health)| Message::Period {
                period,
                max_late: Micros::new(late.into()),
                edges_lost,
                health
            }
        ),
    ]
}

fn said(encoder: &mut Encoder, message: &Message) -> Frame {
    match message {
        Message::Hello { sensors, clock } => encoder.hello(*sensors, clock),
        Message::Firing(firing) => encoder.firing(firing),
        Message::Period { period, max_late, edges_lost, health } => {
            encoder.period(*period, *max_late, *edges_lost, health.iter().copied())
        }
    }
}

proptest! {
    #[test]
    fn what_the_board_says_arrives_as_it_was_said(messages in prop::collection::vec(messages(), 1..20)) {
        let mut encoder = Encoder::new();
        let mut line = Vec::new();
        for message in &messages {
            let frame = said(&mut encoder, message);
            prop_assert!(frame.as_bytes().len() <= LONGEST_FRAME);
            line.extend_from_slice(frame.as_bytes());
        }
        let sequence = 0..;
        let read = |(message, sequence)| Ok(Received { sequence, message, of_hopping: false });
        let expected: Vec<_> = messages.into_iter().zip(sequence).map(read).collect();
        prop_assert_eq!(received(&line), expected);
    }

    #[test]
    fn any_bytes_at_all_are_read_without_harm(bytes in prop::collection::vec(any::<u8>(), 0..2000)) {
        received(&bytes);
    }
}

fn a_minute(numbers: &mut Rng, frames: usize) -> Vec<Frame> {
    let mut encoder = Encoder::new();
    let firing = |n: usize, numbers: &mut Rng| FiringMessage {
        sensor: (n % 8) as u8,
        phase: (n / 8 % 2) as u8,
        kind: ReadingKind::ALL[numbers.usize(..12)],
        fired: Instant::from_micros(12_500 * n as u32),
        period: (n / 8) as u32,
        t_echo: (numbers.usize(..4) > 0).then(|| Micros::new(numbers.usize(..30_000) as u32)),
        late: Micros::new(numbers.usize(..300) as u32),
        age: Micros::new(30_000),
        explained_by: n.is_multiple_of(5).then_some(Explanation::Sensor((n % 7) as u8)),
    };
    (0..frames).map(|n| encoder.firing(&firing(n, numbers))).collect()
}

/// Flips bits, drops, adds or repeats bytes, cuts the end, or replaces everything.
fn damage(frame: &Frame, numbers: &mut Rng) -> Vec<u8> {
    let mut bytes = frame.as_bytes().to_vec();
    match numbers.usize(..6) {
        0 => {
            for _ in 0..=numbers.usize(..8) {
                let at = numbers.usize(..bytes.len());
                bytes[at] ^= 1 << numbers.usize(..8);
            }
        }
        1 => {
            let from = numbers.usize(..bytes.len());
            bytes.drain(from..(from + 1 + numbers.usize(..6)).min(frame.as_bytes().len()));
        }
        2 => {
            let at = numbers.usize(..bytes.len());
            bytes.insert(at, numbers.usize(..256) as u8);
        }
        3 => bytes.truncate(numbers.usize(..bytes.len())),
        4 => {
            let at = numbers.usize(..bytes.len());
            bytes.extend_from_within(at..);
        }
        _ => bytes.iter_mut().for_each(|byte| *byte = numbers.usize(..256) as u8),
    }
    bytes
}

/// Checks that damage costs only the frames that it hits. The 16-bit check sum lets one in 65,536 damaged frames pass,
/// and further checks catch some of those; the random numbers are always the same.
#[test]
fn cuts_and_flips_cost_only_the_frames_that_they_hit() {
    let mut numbers = Rng::with_seed(20_000);
    let (mut hit, mut never_sent) = (0, 0);
    for _ in 0..4 {
        let frames = a_minute(&mut numbers, 60_000);
        let sent: Vec<_> = frames.iter().flat_map(|frame| received(frame.as_bytes())).collect();
        let (mut line, mut spared) = (Vec::new(), Vec::new());
        for (frame, sent) in frames.iter().zip(&sent) {
            let hurt = numbers.usize(..4) == 0;
            hit += usize::from(hurt);
            // A frame that lost its end spoils the next one too.
            if !hurt && line.last().is_none_or(|&byte| byte == 0) {
                spared.push(sent.clone());
            }
            if hurt {
                line.extend(damage(frame, &mut numbers));
            } else {
                line.extend_from_slice(frame.as_bytes());
            }
        }
        let mut awaited = spared.iter();
        let mut next = awaited.next();
        for arrived in received(&line) {
            if next == Some(&arrived) {
                next = awaited.next();
            } else if let Ok(frame) = &arrived {
                never_sent += usize::from(sent[usize::from(frame.sequence) % sent.len()] != arrived);
            }
        }
        assert_eq!(next, None, "a frame that nothing hit did not arrive");
        assert!(spared.len() > 35_000, "{}", spared.len());
    }
    assert!(hit > 55_000, "{hit}");
    assert!(never_sent <= 2, "{never_sent} of {hit}");
    println!("damaged {hit} frames of 240000; {never_sent} came through as frames that nobody sent");
}

#[test]
fn one_wrong_bit_before_packing_is_always_noticed() {
    let frame = Encoder::new().hello(8, "board");
    let mut content = frame.as_bytes().to_vec();
    let length = cobs::decode_in_place(&mut content[..frame.as_bytes().len() - 1]).unwrap();
    for bit in 0..8 * length {
        let mut wrong = content[..length].to_vec();
        wrong[bit / 8] ^= 1 << (bit % 8);
        let mut packed = [0; 64];
        let packed_length = cobs::encode(&wrong, &mut packed);
        assert_eq!(received(&packed[..=packed_length]), [Err(FrameError::Damaged)], "bit {bit}");
    }
}

/// The example of docs/reference/serial.md.
#[test]
fn a_firing_is_these_bytes() {
    let firing = FiringMessage {
        sensor: 3,
        phase: 1,
        kind: ReadingKind::Accepted,
        fired: Instant::from_micros(1_234_567),
        period: 12,
        t_echo: Some(Micros::new(5_872)),
        late: Micros::new(40),
        age: Micros::new(40_100),
        explained_by: None,
    };
    let mut encoder = Encoder::new();
    encoder.hello(8, "board");
    let hex = encoder.firing(&firing).as_bytes().iter().map(|byte| format!("{byte:02x}")).collect::<Vec<_>>().join(" ");
    assert_eq!(hex, "03 21 01 07 03 01 01 87 d6 12 02 0c 01 01 03 f0 16 01 02 28 03 a4 9c 01 04 ff d9 4c 00");
}

#[test]
fn what_is_whole_and_of_another_version_or_kind_is_named() {
    let packed = |content: &[u8]| {
        let sum = crc::Crc::<u16>::new(&crc::CRC_16_IBM_3740).checksum(content);
        let mut bytes = [0; 64];
        let length = cobs::encode(&[content, &sum.to_le_bytes()].concat(), &mut bytes);
        received(&bytes[..=length]).pop().unwrap().unwrap_err()
    };
    let firing = |change: fn(&mut [u8])| {
        let mut content = [0; 25];
        content[0] = 0x21;
        change(&mut content);
        packed(&content)
    };
    assert_eq!((packed(&[0, 0, 0, 8]), packed(&[0x30, 0, 0, 8])), (FrameError::Version(0), FrameError::Version(3)));
    let refused = "the board speaks version 3 of the serial protocol; expected 1 to 2";
    assert_eq!(packed(&[0x30, 0, 0, 8]).to_string(), refused);
    assert_eq!(packed(&[0x25, 0, 0, 8]), FrameError::Content("kind"));
    assert_eq!(firing(|content| content[24] = 64), FrameError::Content("explanation"));
    assert_eq!(packed(&[0x20, 0, 0, 0]), FrameError::Content("number of sensors"));
    assert_eq!(packed(&[0x20, 0, 0, 8, b'\n']), FrameError::Content("clock"));
    assert_eq!(packed(&[0x22, 0, 0, 8, 0, 0, 0, 0, 0, 0]), FrameError::Content("number of sensors"));
    assert_eq!(firing(|content| content[3] = 64), FrameError::Content("sensor"));
    assert_eq!(firing(|content| content[5] = 12), FrameError::Content("kind of reading"));
    assert_eq!(packed(&[0x21, 0, 0, 8]), FrameError::Content("length"));
    assert_eq!(packed(&[0x21; 26]), FrameError::Content("kind of reading"));
    let hopping = |length: usize| {
        let mut content = vec![0; length];
        content[0] = 0x23;
        packed(&content)
    };
    assert_eq!((hopping(30), hopping(32)), (FrameError::Content("length"), FrameError::Content("length")));
}

#[test]
fn a_recorder_says_everything_that_a_ring_reads() {
    let mut ring = Ring::new(&PAPER_12, RingConfig::new(), Instant::from_micros(u32::MAX - 3_000_000)).unwrap();
    let mut recorder = Recorder::<12>::new("board");
    let (mut line, mut expected, mut fired) = (Vec::new(), Vec::new(), [Instant::from_micros(0); 12]);
    for step in 0..3_000_u32 {
        let now = ring.next_deadline() + Micros::new(step % 7);
        while let Some(event) = ring.poll(now) {
            if let RingEvent::Fire { sensor, .. } = event {
                fired[usize::from(sensor)] = now;
                ring.echo(sensor, now + Micros::new(9_000 + u32::from(sensor))).unwrap();
            }
            let frame = recorder.event(&event, now, |sensor| sensor % 3, 5);
            line.extend_from_slice(frame.as_ref().map_or(&[][..], Frame::as_bytes));
            match event {
                RingEvent::Reading(reading) => expected.push((reading.sensor, reading.period, reading.t_echo)),
                RingEvent::PeriodEnded(stats) => expected.push((99, stats.period, None)),
                RingEvent::Fire { .. } => {}
            }
        }
    }
    let mut heard = Vec::new();
    for (message, sequence) in received(&line).into_iter().zip(0..) {
        let message = message.unwrap();
        assert_eq!(message.sequence, sequence);
        match message.message {
            Message::Hello { sensors, clock } => assert_eq!((sensors, &*clock), (12, "board")),
            Message::Firing(firing) => {
                assert!(firing.late <= Micros::new(6));
                heard.push((firing.sensor, firing.period, firing.t_echo));
            }
            Message::Period { period, edges_lost, health, .. } => {
                assert_eq!((edges_lost, &health[..4]), (5, &[0, 1, 2, 0][..]));
                heard.push((99, period, None));
            }
        }
    }
    assert!(heard.len() > 1_000);
    assert_eq!(heard, expected);
}

// Boards in the field send firings of version 1, and of hopping rings, whose weights are ignored.
#[test]
fn frames_of_earlier_versions_are_still_read() {
    let bytes = |hex: &str| hex.split(' ').map(|byte| u8::from_str_radix(byte, 16).unwrap()).collect::<Vec<_>>();
    let expected = FiringMessage {
        sensor: 3,
        phase: 1,
        kind: ReadingKind::Accepted,
        fired: Instant::from_micros(1_234_567),
        period: 12,
        t_echo: Some(Micros::new(5_872)),
        late: Micros::new(40),
        age: Micros::new(40_100),
        explained_by: None,
    };
    let (begin, middle) = ("07 03 01 01 87 d6 12 02 0c 01 01 03 f0 16 01 02 28 03 a4 9c 01", "02 07 88 ff ff ff");
    for (frame, sequence, of_hopping) in [
        (format!("03 11 01 {begin} 03 36 c9 00"), 1, false),
        (format!("03 13 02 {begin} 09 {middle} 8f 42 00"), 2, true),
        (format!("03 23 02 {begin} 0a ff {middle} 3c 8f 00"), 2, true),
    ] {
        let message = Message::Firing(expected);
        assert_eq!(received(&bytes(&frame)), [Ok(Received { sequence, message, of_hopping })], "{frame}");
    }
}
