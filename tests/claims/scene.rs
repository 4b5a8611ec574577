//! The verb `scene`: a map becomes a scene file that the program reads.

use crate::common::{Scratch, eeruf};

#[test]
fn a_map_becomes_a_scene_that_can_be_studied_with_a_robot_in_it() {
    let (folder, yaml) = Scratch::new("room.yaml", "image: room.pgm\nresolution: 0.5\norigin: [0, 0, 0]\n");
    let rows = ["0 0 0 0 0 0", "0 9 9 9 9 0", "0 9 9 9 9 0", "0 9 9 9 9 0", "0 0 0 0 0 0"];
    std::fs::write(folder.path().join("room.pgm"), format!("P2 6 5 9 {}", rows.join(" "))).unwrap();
    let outcome = eeruf(&["scene", yaml.to_str().unwrap(), "--tolerance-m", "0"]);
    assert_eq!((outcome.code, &*outcome.err), (Some(0), ""));
    assert!(outcome.out.lines().next().unwrap().ends_with("6 x 5 cells of 0.5 m; 8 walls within 0 m of their edges."));
    let robot =
        "[[robot]]\npose = { x_m = 1.5, y_m = 1.2 }\nring = { sensors = 4, spacing_deg = 20, radius_m = 0.2 }\n";
    let (_folder, scene) = Scratch::new("room.toml", &(outcome.out + robot));
    let study = eeruf(&["study", scene.to_str().unwrap(), "--periods", "10", "--method", "eeruf"]);
    assert_eq!((study.code, &*study.err), (Some(0), ""));
}

// A map that is wrong is refused with the file and what is expected.
#[test]
fn wrong_map_is_refused_with_its_file() {
    let (_folder, yaml) = Scratch::new("map.yaml", "image: no.pgm\nresolution: 0.05\norigin: [0, 0]\n");
    let outcome = eeruf(&["scene", yaml.to_str().unwrap()]);
    assert_eq!(outcome.code, Some(2));
    assert!(
        outcome.err.ends_with("map.yaml: no origin; expected [x, y, yaw] in metres and radians\n"),
        "{}",
        outcome.err
    );
    let outcome = eeruf(&["scene", yaml.to_str().unwrap(), "--tolerance-m", "1001"]);
    assert!(outcome.err.contains("expected 0 to 1000"), "{}", outcome.err);
}
