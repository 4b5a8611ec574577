//! Programs for a ring: the files of `eeruf design --program`, from templates that are programs themselves.

mod boards;

use clap::ValueEnum;
use eeruf_core::flow::{TurnSettings, Votes};
use eeruf_core::{Layout, Micros};
use eeruf_design::{FlowDesign, RingDesign, RingSpec, Way};
use eeruf_files::emit::{Flow, Form};
use eeruf_files::rotation;
use eeruf_sim::Robot;
use eeruf_sim::modules::PulseTimes;

pub(crate) use boards::Board;
use boards::Wiring;

/// The language and the system of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Language {
    /// A sketch, with the library beside it: open it in the IDE and upload
    Arduino,
    /// A `no_std` crate over embedded-hal: give it your pins
    Rust,
    /// C99 with `eeruf.c` beside it: give it three functions of your board
    C,
    /// A `main.py` and `eeruf.py`: copy both to the board
    Micropython,
    /// Parameters of the node `eeruf_ros2` on a Raspberry Pi's own pins
    Ros2,
}

impl Language {
    /// Returns the boards for the language, the usual one first; none if any will do.
    const fn boards(self) -> &'static [Board] {
        match self {
            Self::Arduino => &[Board::Uno, Board::Mega, Board::Pico, Board::Esp32],
            Self::Micropython => &[Board::Pico, Board::Esp32],
            Self::Ros2 => &[Board::RaspberryPi],
            Self::Rust | Self::C => &[],
        }
    }
}

/// A program: its files by their paths in its folder.
#[derive(Debug)]
pub(crate) struct Program {
    pub(crate) files: Vec<(String, String)>,
    /// The next step for the user, in a sentence.
    pub(crate) next: &'static str,
}

impl Program {
    fn new<N: Into<String>>(files: impl IntoIterator<Item = (N, String)>, next: &'static str) -> Self {
        Self { files: files.into_iter().map(|(name, text)| (name.into(), text)).collect(), next }
    }
}

/// A ring and its way of firing.
pub(crate) struct Wanted<'a> {
    /// The ring file's name and text.
    pub(crate) file: (&'a str, &'a str),
    pub(crate) design: &'a RingDesign,
    pub(crate) robot: &'a Robot,
    pub(crate) way: Way,
    /// True if the program should send MAVLink to an autopilot.
    pub(crate) mavlink: bool,
    /// The name of the folder, for languages whose main file has the same name.
    pub(crate) name: &'a str,
}

const C_LIBRARY: [(&str, &str); 2] =
    [("eeruf.c", include_str!("../../c/eeruf.c")), ("eeruf.h", include_str!("../../c/eeruf.h"))];
/// The header that sends MAVLink, and the autopilot's parameters.
const MAVLINK: (&str, &str) = ("eeruf_mavlink.h", include_str!("../../c/eeruf_mavlink.h"));
const ARDUPILOT: (&str, &str) = ("ardupilot.param", include_str!("templates/ardupilot.param"));
const ARDUINO_LIBRARY: [(&str, &str); 5] = [
    ("EerufArduino.cpp", include_str!("../../c/arduino/src/EerufArduino.cpp")),
    ("EerufArduino.h", include_str!("../../c/arduino/src/EerufArduino.h")),
    ("EerufFlow.h", include_str!("../../c/arduino/src/EerufFlow.h")),
    ("EerufInterrupts.h", include_str!("../../c/arduino/src/EerufInterrupts.h")),
    ("EerufSeed.h", include_str!("../../c/arduino/src/EerufSeed.h")),
];

/// The times of a ring's modules, and the board with its wires, if the program is for one.
type Fitting = (PulseTimes, Option<(Board, Wiring)>);

/// Checks what a program needs in any way of firing.
///
/// # Errors
/// A message about what the language, the board or the modules cannot do.
pub(crate) fn fitting(
    spec: &RingSpec,
    language: Language,
    board: Option<Board>,
    mavlink: bool,
) -> Result<Fitting, String> {
    let times = pulse_times(spec)?;
    let wired = |board: Board| Ok::<_, String>((board, board.wiring(spec.sensors, mavlink)?));
    let wiring = chosen(language, board)?.map(wired).transpose()?;
    if mavlink && !matches!(language, Language::Arduino | Language::C) {
        return Err("--mavlink: expected --program arduino or c; the ROS 2 node has a parameter `mavlink`".to_owned());
    }
    if mavlink && spec.places.poses.is_empty() {
        return Err("--mavlink: no places of sensors; expected poses, or spacing_deg and radius_m".to_owned());
    }
    Ok((times, wiring))
}

