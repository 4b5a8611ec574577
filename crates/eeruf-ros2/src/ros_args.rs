//! The arguments that ROS 2 passes to a node, `--ros-args .. --`, and the names that follow from them.

/// ROS's arguments for the node: its name, its namespace, its parameters and remappings of topics.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RosArgs {
    pub(crate) node: String,
    /// The namespace from the root, without a final slash: empty, or such as `/robot_1`.
    namespace: String,
    /// Pairs of old and new name, in order, not yet expanded.
    rules: Vec<(String, String)>,
    pub(crate) given: Vec<Given>,
}

/// Parameters, in the order in which they were given.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Given {
    File(String),
    /// A name and its value in YAML.
    One(String, String),
}

impl Default for RosArgs {
    fn default() -> Self {
        Self { node: "eeruf".to_owned(), namespace: String::new(), rules: Vec::new(), given: Vec::new() }
    }
}

impl RosArgs {
    /// Removes the parts from `--ros-args` to `--` or the end from a command line, and parses them.
    pub(crate) fn take_from(arguments: &mut Vec<String>) -> Result<Self, String> {
        let (mut own, mut ros) = (Vec::new(), None);
        let mut read = Self::default();
        for argument in arguments.drain(..) {
            match (&mut ros, &*argument) {
                (None, "--ros-args") => ros = Some(Vec::new()),
                (None, _) => own.push(argument),
                (Some(_), "--") => read.read(ros.take().unwrap_or_default())?,
                (Some(_), "--ros-args") => {}
                (Some(ros), _) => ros.push(argument),
            }
        }
        read.read(ros.unwrap_or_default())?;
        *arguments = own;
        Ok(read)
    }

    fn read(&mut self, arguments: Vec<String>) -> Result<(), String> {
        let mut arguments = arguments.into_iter();
        while let Some(flag) = arguments.next() {
            let mut value = || arguments.next().ok_or_else(|| format!("--ros-args: {flag} without a value"));
            match &*flag {
                "-r" | "--remap" => self.remap(&value()?)?,
                "-p" | "--param" => {
                    let rule = value()?;
                    let (name, yaml) = split(&rule, "name:=value")?;
                    if let Some(name) = self.own(name) {
                        self.given.push(Given::One(name.to_owned(), yaml.to_owned()));
                    }
                }
                "--params-file" => self.given.push(Given::File(value()?)),
                // The node's output goes to standard error at any level, and the node has no enclave.
                "--log-level" | "--log-config-file" | "--log-file-name" | "-e" | "--enclave" => {
                    value()?;
                }
                _ if ["rosout-logs", "stdout-logs", "external-lib-logs"].iter().any(|logs| flag.ends_with(logs)) => {}
                _ => {
                    let known = "-r FROM:=TO, -p NAME:=VALUE, --params-file FILE";
                    return Err(format!("--ros-args: {flag}; expected {known}, or -- at their end"));
                }
            }
        }
        Ok(())
    }

    fn remap(&mut self, rule: &str) -> Result<(), String> {
        let (from, to) = split(rule, "from:=to")?;
        let Some(from) = self.own(from) else { return Ok(()) };
        match from {
            "__node" | "__name" => self.node = to.to_owned(),
            "__ns" => {
                if !to.starts_with('/') {
                    return Err(format!("--ros-args: {rule}; expected a namespace from the root, as __ns:=/robot_1"));
                }
                self.namespace = to.trim_end_matches('/').to_owned();
            }
            _ => self.rules.push((from.to_owned(), to.to_owned())),
        }
        Ok(())
    }

