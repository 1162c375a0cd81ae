//! The front door: reads the command line, calls one crate, prints what it says.
//!
//! Exit codes: 0 done, 1 failed, 2 the input or the command is wrong, 130 interrupted.

mod acuity_comparison;
mod analyse;
mod analysis_arguments;
mod app;
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
    let Some(command) = arguments.command else {
        return without_command();
    };
    match run(command, progress) {
        Ok(code) => code,
        Err(error) => {
            console::print_error(&error);
            exit_code::of(&error)
        }
    }
}

/// `acuity` alone opens the app; where there is no display it says so, and what else there is.
fn without_command() -> ExitCode {
    if !app::has_display() {
        return console::print_help(
            "found no DISPLAY, expected a desktop for the app's window; log in to one, or name a command",
        );
    }
    match app::open(None) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            console::print_error(&error);
            exit_code::of(&error)
        }
    }
}

fn run(command: Command, progress: Progress) -> anyhow::Result<ExitCode> {
    match command {
        Command::App(arguments) => app::open(Some(&arguments.protocol))?,
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
