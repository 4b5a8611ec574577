//! Lines that a board or a monitor writes by itself: start messages, resets, crashes, and noise at another baud rate.

/// Beginnings of lines of an ESP32, an ESP8266, MicroPython, `CircuitPython`, `MaxBotix`'s sensors, and of monitors.
const BEGINNINGS: [&str; 53] = [
    "ets Jan ",
    "ets Jun ",
    "ets Jul ",
    "ESP-ROM:",
    "Build:",
    "rst:0x",
    "configsip: ",
    "SPIWP:0x",
    "clk_drv:0x",
    "mode:DIO, ",
    "mode:QIO, ",
    "mode:DOUT, ",
    "mode:QOUT, ",
    "load:0x",
    "load 0x",
    "entry 0x",
    "Saved PC:0x",
    "Octal Flash Mode Enabled",
    "For OPI Flash, Use Default Flash Boot Mode",
    "flash read err, ",
    "ets_main.c ",
    "Guru Meditation Error: Core ",
    "register dump:",
    "Backtrace: 0x",
    "Backtrace:0x",
    "ELF file SHA256: ",
    "Rebooting...",
    "Brownout detector was triggered",
    "abort() was called at PC 0x",
    "Exception (",
    "Fatal exception(",
    "Fatal exception (",
    "epc1=0x",
    ">>>stack>>>",
    "<<<stack<<<",
    "ctx: ",
    "sp: 3f",
    "chksum 0x",
    "csum 0x",
    "~ld",
    "Soft WDT reset",
    "last failed alloc call: ",
    "E BOD: Brownout detector ",
    "*** Booting Zephyr OS ",
    "main(): This is RIOT!",
    "MPY: soft reboot",
    "Auto-reload is on. ",
    "code.py output:",
    "Code stopped by auto-reload. ",
    "MaxBotix Inc.",
    "PN:MB",
    "RoHS ",
    "=~=~=~=~",
];

/// Tags of lines that ESP-IDF writes by itself.
const TAGS: [&str; 30] = [
    "boot",
    "boot.esp32",
    "boot.esp32s2",
    "boot.esp32s3",
    "boot.esp32c3",
    "boot.esp32c6",
    "qio_mode",
    "esp_image",
    "cpu_start",
    "app_start",
    "app_init",
    "efuse_init",
    "heap_init",
    "spi_flash",
    "sleep",
    "main_task",
    "gpio",
    "uart",
    "coexist",
    "coex",
    "pp",
    "net80211",
    "wifi",
    "wifi_init",
    "phy_init",
    "system_api",
    "esp_netif_handlers",
    "task_wdt",
    "octal_psram",
    "esp_psram",
];

/// Names of registers in the dump of a crash.
const REGISTERS: [&str; 10] = ["PC", "A2", "A6", "A10", "A14", "SAR", "EXCVADDR", "MEPC", "RA", "Stack memory"];

/// Returns true for a line that a board or a monitor writes by itself.
pub(super) fn is_boot(line: &str) -> bool {
    let text = line.trim();
    // Nearly all lines of tables.
    if text.starts_with(|letter: char| letter.is_ascii_digit() || "{\"[".contains(letter)) {
        return is_dump(text);
    }
    BEGINNINGS.iter().any(|beginning| text.starts_with(beginning))
        || is_of_esp_idf(text)
        || is_dump(text)
        || is_of_loader(text)
        // `--- Terminal on COM3`, as monitors say.
        || text.strip_prefix("--- ").is_some_and(|rest| rest.starts_with(char::is_alphabetic))
        || (text.starts_with("Core ") && text.ends_with("register dump:"))
        || (text.starts_with("Copyright ") && text.len() < 24)
        || (text.len() < 40 && !text.contains([':', '=']) && text.contains("MaxSonar"))
        || text == "TempI"
}

/// Returns true for `ho 0 tail 12 room 4`, `tail 4` and `v00074f70`, as the ROM's loader says.
fn is_of_loader(text: &str) -> bool {
    if !["ho ", "tail ", "v"].iter().any(|beginning| text.starts_with(beginning)) {
        return false;
    }
    let words: Vec<_> = text.split_whitespace().collect();
    let is_whole = |word: &str| !word.is_empty() && word.bytes().all(|byte| byte.is_ascii_digit());
    match words[..] {
        ["ho", ho, "tail", tail, "room", room] => [ho, tail, room].into_iter().all(is_whole),
        ["tail", tail] => is_whole(tail),
        [version] => version.len() == 9 && version.strip_prefix('v').is_some_and(is_hexadecimal),
        _ => false,
    }
}

/// Returns true for `I (29) boot: ...` and for a warning that names one of the same tags.
fn is_of_esp_idf(text: &str) -> bool {
    let rest = text.strip_prefix(['E', 'W', 'I', 'D', 'V']).and_then(|rest| rest.strip_prefix(" ("));
    let said = rest.and_then(|rest| rest.split_once(") ")).and_then(|(_, said)| said.split_once(':'));
    said.is_some_and(|(tag, _)| TAGS.contains(&tag))
}

fn is_hexadecimal(word: &str) -> bool {
    word.len() == 8 && word.bytes().all(|byte| byte.is_ascii_hexdigit())
}

/// Returns true for a line of registers or of a stack: `PC      : 0x400d1234`, `3fffff50:  3ffe84c8 00000020`.
fn is_dump(text: &str) -> bool {
    let Some((name, rest)) = text.split_once(':') else { return false };
    let mut words = rest.split_whitespace().map(|word| word.trim_end_matches('<')).peekable();
    if is_hexadecimal(name.trim_start_matches("0x")) {
        return words.peek().is_some() && words.all(|word| is_hexadecimal(word.trim_start_matches("0x")));
    }
    let is_address = |word: &str| word.strip_prefix("0x").is_some_and(is_hexadecimal);
    REGISTERS.contains(&name.trim_end()) && words.peek().is_some_and(|word| is_address(word))
}

/// Returns true for a line that is half no text, as what was sent at another baud rate.
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
        for line in [
            "load: 40 cm",
            "ets: 40",
            "PC: 40",
            "A2: 40 A6: 80",
            "tail: 4",
            "tail 4 head 8",
            "mode: 4",
            "--- 40 80",
            "---",
            "Distance: 4ets Jul 29 2019 12:21:46",
            "I (500) sonar: Distance: 40 cm",
            "12345678: 40",
            "v1: 40",
        ] {
            assert!(!is_boot(line), "{line}");
        }
        assert!(!is_noise("fr\u{fffd}nt: 4\u{fffd} cm"));
    }
}
