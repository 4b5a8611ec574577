//! Lists the sensors of a scene's first ring that hear each other, with time and level above the threshold: `cargo run
//! -p eeruf-sim --example critical_paths -- scenes/alcove.toml`

use std::{error::Error, path::PathBuf};

use eeruf_sim::World;

fn main() -> Result<(), Box<dyn Error>> {
    let file = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("scenes/alcove.toml"), PathBuf::from);
    let world = World::from_toml(&file)?;
    let (air, robot) = (world.scene().air(), &world.robots()[0]);
    let heard = world.ring_paths(0, world.max_order())?;
    println!("{:>4} {:>4} {:>8} {:>6}  bounces", "from", "to", "ms", "dB");
    for path in heard.paths().iter().filter(|path| path.emitter != path.receiver) {
        let transducer = robot.transducer_of(path.receiver as usize);
        let level_db = transducer.level_db(path.amplitude, path.length_m, air);
        let ms = 1e3 * path.length_m / air.speed_of_sound();
        println!("{:>4} {:>4} {ms:>8.2} {level_db:>6.1}  {:?}", path.emitter, path.receiver, heard.bounces(path));
    }
    Ok(())
}
