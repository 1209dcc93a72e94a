//! The program `psd`. It calls the module `cli` of the library.

fn main() -> std::process::ExitCode {
    psd::cli::main(std::env::args_os()).into()
}
