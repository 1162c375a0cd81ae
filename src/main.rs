//! The front door: reads the command line, calls one crate, prints what it says.
//!
//! Exit codes: 0 done, 1 failed, 2 the input or the command is wrong, 130 interrupted.

mod acuity_comparison;
mod analyse;
mod analysis_arguments;
mod command_line;
mod console;
mod exit_code;
mod follow_up;
mod image;
mod interrupt;
mod memory;
mod power;
mod predict;
mod render;
mod replicate;
mod sit;
mod station;
mod stopwatch;
mod table_report;

use std::process::ExitCode;

use clap::Parser as _;
use command_line::{Command, CommandLine};
use console::Progress;

fn main() -> ExitCode {
    let arguments = CommandLine::parse();
    let progress = if arguments.quiet {
        Progress::Silent
    } else {
        Progress::Drawn
    };
    match run(arguments.command, progress) {
        Ok(code) => code,
        Err(error) => {
            console::print_error(&error);
            exit_code::of(&error)
        }
    }
}

fn run(command: Command, progress: Progress) -> anyhow::Result<ExitCode> {
    match command {
        Command::Check(arguments) => return sit::check(&arguments),
        Command::Render(arguments) => render::set(&arguments, progress)?,
        Command::Image(arguments) => image::image(&arguments, progress)?,
        Command::Figures(arguments) => render::figures(&arguments)?,
        Command::Run(arguments) => sit::run(&arguments)?,
        Command::View(arguments) => experiment::experimenters_view(arguments.monitor)?,
        Command::Close(arguments) => sit::close(&arguments)?,
        Command::Station(arguments) => station::measure(&arguments)?,
        Command::Export(arguments) => sit::export(&arguments)?,
        Command::Simulate(arguments) => sit::simulate(&arguments, progress)?,
        Command::Predict(arguments) => predict::predict(&arguments)?,
        Command::Power(arguments) => power::power(&arguments, progress)?,
        Command::Report(arguments) => analyse::report(&arguments)?,
        Command::Anova(arguments) => analyse::anova(&arguments)?,
        Command::Replicate(arguments) => replicate::replicate(&arguments, progress)?,
    }
    Ok(ExitCode::SUCCESS)
}
