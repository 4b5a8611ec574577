//! Ways of firing rings measured by what a robot needs: the table of `eeruf_sim::experiments::measure`, with intervals,
//! and its rows as CSV.
//!
//! `cargo lab measure [RING.toml ..] [--first N] [--places N] [--csv FILE] [--blocks N]`:
//! rooms from number 20,000 on, and 6 of each kind, on which figures are reported; settings are chosen on as many from
//! number 1,000 on. Without a file it measures rings of 2, 4, 8, 12 and 24 HC-SR04. With `--blocks`, instead what is
//! recommended in this many blocks of rooms.

use std::fs::File;
use std::io::{BufWriter, Write};

use eeruf_design::{CHOICE, RingDesign, RingSpec, RoomsAsked};
use eeruf_sim::experiments::measure::{
    Cell, Condition, Costs, Estimate, Family, MeasureAsked, Measured, Moving, ONE_A_MINUTE, Operating, Point, RoomWay,
    Speeds, Under, measure,
};
use eeruf_sim::experiments::{ExperimentError, FIRST};

/// Numbers of sensors of the rings that are measured if no file is named.
const SIZES: [u32; 5] = [2, 4, 8, 12, 24];
const RING: &str = "module = \"hc-sr04\"\nlayout = \"ring\"\nspeed_m_s = 0.5\n";
/// From one block of rooms to the next.
const BLOCK: u64 = 1_000;
/// Numbers of false stops a minute for which the curve is printed.
const CURVE: [f64; 3] = [0.1, 1.0, 10.0];

/// The command's arguments.
#[derive(clap::Args)]
pub(crate) struct Asked {
    /// The rings; by default rings of 2, 4, 8, 12 and 24 HC-SR04
    #[arg(value_name = "RING.toml")]
    rings: Vec<String>,
    /// Number of the first room of each kind
    #[arg(long, default_value_t = FIRST)]
    first: u64,
    /// Number of rooms of each kind
    #[arg(long, default_value_t = 6)]
    places: u64,
    /// Write the rows to this file; by default to none
    #[arg(long)]
    csv: Option<String>,
    /// Print instead what is recommended in this many blocks of rooms
    #[arg(long, default_value_t = 0)]
    blocks: u64,
}

/// Formats a number with its interval.
fn with_interval(estimate: &Estimate, scale: f64, digits: usize) -> String {
    let Estimate { value, interval_95: [low, high] } = estimate;
    let number = |value: &f64| format!("{:.digits$}", scale * value);
    format!("{} ({}..{})", number(value), number(low), number(high))
}

fn false_stops(cell: &Cell) -> String {
    match cell.false_stops {
        0 => format!("under {:.2}", 3.0 / cell.minutes),
        _ => with_interval(&cell.false_stops_per_min, 1.0, 2),
    }
}

/// Formats the distance or the angle that a robot moves until 95 % are seen.
fn blind_travel(under: &Under, t95_ms: f64, turn_deg_s: f64) -> String {
    let speed_m_s = under.places.iter().map(|place| place.speed_m_s).sum::<f64>() / under.places.len() as f64;
    match under.condition.moving {
        Moving::Standing => String::new(),
        Moving::Driving => format!("{:.3} m", 1e-3 * speed_m_s * t95_ms),
        Moving::Turning => format!("{:.0} deg", 1e-3 * turn_deg_s * t95_ms),
    }
}

/// Prints each way at its own point, and the best of each family in bold.
fn table(measured: &Measured, chosen: &Measured, turn_deg_s: f64) {
    println!(
        "| condition | way | votes | t95 ms | never % | false stops/min | blind m | foreign % | right % | blind |"
    );
    println!("|---|---|---|---:|---:|---:|---:|---:|---:|---:|");
    for (under, chooses) in measured.under.iter().zip(&chosen.under) {
        let at = |ways: &dyn Fn(usize) -> bool| chooses.operating(chosen, &chosen.points(ways), ONE_A_MINUTE);
        for (index, way) in measured.ways.iter().enumerate() {
            let name = under.condition.as_str();
            let Some(operating) = at(&|other| other == index) else {
                println!("| {name} | {} | cannot fire this ring |", way.name);
                continue;
            };
            let of_family = at(&|other| measured.ways[other].family == way.family);
            let mark = if of_family == Some(operating) { "**" } else { "" };
            let Point { setting, .. } = operating.point();
            let none = if matches!(operating, Operating::None(_)) { ", none at one a minute" } else { "" };
            let cell = under.cell(operating.point(), measured);
            let [t50, t90] = cell.t50_t90_ms;
            println!(
                "| {name} | {mark}{}{mark} | {setting}{none} | {t50:.0} / {t90:.0} / {} | {:.1} | {} | {} | {} | {} | \
                 {} |",
                way.name,
                with_interval(&cell.t95_ms, 1.0, 0),
                100.0 * cell.never,
                false_stops(&cell),
                blind_travel(under, cell.t95_ms.value, turn_deg_s),
                with_interval(&cell.foreign, 100.0, 2),
                with_interval(&cell.right, 100.0, 1),
                with_interval(&cell.blind, 1.0, 2),
            );
        }
    }
}