/// Writes a program.
///
/// # Errors
/// As for [`fitting`], and a way of firing that the language has not.
pub(crate) fn program(wanted: &Wanted<'_>, language: Language, board: Option<Board>) -> Result<Program, String> {
    let spec = &wanted.design.spec;
    let (times, wiring) = fitting(spec, language, board, wanted.mavlink)?;
    if wanted.way == Way::TwoPhases && matches!(language, Language::Micropython | Language::Ros2) {
        return Err("--way two-phases: expected --program arduino, c or rust, which fire by tables".to_owned());
    }
    let flow = if wanted.way == Way::TwoPhases { None } else { Some(spec.fired(wanted.way, wanted.robot, 1)?) };
    let about = wanted.about(flow.as_ref(), wiring.as_ref());
    match (language, flow, wiring) {
        (Language::Arduino, flow, Some((board, wiring))) => Ok(arduino(wanted, flow.as_ref(), &about, board, &wiring)),
        (Language::Micropython, Some(flow), Some((_, wiring))) => micropython(&flow, spec, times, &about, &wiring),
        (Language::Ros2, Some(_), Some((_, wiring))) => ros2(wanted, &about, &wiring),
        (Language::C, flow, _) => Ok(c(wanted, flow.as_ref(), &about)),
        (Language::Rust, flow, _) => Ok(rust(wanted, flow.as_ref(), times, &about)),
        // The arms above cover each language with its boards, and each way with its settings.
        _ => Err("no program for this way and board".to_owned()),
    }
}

fn chosen(language: Language, board: Option<Board>) -> Result<Option<Board>, String> {
    let boards = language.boards();
    let name = |board: &Board| board.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned());
    match board {
        None => Ok(boards.first().copied()),
        Some(board) if boards.contains(&board) => Ok(Some(board)),
        Some(board) if boards.is_empty() => {
            Err(format!("--board {}: expected none, as this program is for any board", name(&board)))
        }
        Some(board) => {
            let known = boards.iter().map(name).collect::<Vec<_>>().join(", ");
            Err(format!("--board {}: expected one that this program is written for: {known}", name(&board)))
        }
    }
}

/// Returns the times of the ring's modules.
pub(crate) fn pulse_times(spec: &RingSpec) -> Result<PulseTimes, String> {
    let Some(module) = spec.modules.first() else {
        return Err(
            "the ring file names no module; expected `module`, as \"hc-sr04\", for a program to know its times".into(),
        );
    };
    if let Some((sensor, other)) = spec.modules.iter().enumerate().find(|(_, other)| *other != module) {
        let (first, other) = (module.name, other.name);
        return Err(format!(
            "sensor {sensor} is {other} and sensor 0 {first}; expected modules of one kind in one program"
        ));
    }
    module.pulse_times().ok_or_else(|| {
        let (name, interface) = (module.name, module.interface.name());
        format!("{name} answers by {interface}; expected a module that answers by the width of a pulse")
    })
}

impl Wanted<'_> {
    /// Writes the first lines of a program, without comment signs.
    fn about(&self, flow: Option<&FlowDesign>, wiring: Option<&(Board, Wiring)>) -> Vec<String> {
        let spec = &self.design.spec;
        let modules = spec.modules.first().map_or("", |module| module.name);
        let turns = flow.map_or(TurnSettings::new(1), |flow| flow.turns);
        let mut lines = vec![format!("{} {modules} modules, from {}:", spec.sensors, self.file.0)];
        lines.extend(wrapped(&self.way.in_words(&turns)));
        if let Some((board, wiring)) = wiring {
            lines.push(String::new());
            lines.extend(board.in_words(wiring));
        }
        lines
    }

    /// Writes the table, or the settings of a flow ring.
    fn source(&self, form: Form, flow: Option<&FlowDesign>) -> String {
        let design = self.design;
        match flow {
            Some(flow) => flow_source(&design.spec, form, flow),
            None => form.table(&design.schedule, &design.spec.table_requirements(), &design.spec.modules),
        }
    }
}

/// Writes the setup of a flow ring as source text.
pub(crate) fn flow_source(spec: &RingSpec, form: Form, flow: &FlowDesign) -> String {
    let FlowDesign { turns, belief, window, blanking, limits } = flow;
    let uneven = spec.problem().requirements.uneven;
    let shared_lines = uneven.map_or(&[][..], |uneven| uneven.shared_lines);
    let (window, blanking) = (*window, *blanking);
    form.flow(&Flow { turns, belief, sensors: spec.sensors, window, blanking, limits, shared_lines }, &spec.modules)
}

