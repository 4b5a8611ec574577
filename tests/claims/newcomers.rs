//! A newcomer's session: the commands of the tutorials run from top to bottom, and print the figures of their texts.

use std::path::Path;
use std::process::{Command, Output};

/// Runs a line of a shell in a folder, with the program under its own name.
pub(crate) fn shell(line: &str, folder: &Path) -> Output {
    let program = Path::new(env!("CARGO_BIN_EXE_eeruf")).parent().unwrap();
    let path = std::env::var("PATH").unwrap();
    let mut sh = Command::new("sh");
    sh.args(["-c", line]).current_dir(folder).env("PATH", format!("{}:{path}", program.display()));
    let output = sh.env_remove("COLUMNS").output().unwrap();
    // How far a long command has come depends on the machine.
    let is_said = |line: &&str| !line.starts_with("eeruf: at work for ");
    let stderr: String = String::from_utf8_lossy(&output.stderr).split_inclusive('\n').filter(is_said).collect();
    Output { stderr: stderr.into_bytes(), ..output }
}

/// Returns the commands in a document's shell listings, without those that install or build.
pub(crate) fn commands(document: &str) -> Vec<String> {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(document)).unwrap();
    let listings = text.split("```sh\n").skip(1).filter_map(|rest| rest.split("```").next());
    let lines = listings.flat_map(str::lines).filter(|line| !line.starts_with("cargo ") && !line.starts_with("pip "));
    lines.map(str::to_owned).collect()
}

/// The targets of the links in a text of a document, as paths from the root.
fn linked(text: &str, document: &str) -> Vec<String> {
    let folder = Path::new(document).parent().unwrap();
    let targets = text.split("](").skip(1).filter_map(|rest| rest.split([')', '#']).next());
    let resolved = targets.filter(|target| !target.contains(':')).map(|target| {
        let mut path = Vec::new();
        for part in folder.join(target).components() {
            match part.as_os_str().to_str().unwrap() {
                ".." => drop(path.pop()),
                "." => {}
                part => path.push(part.to_owned()),
            }
        }
        path.join("/")
    });
    resolved.collect()
}

#[test]
fn strangers_find_their_ways_from_readme_and_type_what_works() {
    let (page, root) = ("docs/project/strangers.md", Path::new(env!("CARGO_MANIFEST_DIR")));
    let read = |document: &str| std::fs::read_to_string(root.join(document)).unwrap();
    let text = read(page);
    let tasks: Vec<_> = text.split("\n## ").skip(1).collect();
    assert_eq!(tasks.len(), 8);
    for task in tasks {
        let way = linked(task, page);
        assert!(way.len() >= 2 && way.len() <= 4 && way[0] == "README.md", "{task}: {way:?}");
        for step in way.windows(2) {
            assert!(linked(&read(&step[0]), &step[0]).contains(&step[1]), "{} does not lead to {}", step[0], step[1]);
        }
    }
    let folder = tempfile::tempdir().unwrap();
    assert!(shell("eeruf examples .", folder.path()).status.success());
    let mut said = Vec::new();
    for command in commands(page) {
        let output = shell(&command, folder.path());
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        // The log of a ring in use seldom tells.
        let code = if command.contains("eeruf logs") { 3 } else { 0 };
        assert_eq!(output.status.code(), Some(code), "{command}: {error}");
        said.push((command, String::from_utf8(output.stdout).unwrap()));
    }
    let of = |part: &str| &said.iter().find(|(command, _)| command.contains(part)).unwrap().1;
    assert!(
        of("eeruf logs").starts_with("This log cannot tell") && of("eeruf logs").contains("\ndo 1: "),
        "{}",
        of("eeruf logs")
    );
    assert!(of("diagnose").contains("who is fooled | by whom"), "{}", of("diagnose"));
    assert!(of("verify").contains("verified"), "{}", of("verify"));
    assert!(of("--program rust").contains("of a ring that fires by flow"), "{}", of("--program rust"));
}

/// Returns the cell of a table's row under a heading.
fn cell(out: &str, row: &str, heading: &str) -> String {
    let cells = |line: &str| line.split('|').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
    let mut lines = out.lines().map(cells);
    let head = lines.find(|head| head.iter().any(|cell| cell == heading)).unwrap();
    let row = lines.find(|cells| cells.get(1).is_some_and(|name| name == row)).unwrap();
    row[head.iter().position(|cell| cell == heading).unwrap()].clone()
}

#[test]
fn paper_in_an_evening_runs_and_prints_its_figures() {
    let folder = tempfile::tempdir().unwrap();
    assert!(shell("eeruf examples .", folder.path()).status.success());
    let commands = commands("docs/tutorial/paper.md");
    assert!(commands.len() >= 9, "{commands:?}");
    let mut outputs = Vec::new();
    for command in &commands {
        let output = shell(command, folder.path());
        let expected = i32::from(command.contains("table-i-a.toml"));
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(expected), "{command}: {error}");
        outputs.push((command.clone(), String::from_utf8(output.stdout).unwrap()));
    }
    let of = |part: &str| &outputs.iter().find(|(command, _)| command.contains(part)).unwrap().1;
    assert!(of("lab paths").contains("110 critical paths"));
    let wall = of("scenes/wall.toml");
    let wrong = ["conventional", "comparison", "eeruf"].map(|method| cell(wall, method, "wrong, % of all"));
    assert_eq!(wrong, ["64.0", "62.8", "0.20"]);
    assert_eq!(cell(wall, "eeruf", "starved"), "7");
    assert!(of("rings/table-i-d.toml").contains("17000 us"));
    assert!(of("rings/paper-12.toml --period-only").contains("65 ms"));
    assert!(of("check_period.py").contains("65000 us is the shortest period"));
    let set_one = of("conventional,comparison,eeruf");
    assert!(outputs.iter().any(|(_, out)| out.contains("0.0 / 1.9 / 8.6") && out.contains("44.3 (")), "{set_one}");
    let set_two = of("set-two");
    assert_eq!(["conventional", "eeruf"].map(|method| cell(set_two, method, "phantom echoes")), ["148.2", "0.2"]);
}

#[test]
fn ring_in_a_tutorial_is_designed_and_checked() {
    let folder = tempfile::tempdir().unwrap();
    assert!(shell("eeruf examples .", folder.path()).status.success());
    for command in commands("docs/tutorial/ring.md") {
        let output = shell(&command, folder.path());
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(0), "{command}: {error}");
    }
}
