//! What a panic would do, if one were left.

/// As in the firmware images: what could panic would not link.
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    unsafe extern "C" {
        fn a_path_to_a_panic_is_left_in_this_image() -> !;
    }
    // SAFETY: never executed; the symbol does not exist.
    unsafe { a_path_to_a_panic_is_left_in_this_image() }
}
