//! Makes one of the counted calls, by its number, and prints the result; without a number it makes none.

use eeruf_benches::CALLS;

fn main() {
    let number = std::env::args().nth(1).and_then(|number| number.parse::<usize>().ok());
    if let Some((name, call)) = number.and_then(|number| CALLS.get(number)) {
        println!("{name}: {:?}", call());
    }
}
