//! Ways of firing rings measured by a robot's needs: the table of `eeruf_sim::experiments::measure`, with intervals,
//! and its rows as CSV.
//! `cargo lab measure RING.toml .. [--first N] [--places N] [--choose N] [--csv FILE] [--planted BLOCKS]`. Figures are
//! reported on rooms from number 20,000 on, 6 of each kind; settings are chosen on as many rooms from number 0 on.
//! `--planted` prints instead how often a sound way is told from a copy of it with a planted flaw.

use std::fs::File;
use std::io::{BufWriter, Write};

use eeruf_design::RingSpec;
use eeruf_sim::experiments::FIRST;
use eeruf_sim::experiments::measure::{
    Cell, Condition, Control, Estimate, Family, MeasureAsked, Measured, MeasuredWay, Moving, ONE_A_MINUTE, Operating,
    Point, Speeds, Under, measure, measured_ways,
};

/// Numbers of false stops a minute for which the curve is printed.
const CURVE: [f64; 3] = [0.1, 1.0, 10.0];

/// The command's arguments.
struct Arguments {
    rings: Vec<String>,
    first: u64,
    places: u64,
    choose: u64,
    csv: Option<String>,
    blocks: u64,
}

impl Arguments {
    fn of(arguments: &[String]) -> Result<Self, Box<dyn std::error::Error>> {
        let mut asked = Self { rings: vec![], first: FIRST, places: 6, choose: 0, csv: None, blocks: 0 };
        let mut words = arguments.iter();
        while let Some(word) = words.next() {
            let mut value = || words.next().ok_or_else(|| format!("{word}: no value; expected one"));
            match word.as_str() {
                "--first" => asked.first = value()?.parse()?,
                "--places" => asked.places = value()?.parse()?,
                "--choose" => asked.choose = value()?.parse()?,
                "--planted" => asked.blocks = value()?.parse()?,
                "--csv" => asked.csv = Some(value()?.clone()),
                _ => asked.rings.push(word.clone()),
            }
        }
        if asked.choose == 0 {
            asked.choose = asked.places;
        }
        Ok(asked)
    }
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
        let at = |ways: &dyn Fn(usize) -> bool| chooses.operating(chosen, ways, ONE_A_MINUTE);
        for (index, way) in measured.ways.iter().enumerate() {
            let name = under.condition.as_str();
            let Some(operating) = at(&|other| other == index) else {
                println!("| {name} | {} | cannot fire this ring |", way.way.name);
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
                way.way.name,
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
            let at = |most| chooses.operating(chosen, |way| measured.ways[way].family == family, most);
            let words = CURVE.map(|most| match at(most) {
                Some(Operating::At(point)) => {
                    let t95_ms = under.cell(point, measured).t95_ms.value;
                    format!("{t95_ms:.0} ({} {})", measured.ways[point.way].way.name, point.setting)
                }
                _ => "none".to_owned(),
            });
            words.join("; ")
        };
        println!("| {} | {} |", under.condition.as_str(), Family::ALL.map(of_family).join(" | "));
    }
}

/// Prints how often a sound way loses against a copy of it with a planted flaw, which counts as the simpler one.
fn planted(ways: &[MeasuredWay], asked: &MeasureAsked, choose: u64, blocks: u64) -> crate::Answer {
    let Some(sound) = ways.iter().find(|way| way.way.name == "one_by_one_33ms") else { return Ok(()) };
    let controls = Control::PLANTED.map(Some).into_iter().chain([None]);
    let ways: Vec<_> = controls.map(|control| (sound.clone(), control)).collect();
    // Beside another robot, one by one may have no operating point.
    let alone: Vec<_> = asked.conditions.iter().copied().filter(|condition| !condition.others).collect();
    let mut told = [0; Control::PLANTED.len()];
    for block in 0..blocks {
        let of = |first, places| {
            measure(&ways, &MeasureAsked { first, places, conditions: alone.clone(), ..asked.clone() }, &|_| true)
        };
        let (chosen, measured) = (of(block * choose, choose)?, of(asked.first + block * asked.places, asked.places)?);
        for (planted, told) in told.iter_mut().enumerate() {
            let groups = [vec![planted], vec![Control::PLANTED.len()]];
            *told += u64::from(measured.costs(&chosen, &groups).recommended == Some(1));
        }
    }
    for (control, told) in Control::PLANTED.iter().zip(told) {
        println!("{control:?}: the sound way is recommended in {told} of {blocks} blocks of rooms");
    }
    Ok(())
}

fn trials(under: &Under) -> String {
    let things = under.places.iter().filter(|place| place.thing.is_some()).count();
    let unread = 100.0 * under.unread();
    format!("{}: {things} things in {} rooms, {unread:.0} % drawn again", under.condition.as_str(), under.places.len())
}

pub(crate) fn main(arguments: &[String]) -> crate::Answer {
    let Arguments { rings, first, places, choose, csv, blocks } = Arguments::of(arguments)?;
    if rings.is_empty() {
        return Err("no ring; expected files of rings".into());
    }
    let mut out = csv.map(File::create).transpose()?.map(BufWriter::new);
    if let Some(out) = &mut out {
        writeln!(out, "ring,{}", Measured::CSV_HEAD)?;
    }
    for file in rings {
        let spec = RingSpec::from_text(&std::fs::read_to_string(&file)?).map_err(|error| error.to_string())?;
        let design = spec.shortest_to_study().map_err(|error| error.to_string())?;
        let robot = design.as_ref().map_or(&spec, |design| &design.spec).room_robot()?.robot;
        let ways = measured_ways(&robot, design.as_ref().map(|design| &design.schedule));
        let speeds = Speeds { speed_m_s: spec.room_speed_m_s(), turn_rad_s: spec.room_turn_deg_s().to_radians() };
        let asked = MeasureAsked { conditions: Condition::ALL.into(), first, places, speeds };
        if blocks > 0 {
            planted(&ways, &asked, choose, blocks)?;
            continue;
        }
        let ways: Vec<_> = ways.into_iter().map(|way| (way, None)).collect();
        let chosen = measure(&ways, &MeasureAsked { first: 0, places: choose, ..asked.clone() }, &|_| true)?;
        let measured = measure(&ways, &asked, &|_| true)?;
        println!(
            "{file}: {places} rooms of each kind from number {first} on, settings from {choose} from number 0 on."
        );
        println!("{}.\n", measured.under.iter().map(trials).collect::<Vec<_>>().join("; "));
        table(&measured, &chosen, spec.room_turn_deg_s());
        curve(&measured, &chosen);
        let costs = measured.costs(&chosen, &measured.families());
        println!("\n| way | cost |\n|---|---:|");
        for (family, cost) in Family::ALL.iter().zip(&costs.costs) {
            let words = cost.cost.as_ref().map_or("none".to_owned(), |cost| with_interval(cost, 1.0, 3));
            println!("| {family} | {words} |");
        }
        match costs.recommended {
            Some(best) => {
                let draw = costs.draw.map_or(String::new(), |other| format!(", a draw with {}", Family::ALL[other]));
                println!("\nRecommended: {}{draw}.\n", Family::ALL[best]);
            }
            None => println!("\nNo way has a point of at most one false stop a minute under each condition.\n"),
        }
        if let Some(out) = &mut out {
            for row in measured.csv().lines() {
                writeln!(out, "{file},{row}")?;
            }
        }
    }
    Ok(())
}
