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
                    $crate::semihosting::println!("error: {error}");
                    $crate::semihosting::process::exit(1)
                }
            }
        }

        #[panic_handler]
        fn panic(info: &core::panic::PanicInfo) -> ! {
            $crate::semihosting::println!("{info}");
            $crate::semihosting::process::exit(1)
        }
    };
}