/// Prints the t95 of each family by false stops a minute.
fn curve(measured: &Measured, chosen: &Measured) {
    println!("\nt95 in ms at 0.1, 1 and 10 false stops a minute, with the way and votes:\n");
    println!("| condition | {} |", Family::ALL.map(|family| family.to_string()).join(" | "));
    println!("|---|{}", "---|".repeat(Family::ALL.len()));
    for (under, chooses) in measured.under.iter().zip(&chosen.under) {
        let of_family = |family| {
            let group = chosen.points(|way| chosen.ways[way].family == family);
            let at = |most| chooses.operating(chosen, &group, most);
            let words = CURVE.map(|most| match at(most) {
                Some(Operating::At(point)) => {
                    let t95_ms = under.cell(point, measured).t95_ms.value;
                    format!("{t95_ms:.0} ({} {})", measured.ways[point.way].name, point.setting)
                }
                _ => "none".to_owned(),
            });
            words.join("; ")
        };
        println!("| {} | {} |", under.condition.as_str(), Family::ALL.map(of_family).join(" | "));
    }
}

fn trials(under: &Under) -> String {
    let things = under.places.iter().filter(|place| place.thing.is_some()).count();
    let unread = 100.0 * under.unread();
    format!("{}: {things} things in {} rooms, {unread:.0} % drawn again", under.condition.as_str(), under.places.len())
}

/// The kind that is recommended, in words.
fn verdict(costs: &Costs) -> String {
    let name = |family: usize| Family::ALL[family].to_string();
    let draw = costs.draw.map_or(String::new(), |other| format!(", a draw with {}", name(other)));
    costs.recommended.map_or("none keeps to one false stop a minute".to_owned(), name) + &draw
}

/// Measures ways in rooms from a number on.
fn run(ways: &[RoomWay], asked: &MeasureAsked, first: u64) -> Result<Measured, ExperimentError> {
    let ways: Vec<_> = ways.iter().map(|way| (way.clone(), None)).collect();
    measure(&ways, &MeasureAsked { first, ..asked.clone() }, &|_| true)
}

/// Prints a row of what `eeruf design` recommends in blocks of rooms.
fn recommended(file: &str, spec: &RingSpec, design: Option<&RingDesign>, asked: &Asked) -> crate::Answer {
    let row = (0..asked.blocks).map(|block| {
        let rooms = RoomsAsked { places: asked.places, first: asked.first + block * BLOCK, ..RoomsAsked::default() };
        let answer = spec.judge_in_rooms(design, &rooms, &|_| true)?;
        let draw = answer.draw.map_or(String::new(), |other| format!(", a draw with {other}"));
        let keeps = if answer.keeps { "" } else { ", which does not keep to one false stop a minute" };
        Ok(answer.best.map_or("none".to_owned(), |best| best.name.to_owned()) + &draw + keeps)
    });
    println!("| {file} | {} |", row.collect::<Result<Vec<_>, String>>()?.join(" | "));
    Ok(())
}

pub(crate) fn main(given: &Asked) -> crate::Answer {
    let &Asked { ref rings, first, places, ref csv, blocks } = given;
    let mut out = csv.as_ref().map(File::create).transpose()?.map(BufWriter::new);
    if let Some(out) = &mut out {
        writeln!(out, "ring,{}", Measured::CSV_HEAD)?;
    }
    let read = |file: &String| std::fs::read_to_string(file).map(|text| (file.clone(), text));
    let files: Vec<(String, String)> = match rings.is_empty() {
        true => SIZES.map(|sensors| (format!("{sensors} HC-SR04"), format!("sensors = {sensors}\n{RING}"))).into(),
        false => rings.iter().map(read).collect::<Result<_, _>>()?,
    };
    for (file, text) in files {
        let spec = RingSpec::from_text(&text).map_err(|error| error.to_string())?;
        let design = spec.shortest_to_study().map_err(|error| error.to_string())?;
        let Ok(robot) = design.as_ref().map_or(&spec, |design| &design.spec).room_robot() else {
            println!("{file}: no places of its sensors, and so no rooms");
            continue;
        };
        let ways = RoomWay::all(&robot.robot, design.as_ref().map(|design| &design.schedule));
        let turn_deg_s = spec.room_turn_deg_s();
        let speeds = Speeds { speed_m_s: spec.room_speed_m_s(), turn_rad_s: turn_deg_s.to_radians() };
        if blocks > 0 {
            recommended(&file, &spec, design.as_ref(), given)?;
            continue;
        }
        let asked = MeasureAsked { conditions: Condition::ALL.into(), own: vec![], first, places, speeds };
        let (chosen, measured) = (run(&ways, &asked, CHOICE)?, run(&ways, &asked, first)?);
        println!(
            "{file}: {places} rooms of each kind from number {first} on, settings from as many from number {CHOICE} on."
        );
        println!("{}.\n", measured.under.iter().map(trials).collect::<Vec<_>>().join("; "));
        table(&measured, &chosen, turn_deg_s);
        curve(&measured, &chosen);
        let families = measured.families();
        let costs = measured.costs(&chosen, &families[0], &families);
        println!("\n| way | cost |\n|---|---:|");
        for (family, cost) in Family::ALL.iter().zip(&costs.costs) {
            let words = cost.cost.as_ref().map_or("none".to_owned(), |cost| with_interval(cost, 1.0, 3));
            println!("| {family} | {words} |");
        }
        println!("\nLeast cost: {}.\n", verdict(&costs));
        if let Some(out) = &mut out {
            for row in measured.csv().lines() {
                writeln!(out, "{file},{row}")?;
            }
        }
    }
    Ok(())
}
