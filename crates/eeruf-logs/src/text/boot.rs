//! Lines that a board or a monitor writes by itself: boot messages, resets, crashes, and noise from another baud rate.

/// Prefixes of the first and of the last lines of a boot message or a crash; lines in between are skipped too.
const BEGINS: &str =
    "ets J|ESP-ROM:|rst:0x|Guru Meditation Error: |Exception (|Fatal exception|abort() was called|>>>stack";
const ENDS: &str = "entry 0x|~ld|Rebooting...|<<<stack";
/// Prefixes of single lines from boards, sensors and monitors.
const ALONE: &str = "\
    Build:|SPIWP:0x|load:0x|entry 0x|Octal Flash Mode|For OPI Flash|flash read err|Brownout detector|Soft WDT reset|\
    *** Booting |main(): This is RIOT!|MPY: soft reboot|Auto-reload is on. |code.py output:|Code stopped by |\
    MaxBotix Inc.|PN:MB|RoHS |>>> %|HRXL-MaxSonar|Copyright 20|TempI|=~=~=~=~";
/// Tags of lines that ESP-IDF writes by itself.
const TAGS: &str = "\
    boot qio_mode esp_image cpu_start app_start app_init efuse_init heap_init spi_flash sleep main_task gpio uart \
    coexist coex pp net80211 wifi wifi_init phy_init system_api esp_netif_handlers task_wdt octal_psram esp_psram";
/// Largest number of lines of a boot message or a crash.
const LONGEST: u32 = 60;

/// A recogniser of a board's lines.
pub(super) struct Boot {
    /// The words of `BEGINS`, `ENDS` and `ALONE`, split once because each line is compared with all of them.
    lists: [Vec<&'static str>; 3],
    /// Number of lines that may still follow in a boot message or a crash.
    left: u32,
}

impl Default for Boot {
    fn default() -> Self {
        Self { lists: [BEGINS, ENDS, ALONE].map(|list| list.split('|').collect()), left: 0 }
    }
}

impl Boot {
    /// Returns true for a line that a board or a monitor writes by itself.
    pub(super) fn is_boot(&mut self, line: &str) -> bool {
        let text = line.trim();
        let Some(&first) = text.as_bytes().first() else { return self.left > 0 };
        // No line of a board begins with a digit.
        if self.left == 0 && first.is_ascii_digit() {
            return false;
        }
        let [begins, ends, alone] = &self.lists;
        let is_of = |list: &[&str]| list.iter().any(|own| own.as_bytes()[0] == first && text.starts_with(own));
        if is_of(begins) {
            self.left = LONGEST;
        }
        if self.left > 0 {
            self.left = if is_of(ends) { 0 } else { self.left - 1 };
            return true;
        }
        // `--- Terminal on COM3`, as monitors say.
        let is_monitor = text.strip_prefix("--- ").is_some_and(|rest| rest.starts_with(char::is_alphabetic));
        is_of(alone) || is_monitor || is_of_esp_idf(text)
    }
}

/// Returns true for `I (29) boot: ...` and for a warning that names one of the same tags.
fn is_of_esp_idf(text: &str) -> bool {
    let rest = text.strip_prefix(['E', 'W', 'I', 'D', 'V']).and_then(|rest| rest.strip_prefix(" ("));
    let said = rest.and_then(|rest| rest.split_once(") ")).and_then(|(_, said)| said.split_once(':'));
    said.is_some_and(|(tag, _)| TAGS.split(' ').any(|own| tag == own || tag.starts_with("boot.esp32")))
}

/// Returns true for a line at least half of which is not text, such as one from another baud rate.
pub(super) fn is_noise(line: &str) -> bool {
    let is_odd = |letter: &char| *letter == '\u{fffd}' || (letter.is_control() && *letter != '\t');
    let odd = line.chars().filter(is_odd).count();
    odd >= 4 && odd * 2 >= line.chars().count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_of_sensors_are_none_of_a_board() {
        let lines = "load: 40 cm|ets: 40|PC: 40|A2: 40 A6: 80|tail: 4|mode: 4|--- 40 80|---|12345678: 40|v1: 40|\
                     Distance: 4ets Jul 29 2019 12:21:46|I (500) sonar: Distance: 40 cm";
        lines.split('|').for_each(|line| assert!(!Boot::default().is_boot(line), "{line}"));
        assert!(!is_noise("fr\u{fffd}nt: 4\u{fffd} cm"));
    }
}