/// Wraps a text into lines of no more than 110 characters.
pub(crate) fn wrapped(text: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if !line.is_empty() && line.len() + word.len() < 110 => *line += &format!(" {word}"),
            Some(line) if line.is_empty() => line.push_str(word),
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Writes comments: each line after a sign.
fn comments(lines: &[String], sign: &str) -> String {
    lines.iter().map(|line| format!("{sign} {line}").trim_end().to_owned() + "\n").collect()
}

/// Fills in the placeholders of a template, such as `@sensors@`.
fn filled(template: &str, values: &[(&str, impl AsRef<str>)]) -> String {
    values.iter().fold(template.to_owned(), |text, (name, value)| text.replace(&format!("@{name}@"), value.as_ref()))
}

fn list(pins: &[u8]) -> String {
    pins.iter().map(u8::to_string).collect::<Vec<_>>().join(", ")
}

/// Writes the first lines of a program that prints.
fn printing(about: &[String], has_dice: bool) -> Vec<String> {
    let seed = if has_dice { "the seed of its random gaps, then " } else { "" };
    let prints = format!(
        "Prints, at 115200 baud, {seed}for each reading that counts the number of the module and the distance in \
         millimetres, or `free`. A module that has neither is unknown, which is not free."
    );
    [about, &[String::new()], &wrapped(&prints)].concat()
}

/// Writes the first lines of a program that sends MAVLink to an autopilot.
fn speaking(about: &[String], board: Board, sends: &str, receives: &str) -> Vec<String> {
    let level = if board.has_3v3() { "" } else { " by 1 kOhm, with 2 kOhm from there to ground: it sends 5 V" };
    let line = format!(
        "The line to the autopilot's TELEM port, 115,200 baud: pin {sends} to its RX{level}; pin {receives} from its \
         TX; ground to ground. Load ardupilot.param: it makes TELEM2 that port. Before the vehicle arms, a module that \
         does not answer holds back all distances, so that the check fails; then its direction is unknown."
    );
    [about, &[String::new()], &wrapped(&line)].concat()
}

/// Selects the lines of a template: for flow or a table, and for MAVLink or printing.
fn lines_of(template: &str, flows: bool, mavlink: bool) -> String {
    let others = [if flows { "//@table" } else { "//@flow" }, if mavlink { "//@print" } else { "//@mavlink" }];
    let kept = template.lines().filter(|line| !others.iter().any(|other| line.contains(other)));
    kept.map(|line| line.split("  //@").next().unwrap_or_default().to_owned() + "\n").collect()
}

/// Returns the directions and ranges of sensors for an autopilot, by their names in templates.
fn directions(wanted: &Wanted<'_>) -> [(&'static str, String); 4] {
    // Half of a beam of 30 degrees, as the ROS 2 node assumes.
    const HALF_VIEW_DEG: u32 = 15;
    const MIN_CM: u32 = 2;
    let yaws: Vec<f32> = wanted.robot.sensors.iter().map(|pose| -pose.rotation.angle().to_degrees() as f32).collect();
    let place = |sensor: usize| {
        let yaw = yaws[sensor].rem_euclid(360.0).round() as u32 % 360;
        format!("{{{yaw}, {}}}", rotation(&yaws, sensor).unwrap_or(255))
    };
    let places: Vec<_> = (0..yaws.len()).map(place).collect();
    let max_cm = wanted.design.spec.modules.first().map_or(400, |module| module.sees_to_mm / 10);
    [
        ("places", places.join(", ")),
        ("half_view_deg", HALF_VIEW_DEG.to_string()),
        ("min_cm", MIN_CM.to_string()),
        ("max_cm", max_cm.to_string()),
    ]
}

