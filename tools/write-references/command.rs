//! The options of every subcommand, from clap's own definitions.

use super::blocks::{Block, head, row};
use clap::{Arg, Command};

/// Where options are explained that several subcommands have.
const SHARED: &str = "shared";

/// A subcommand and its options.
struct Subcommand {
    name: String,
    about: String,
    usage: String,
    inputs: Vec<Entry>,
    options: Vec<Entry>,
}

/// An option, or an input without a name, as the page shows it.
#[derive(Clone, PartialEq)]
struct Entry {
    /// With its value.
    written: String,
    meaning: String,
}

/// A block for the list of subcommands, one for each of them, and one for what they share.
pub(super) fn blocks() -> Vec<Block> {
    let mut command = gnomon::cli::definition();
    command.build();
    let shown = command.get_subcommands_mut().filter(|command| command.get_name() != "help" && !command.is_hide_set());
    let subcommands: Vec<Subcommand> = shown.map(subcommand).collect();
    let shared = shared(&subcommands);
    let mut blocks =
        vec![("commands".to_owned(), list(&subcommands)), (SHARED.to_owned(), shared_table(&subcommands, &shared))];
    blocks.extend(subcommands.iter().map(|command| (command.name.clone(), section(command, &shared))));
    blocks
}

fn subcommand(command: &mut Command) -> Subcommand {
    let usage = command.render_usage().to_string();
    let actions: Vec<Entry> =
        command.get_subcommands_mut().filter(|action| action.get_name() != "help").map(action).collect();
    let is_own = |arg: &&Arg| !["help", "version"].contains(&arg.get_id().as_str());
    let shown = |is_input: bool| {
        let args = command.get_arguments().filter(is_own).filter(move |arg| arg.is_positional() == is_input);
        args.map(option).collect::<Vec<_>>()
    };
    Subcommand {
        name: command.get_name().to_owned(),
        about: command.get_about().map(ToString::to_string).unwrap_or_default(),
        usage: usage.trim_start_matches("Usage: ").to_owned(),
        inputs: actions.into_iter().chain(shown(true)).collect(),
        options: shown(false),
    }
}

/// What a subcommand can be asked for by a word of its own, as `show ID`.
fn action(command: &mut Command) -> Entry {
    let inputs = command.get_positionals().flat_map(|arg| arg.get_value_names().unwrap_or_default());
    let words: Vec<_> = [command.get_name()].into_iter().chain(inputs.map(|name| name.as_str())).collect();
    let meaning = command.get_about().map(ToString::to_string).unwrap_or_default();
    Entry { written: format!("`{}`", words.join(" ")), meaning }
}

fn option(arg: &Arg) -> Entry {
    let takes = arg.get_action().takes_values();
    let values: Vec<_> =
        arg.get_value_names().unwrap_or_default().iter().filter(|_| takes).map(|name| name.as_str()).collect();
    let written: Vec<_> = arg
        .get_long()
        .map(|name| format!("--{name}"))
        .into_iter()
        .chain(values.iter().map(|name| (*name).to_owned()))
        .collect();
    let mut meaning = arg.get_help().map(ToString::to_string).unwrap_or_default();
    let words: Vec<_> = arg.get_possible_values().iter().map(|value| value.get_name().to_owned()).collect();
    let is_listed = values.iter().any(|value| words.iter().all(|word| value.contains(word.as_str())));
    if takes && !words.is_empty() && !is_listed {
        meaning.push_str(&format!(": {}", words.join(", ")));
    }
    let defaults: Vec<_> = arg.get_default_values().iter().map(|value| value.to_string_lossy().into_owned()).collect();
    if takes && !defaults.is_empty() {
        meaning.push_str(&format!(" [default: {}]", defaults.join(",")));
    }
    Entry { written: format!("`{}`", written.join(" ")), meaning }
}

/// What at least two subcommands say in the same words.
fn shared(commands: &[Subcommand]) -> Vec<Entry> {
    let mut shared: Vec<Entry> = Vec::new();
    for option in commands.iter().flat_map(|command| &command.options) {
        let having = commands.iter().filter(|command| command.options.contains(option)).count();
        if having > 1 && !shared.contains(option) {
            shared.push(option.clone());
        }
    }
    shared
}

fn list(commands: &[Subcommand]) -> String {
    let mut table = head(["command", "what it does"]);
    for command in commands {
        let link = format!("[`gnomon {name}`](#gnomon-{name})", name = command.name);
        table.push_str(&row([&link, &command.about]));
    }
    table
}

fn section(command: &Subcommand, shared: &[Entry]) -> String {
    let mut text = format!("```\n{}\n```\n\n", command.usage);
    let (common, own): (Vec<_>, Vec<_>) = command.options.iter().partition(|option| shared.contains(option));
    text.push_str(&head(["input or option", "meaning"]));
    for option in command.inputs.iter().chain(own) {
        text.push_str(&row([&option.written, &option.meaning]));
    }
    let names: Vec<_> = common.iter().map(|option| option.written.as_str()).collect();
    if !names.is_empty() {
        text.push_str(&format!("\n[Shared options](#shared-options): {}\n", names.join(", ")));
    }
    text
}

fn shared_table(commands: &[Subcommand], shared: &[Entry]) -> String {
    let mut table = head(["option", "meaning", "commands"]);
    for option in shared {
        let having = commands.iter().filter(|command| command.options.contains(option));
        let names: Vec<_> = having.map(|command| command.name.as_str()).collect();
        table.push_str(&row([&option.written, &option.meaning, &names.join(", ")]));
    }
    table
}
