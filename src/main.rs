//! The program `psd`. Everything it does is in the library's `cli`.

fn main() -> std::process::ExitCode {
    psd::cli::main(std::env::args_os()).into()
}