    /// Returns the left side of a rule without the node's name; `None` if the rule is for another node.
    fn own<'r>(&self, name: &'r str) -> Option<&'r str> {
        match name.split_once(':') {
            Some((node, rest)) => (node == self.node).then_some(rest),
            None => Some(name),
        }
    }

    /// Returns the namespace in ROS's form: `/` or `/robot_1`.
    pub(crate) fn namespace(&self) -> &str {
        if self.namespace.is_empty() { "/" } else { &self.namespace }
    }

    /// Returns the node's full name, such as `/robot_1/eeruf`.
    pub(crate) fn full_name(&self) -> String {
        format!("{}/{}", self.namespace, self.node)
    }

    /// The full name of a topic: `~` stands for the node, other names are within its namespace. The first matching rule
    /// renames it.
    pub(crate) fn topic(&self, name: &str) -> String {
        let full = self.expand(name);
        let renamed = self.rules.iter().find(|(from, _)| self.expand(from) == full);
        renamed.map_or(full, |(_, to)| self.expand(to))
    }

    fn expand(&self, name: &str) -> String {
        match name.strip_prefix('~') {
            Some(rest) => format!("{}/{}", self.full_name(), rest.trim_start_matches('/')),
            None if name.starts_with('/') => name.to_owned(),
            None => format!("{}/{name}", self.namespace),
        }
    }
}

fn split<'r>(rule: &'r str, expected: &str) -> Result<(&'r str, &'r str), String> {
    rule.split_once(":=").ok_or_else(|| format!("--ros-args: {rule}; expected {expected}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn taken(line: &str) -> (Vec<String>, RosArgs) {
        let mut arguments = line.split(' ').map(str::to_owned).collect();
        let read = RosArgs::take_from(&mut arguments).unwrap();
        (arguments, read)
    }

    #[test]
    fn ros_arguments_are_taken_out_of_the_others() {
        let (own, read) = taken(
            "--log a.csv --ros-args -r __node:=left -r __ns:=/robot_1/ --params-file p.yaml -p sensors:=4 \
             -p right:sensors:=5 -p left:baud:=9600 --log-level debug --disable-rosout-logs -- --port /dev/x \
             --ros-args --remap ~/sonar_1:=front",
        );
        assert_eq!(own.join(" "), "--log a.csv --port /dev/x");
        assert_eq!((&*read.node, read.namespace(), &*read.full_name()), ("left", "/robot_1", "/robot_1/left"));
        let one = |name: &str, value: &str| Given::One(name.to_owned(), value.to_owned());
        assert_eq!(read.given, [Given::File("p.yaml".to_owned()), one("sensors", "4"), one("baud", "9600")]);
        assert_eq!(read.topic("~/sonar_1"), "/robot_1/front");
    }

    #[test]
    fn names_are_expanded_and_renamed_as_ros_does() {
        let (_, bare) = taken("--port x");
        assert_eq!((bare.namespace(), &*bare.full_name()), ("/", "/eeruf"));
        for (name, full) in [("~/a", "/eeruf/a"), ("a/b", "/a/b"), ("/diagnostics", "/diagnostics")] {
            assert_eq!(bare.topic(name), full);
        }
        let (_, read) = taken("--ros-args -r __ns:=/n -r a:=b -r /n/a:=c -r /tf_static:=tf_static -r ~/p:=~/q/r");
        for (name, full) in
            [("a", "/n/b"), ("/n/a", "/n/b"), ("/a", "/a"), ("/tf_static", "/n/tf_static"), ("~/p", "/n/eeruf/q/r")]
        {
            assert_eq!(read.topic(name), full);
        }
    }

    #[test]
    fn wrong_ros_arguments_are_named() {
        let wrong = |line: &str| RosArgs::take_from(&mut line.split(' ').map(str::to_owned).collect()).unwrap_err();
        assert_eq!(wrong("--ros-args -r a=b"), "--ros-args: a=b; expected from:=to");
        assert_eq!(wrong("--ros-args -p"), "--ros-args: -p without a value");
        assert!(wrong("--ros-args --port x").starts_with("--ros-args: --port; expected -r FROM:=TO"));
        assert!(wrong("--ros-args -r __ns:=a").ends_with("as __ns:=/robot_1"));
    }
}
