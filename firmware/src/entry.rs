//! Entry of a program: `program!(run)` makes `fn run() -> Result<(), &'static str>` the main function of a board, and
//! leaves an empty one on the host.

/// Makes `run` the program; its error is printed and becomes exit status 1, and so does a panic.
#[macro_export]
macro_rules! program {
    ($run:path) => {
        #[$crate::start]
        fn main() -> ! {
            match $run() {
                Ok(()) => $crate::semihosting::process::exit(0),
                Err(error) => {
                    $crate::fatal!("error: {}", error);
                    $crate::semihosting::process::exit(1)
                }
            }
        }

        $crate::panic_handler!();
    };
}

/// A panic is printed and becomes exit status 1.
#[macro_export]
macro_rules! panic_handler {
    () => {
        #[panic_handler]
        fn panic(info: &core::panic::PanicInfo) -> ! {
            $crate::entry::tell(info);
            $crate::semihosting::process::exit(1)
        }
    };
}

/// Prints why the program panicked.
#[doc(hidden)]
pub fn tell(info: &core::panic::PanicInfo) {
    #[cfg(feature = "defmt")]
    crate::fatal!("{}", crate::log::defmt::Display2Format(info));
    #[cfg(not(feature = "defmt"))]
    crate::fatal!("{}", info);
}
