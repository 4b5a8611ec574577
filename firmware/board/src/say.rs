//! Output through the debugger (semihosting), without `core::fmt`, which can panic and takes kilobytes.

use core::fmt::Write;
use core::panic::PanicInfo;

/// A value that can be written on one line.
pub trait Say {
    /// Writes the value.
    fn say(&self);
}

impl Say for &str {
    fn say(&self) {
        // In short pieces, because the debugger needs a zero byte at the end.
        let mut piece = [0; 33];
        let mut length = 0;
        for byte in self.bytes() {
            if let Some(place) = piece.get_mut(length) {
                *place = byte;
            }
            length += 1;
            if length == 32 {
                write(&piece);
                piece = [0; 33];
                length = 0;
            }
        }
        write(&piece);
    }
}

fn write(text: &[u8; 33]) {
    if let Ok(text) = core::ffi::CStr::from_bytes_until_nul(text) {
        semihosting::sys::arm_compat::sys_write0(text);
    }
}

impl Say for u32 {
    fn say(&self) {
        let mut digits = [0; 12];
        let mut rest = *self;
        for place in digits.iter_mut().take(11).rev() {
            *place = b'0' + (rest % 10) as u8;
            rest /= 10;
        }
        let first = digits.iter().position(|&digit| digit != b'0').unwrap_or(10).min(10);
        if let Some(text) = digits.get(first..11)
            && let Ok(text) = core::str::from_utf8(text)
        {
            text.say();
        }
    }
}

impl Say for u8 {
    fn say(&self) {
        u32::from(*self).say();
    }
}

impl Say for i32 {
    fn say(&self) {
        if *self < 0 {
            "-".say();
        }
        self.unsigned_abs().say();
    }
}

/// Writes some values one after the other and ends the line.
#[macro_export]
macro_rules! say {
    ($($what:expr),* $(,)?) => {{
        $($crate::say::Say::say(&$what);)*
        $crate::say::Say::say(&"\n");
    }};
}

/// Ends the program; 0 is success.
pub fn leave(code: i32) -> ! {
    semihosting::process::exit(code)
}

struct Debugger;

impl Write for Debugger {
    fn write_str(&mut self, text: &str) -> core::fmt::Result {
        text.say();
        Ok(())
    }
}

/// Prints where and why the program panicked, and exits with code 101.
pub fn panicked(info: &PanicInfo<'_>) -> ! {
    // Nothing can be done about a debugger that does not listen.
    let _ = writeln!(Debugger, "{info}");
    leave(101)
}
