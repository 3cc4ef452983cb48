//! Checks which choices go together.

use super::table::{Method, MethodRow, Setting, Subject, TABLE};
use super::{Engine, Finder, Settings, listed};
use crate::message::{Field, Message, Piece, Worded, pieces, plain_display};

/// Two choices that do not go together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Misfit {
    /// The technique does not draw that subject on any machine.
    Technique {
        /// The technique.
        method: Method,
        /// What it was to draw.
        subject: Subject,
    },
    /// The technique draws that subject only on the other machine.
    Engine {
        /// The technique.
        method: Method,
        /// The machine that was asked.
        engine: Engine,
        /// What it was to draw.
        subject: Subject,
    },
    /// The technique does not use the option.
    Setting {
        /// The option.
        setting: Setting,
        /// The machine that was asked.
        engine: Engine,
        /// What is drawn.
        subject: Subject,
    },
    /// The technique cannot use the finder.
    Finder {
        /// The technique.
        method: Method,
    },
}

impl Misfit {
    /// The field of the choice that does not fit.
    pub fn field(&self) -> Field {
        match self {
            Misfit::Technique { .. } => Field::Technique,
            Misfit::Engine { .. } => Field::Engine,
            Misfit::Setting { setting, .. } => setting.field(),
            Misfit::Finder { .. } => Setting::Finder.field(),
        }
    }

    fn what_and_hint(&self) -> (String, Vec<Piece>) {
        match *self {
            Misfit::Technique { method, subject } => {
                let others = listed(&subject.drawn_by(Engine::Auto), "or");
                (format!("{method} does not draw {}", subject.name()), pieces![format!("take {others}")])
            }
            Misfit::Engine { method, engine, subject } => {
                let other = if engine == Engine::Gpu { Engine::Cpu } else { Engine::Gpu };
                let hint = match subject.drawn_by(engine).as_slice() {
                    [] => pieces!["leave it out, as nothing else draws that on the other machine"],
                    others => pieces![format!("leave it out, or take {} with {engine}", listed(others, "or"))],
                };
                (format!("{method} draws {} on the {other} alone", subject.name()), hint)
            }
            Misfit::Setting { setting, engine, subject } => users_and_hint(setting, engine, subject),
            Misfit::Finder { method } => {
                let finders: Vec<_> = method.row().finders.iter().map(|finder| finder.word()).collect();
                let what = format!("{method} uses {} alone", listed(&finders, "and"));
                (what, pieces!["take one of them, or leave it out"])
            }
        }
    }

    /// What the technique would draw, where it does not draw what was asked: what is chosen in the same way, since a
    /// command that draws a plan need not have views.
    fn draws_instead(&self) -> Option<(Method, Vec<Subject>)> {
        let (method, asked, instead) = match *self {
            Misfit::Technique { method, subject } => (method, subject, either(method.row())),
            Misfit::Engine { method, engine: Engine::Gpu, subject } => (method, subject, method.row().on_gpu),
            Misfit::Engine { method, subject, .. } => (method, subject, method.row().on_cpu),
            Misfit::Setting { .. } | Misfit::Finder { .. } => return None,
        };
        // two subjects may be asked by one word: which of them it is, the site says
        let is_another_word = |subject: &&Subject| {
            let (field, word) = subject.choice();
            field == asked.choice().0 && word != asked.choice().1
        };
        let mut instead: Vec<Subject> = instead.iter().filter(is_another_word).copied().collect();
        instead.dedup_by_key(|subject| subject.choice());
        (!instead.is_empty()).then_some((method, instead))
    }
}

/// Who uses an option, and how they are asked for: without the machine that was asked, where none of them draws on it.
fn users_and_hint(setting: Setting, engine: Engine, subject: Subject) -> (String, Vec<Piece>) {
    let users = |engine| {
        let users = TABLE.iter().filter(|row| row.uses(setting) && row.draws(engine, subject));
        users.map(|row| row.word).collect::<Vec<_>>()
    };
    let (all, there) = (users(Engine::Auto), users(engine));
    let (users, on) = match there.len() {
        0 => (&all, String::new()),
        some if some == all.len() => (&all, String::new()),
        _ => (&there, format!(" on the {engine}")),
    };
    let (what, them) = match users.as_slice() {
        [] => return (format!("nothing that draws {} uses it", subject.name()), pieces!["leave it out"]),
        [user] => (format!("only {user} uses it{on}"), "that technique"),
        users => (format!("only {} use it{on}", listed(users, "and")), "one of them"),
    };
    let hint = match there.is_empty() {
        true => pieces!["take ", them, " without ", (Field::Engine, engine.word()), ", or leave it out"],
        false => pieces!["take ", them, ", or leave it out"],
    };
    (what, hint)
}

/// What a technique draws on the machine where it draws more.
fn either(row: &MethodRow) -> &'static [Subject] {
    if row.on_cpu.len() > row.on_gpu.len() { row.on_cpu } else { row.on_gpu }
}

plain_display!(Misfit);

impl Worded for Misfit {
    /// With what the technique would draw, where it does not draw what was asked.
    fn message(&self) -> Message {
        let (what, mut hint) = self.what_and_hint();
        if let Some((method, subjects)) = self.draws_instead() {
            let mut instead = pieces![format!("; {method} goes with ")];
            for (at, subject) in subjects.iter().enumerate() {
                let gap = match at {
                    0 => "",
                    _ if at + 1 == subjects.len() => " or ",
                    _ => ", ",
                };
                instead.extend(pieces![gap, subject.choice()]);
            }
            // who has no such field has other ways to choose what is drawn
            hint.push(Piece::Where(Field::Receivers, instead));
        }
        Message { what: pieces![what], hint }.of(self.field().into())
    }
}

impl std::error::Error for Misfit {}

impl MethodRow {
    /// The machine that draws, if only technique and machine are chosen: the processor where the technique can use it.
    ///
    /// # Errors
    /// [`Misfit`] where the technique does not draw that, or not there.
    pub fn fit(&self, engine: Engine, subject: Subject) -> Result<Engine, Misfit> {
        let method = self.method;
        match engine {
            _ if !self.draws(Engine::Auto, subject) => Err(Misfit::Technique { method, subject }),
            _ if !self.draws(engine, subject) => Err(Misfit::Engine { method, engine, subject }),
            Engine::Auto if self.draws(Engine::Cpu, subject) => Ok(Engine::Cpu),
            Engine::Auto => Ok(Engine::Gpu),
            asked => Ok(asked),
        }
    }

    /// Returns an error if an option is given that the technique does not use; the machine that was asked is for the hint.
    ///
    /// # Errors
    /// [`Misfit::Setting`], [`Misfit::Finder`].
    pub fn check(&self, finder: Finder, settings: &Settings, engine: Engine, subject: Subject) -> Result<(), Misfit> {
        let Settings { map_size, filter, smoothie_width_m, sun_samples } = settings;
        let given = |setting: &Setting| match setting {
            Setting::Finder => finder != Finder::Auto,
            Setting::MapSize => map_size.is_some(),
            Setting::Filter => filter.is_some(),
            Setting::SmoothieWidth => smoothie_width_m.is_some(),
            Setting::SunSamples => sun_samples.is_some(),
        };
        if let Some(setting) = Setting::ALL.into_iter().find(|setting| given(setting) && !self.uses(*setting)) {
            return Err(Misfit::Setting { setting, engine, subject });
        }
        match finder {
            Finder::Auto => Ok(()),
            finder if self.finders.contains(&finder) => Ok(()),
            _ => Err(Misfit::Finder { method: self.method }),
        }
    }
}
