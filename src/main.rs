//! The front door: reads the command line, calls one crate, prints what it says.
//!
//! Exit codes: 0 done, 1 failed, 2 the input or the command is wrong.

mod analyse;
mod command_line;
mod console;
mod exit_code;
mod render;
mod replicate;
mod sit;

use std::process::ExitCode;

use clap::Parser as _;
use command_line::{Command, CommandLine};
use console::Console;

fn main() -> ExitCode {
    let arguments = CommandLine::parse();
    let console = Console::new(arguments.quiet);
    match run(arguments.command, &console) {
        Ok(code) => code,
        Err(error) => {
            console.error(&error);
            exit_code::of(&error)
        }
    }
}

fn run(command: Command, console: &Console) -> anyhow::Result<ExitCode> {
    match command {
        Command::Check(arguments) => return sit::check(&arguments, console),
        Command::Render(arguments) => render::set(&arguments, console)?,
        Command::Image(arguments) => render::image(&arguments, console)?,
        Command::Figures(arguments) => render::figures(&arguments, console)?,
        Command::Run(arguments) => sit::run(&arguments, console)?,
        Command::Simulate(arguments) => sit::simulate(&arguments, console)?,
        Command::Report(arguments) => analyse::report(&arguments, console)?,
        Command::Anova(arguments) => analyse::anova(&arguments, console)?,
        Command::Replicate(arguments) => replicate::replicate(&arguments, console)?,
    }
    Ok(ExitCode::SUCCESS)
}