fn arduino(wanted: &Wanted<'_>, flow: Option<&FlowDesign>, about: &[String], board: Board, wiring: &Wiring) -> Program {
    let template = lines_of(include_str!("templates/sketch.ino"), flow.is_some(), wanted.mavlink);
    let Wiring { triggers, echoes } = wiring;
    let pins = |name, pins| format!("const uint8_t {name}[] = {{{}}};", list(pins));
    let (pins, given) = if triggers == echoes {
        (pins("PINS", triggers), "PINS")
    } else {
        (format!("{}\n{}", pins("TRIGGERS", triggers), pins("ECHOES", echoes)), "TRIGGERS, ECHOES")
    };
    let sensors = triggers.len().to_string();
    let (line, [sends, receives]) = board.line();
    let directions = directions(wanted);
    let mut values = vec![("pins", &*pins), ("given", given), ("sensors", &sensors), ("noise", board.open_pin())];
    values.push(("line", if wanted.mavlink { line } else { "Serial" }));
    values.extend(directions.iter().map(|(name, value)| (*name, &**value)));
    let head = if wanted.mavlink { speaking(about, board, sends, receives) } else { printing(about, flow.is_some()) };
    let sketch = comments(&head, "//") + &filled(&template, &values);
    let tab = wanted.source(Form::Arduino, flow).replace("<EerufArduino.h>", "\"src/eeruf/EerufArduino.h\"");
    let library = C_LIBRARY.into_iter().chain(ARDUINO_LIBRARY).chain(wanted.mavlink.then_some(MAVLINK));
    let library = library.map(|(name, text)| (format!("src/eeruf/{name}"), text.to_owned()));
    let own = [(format!("{}.ino", wanted.name), sketch), ("ring.h".to_owned(), tab)].into_iter();
    let parameters = wanted.mavlink.then(|| (ARDUPILOT.0.to_owned(), ARDUPILOT.1.to_owned()));
    let next = "open the sketch in the Arduino IDE and upload it; its first lines say how to wire";
    Program::new(own.chain(library).chain(parameters), next)
}

/// The numbers of the modules, which rest for this time, by their names in templates.
fn of_modules(spec: &RingSpec, times: PulseTimes, rest: Micros) -> Vec<(&'static str, String)> {
    let PulseTimes { deaf_us, shortest_us, latest_rise_us, longest_us, longest_hold_us } = times;
    let trigger_us = spec.modules.first().map_or(10, |module| module.trigger_us);
    let edges = [("deaf_us", deaf_us), ("shortest_us", shortest_us), ("latest_rise_us", latest_rise_us)];
    let pulses = [("longest_us", longest_us), ("longest_hold_us", longest_hold_us), ("trigger_us", trigger_us)];
    let ring = [("sensors", spec.sensors as u32), ("rest_us", rest.as_micros())];
    ring.into_iter().chain(edges).chain(pulses).map(|(name, number)| (name, number.to_string())).collect()
}

/// The numbers of a flow ring.
fn of_flow(flow: &FlowDesign) -> Vec<(&'static str, String)> {
    let FlowDesign { turns, belief, window, blanking, .. } = flow;
    let us = Micros::as_micros;
    let numbers = [
        ("window_us", us(*window)),
        ("blanking_us", us(*blanking)),
        ("least_us", us(turns.least)),
        ("most_us", us(turns.most)),
        ("dice_us", us(turns.dice)),
        ("t_delta_us", us(belief.t_delta)),
        ("near_us", us(belief.near)),
        ("path_change_us", us(belief.path_change)),
        ("top_speed_mm_s", belief.top_speed_mm_s.into()),
    ];
    numbers.map(|(name, number)| (name, number.to_string())).into()
}

fn micropython(
    flow: &FlowDesign,
    spec: &RingSpec,
    times: PulseTimes,
    about: &[String],
    wiring: &Wiring,
) -> Result<Program, String> {
    if flow.limits.most().is_some() {
        return Err(
            "--program micropython: sensors that fire together, share a line or have limits of their own are not \
                    in its ring; expected --program arduino, c or rust"
                .to_owned(),
        );
    }
    let mut values = of_modules(spec, times, flow.turns.rest);
    values.extend(of_flow(flow));
    let votes = match flow.belief.votes {
        Votes::ByMotion => "BY_MOTION",
        Votes::EveryEcho => "EVERY_ECHO",
        Votes::TwoInARow => "TWO_IN_A_ROW",
    };
    values.extend([
        ("alone", if flow.belief.alone { "True" } else { "False" }.to_owned()),
        ("votes", votes.to_owned()),
        ("triggers", format!("[{}]", list(&wiring.triggers))),
        ("echoes", format!("[{}]", list(&wiring.echoes))),
    ]);
    let template = include_str!("templates/main.py").replace("import ACCEPTED,", &format!("import ACCEPTED, {votes},"));
    let main = comments(&printing(about, true), "#") + &filled(&template, &values);
    let files = [("main.py", main), ("eeruf.py", include_str!("../../c/micropython/eeruf.py").to_owned())];
    Ok(Program::new(files, "copy both files to the board, as `mpremote cp main.py eeruf.py :`, and reset it"))
}

fn c(wanted: &Wanted<'_>, flow: Option<&FlowDesign>, about: &[String]) -> Program {
    let about = format!("/* {} */\n", about.join("\n   "));
    let of_ring = |template| lines_of(template, flow.is_some(), wanted.mavlink);
    let directions = directions(wanted);
    let mut values: Vec<_> = directions.iter().map(|(name, value)| (*name, &**value)).collect();
    values.extend(match flow {
        Some(_) => {
            [("Flow", "Flow"), ("flow", "flow"), ("seed", "uint32_t seed"), ("table", ""), ("base", "&ring.ring")]
        }
        None => [("Flow", ""), ("flow", "ring"), ("seed", "void"), ("table", "&eeruf_schedule, "), ("base", "&ring")],
    });
    let files = [
        ("sonar.h", about + &of_ring(include_str!("templates/sonar.h"))),
        ("sonar.c", filled(&of_ring(include_str!("templates/sonar.c")), &values)),
        ("ring.h", wanted.source(Form::C, flow)),
    ];
    let library = C_LIBRARY.into_iter().chain([MAVLINK, ARDUPILOT].into_iter().filter(|_| wanted.mavlink));
    let files = files.into_iter().chain(library.map(|(name, text)| (name, text.to_owned())));
    Program::new(
        files,
        "compile the two .c files with yours, which has the three functions at the beginning of sonar.h",
    )
}

fn rust(wanted: &Wanted<'_>, flow: Option<&FlowDesign>, times: PulseTimes, about: &[String]) -> Program {
    let (design, spec) = (wanted.design, &wanted.design.spec);
    let source = wanted.source(Form::Rust, flow);
    let own = flow.map_or(source.contains("EachSensor"), |flow| flow.limits.most().is_some());
    // A module may rest for less time than its file says, if the table of the ring file requires it.
    let rest = spec.modules.first().map_or(0, |module| module.rest_us).min(design.schedule.min_refire().as_micros());
    let rest = flow.map_or(Micros::new(rest), |flow| flow.turns.rest);
    let (ring, begin) = match (flow, own) {
        (Some(_), true) => (
            "eeruf_core::flow::FlowRing<SENSORS, 1, eeruf_core::EachSensor<SENSORS>>",
            "with_limits(SENSORS, ring::LIMITS, ",
        ),
        (Some(_), false) => ("eeruf_core::flow::FlowRing<SENSORS>", "flow(SENSORS, "),
        (None, true) => {
            ("eeruf_core::ScheduledRing<'static, SENSORS, 1, &'static eeruf_core::EachSensor<SENSORS>>", "")
        }
        (None, false) => ("eeruf_core::ScheduledRing<'static, SENSORS>", ""),
    };
    let mut values = of_modules(spec, times, rest);
    values.extend([("ring", ring.to_owned()), ("begin", begin.to_owned())]);
    let lib = lines_of(include_str!("templates/lib.rs"), flow.is_some(), false);
    let files = [
        ("Cargo.toml", filled(include_str!("templates/Cargo.toml.in"), &[("name", wanted.name)])),
        ("src/lib.rs", comments(about, "//!") + &filled(&lib, &values)),
        ("src/ring.rs", "//! The settings of the ring, as `eeruf design` found them.\n\n".to_owned() + &source),
    ];
    let next = "name your clone in its Cargo.toml; depend on it from your firmware, and call `sonar` with its pins";
    Program::new(files, next)
}

fn ros2(wanted: &Wanted<'_>, about: &[String], wiring: &Wiring) -> Result<Program, String> {
    if wanted.way != Way::Flow {
        return Err(format!("--way {}: expected flow, by which the node fires", wanted.way.name()));
    }
    let values = [("triggers", &*list(&wiring.triggers)), ("echoes", &*list(&wiring.echoes))];
    // The node publishes the sensors' places: without any in the file, those for which `design` chose the way.
    let spec = &wanted.design.spec;
    let is_assumed = spec.places.poses.is_empty() && matches!(spec.layout.layout(), Layout::Ring(_));
    let spacing_deg = 360.0 / spec.sensors as f64;
    let places = format!("# Assumed: measure your own.\nspacing_deg = {spacing_deg}\nradius_m = 0.2\n\n");
    let files = [
        ("eeruf.yaml", comments(about, "#") + &filled(include_str!("templates/eeruf.yaml"), &values)),
        ("ring.toml", if is_assumed { places } else { String::new() } + wanted.file.1),
    ];
    Ok(Program::new(files, "in its folder: `ros2 launch eeruf_ros2 eeruf.launch.py params_file:=$PWD/eeruf.yaml`"))
}
