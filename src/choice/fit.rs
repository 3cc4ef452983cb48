//! Checks which choices fit together.

use super::table::{Method, MethodRow, Setting, Subject, TABLE};
use super::{Engine, Finder, Settings, listed};
use crate::message::{Field, Message, MessagePart, Worded, pieces, plain_display};

/// Two choices that do not fit together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Misfit {
    /// The technique does not draw that subject on any machine.
    Technique {
        /// The technique.
        method: Method,
        /// The subject that it should draw.
        subject: Subject,
    },
    /// The technique draws that subject only on the other engine.
    Engine {
        /// The technique.
        method: Method,
        /// The requested engine.
        engine: Engine,
        /// The subject that it should draw.
        subject: Subject,
    },
    /// The technique does not use the option.
    Setting {
        /// The option.
        setting: Setting,
        /// The requested engine.
        engine: Engine,
        /// The subject.
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

    fn what_and_hint(&self) -> (String, Vec<MessagePart>) {
        match *self {
            Misfit::Technique { method, subject } => {
                let others = listed(&subject.drawn_by(Engine::Auto), "or");
                (format!("{method} does not draw {}", subject.name()), pieces![format!("choose {others}")])
            }
            Misfit::Engine { method, engine, subject } => {
                let other = if engine == Engine::Gpu { Engine::Cpu } else { Engine::Gpu };
                let hint = match subject.drawn_by(engine).as_slice() {
                    [] => pieces!["leave it out, as no other technique draws that on the other engine"],
                    others => pieces![format!("leave it out, or choose {} with {engine}", listed(others, "or"))],
                };
                (format!("{method} draws {} only on the {other}", subject.name()), hint)
            }
            Misfit::Setting { setting, engine, subject } => users_and_hint(setting, engine, subject),
            Misfit::Finder { method } => {
                let finders: Vec<_> = method.row().finders.iter().map(|finder| finder.word()).collect();
                let what = format!("{method} uses only {}", listed(&finders, "and"));
                (what, pieces!["choose one of them, or leave it out"])
            }
        }
    }

    /// The subjects that the technique does draw, among those chosen by the same field, since a command that draws a
    /// plan may not have views.
    fn draws_instead(&self) -> Option<(Method, Vec<Subject>)> {
        let (method, asked, instead) = match *self {
            Misfit::Technique { method, subject } => (method, subject, either(method.row())),
            Misfit::Engine { method, engine: Engine::Gpu, subject } => (method, subject, method.row().on_gpu),
            Misfit::Engine { method, subject, .. } => (method, subject, method.row().on_cpu),
            Misfit::Setting { .. } | Misfit::Finder { .. } => return None,
        };
        // one word may mean two subjects, depending on the site
        let is_another_word = |subject: &&Subject| {
            let (field, word) = subject.choice();
            field == asked.choice().0 && word != asked.choice().1
        };
        let mut instead: Vec<Subject> = instead.iter().filter(is_another_word).copied().collect();
        instead.dedup_by_key(|subject| subject.choice());
        (!instead.is_empty()).then_some((method, instead))
    }
}

/// The techniques that use an option, and the hint to choose one of them: without the requested engine if none of them
/// draws on it.
fn users_and_hint(setting: Setting, engine: Engine, subject: Subject) -> (String, Vec<MessagePart>) {
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
        true => pieces!["choose ", them, " without ", (Field::Engine, engine.word()), ", or leave it out"],
        false => pieces!["choose ", them, ", or leave it out"],
    };
    (what, hint)
}

/// The subjects that a technique draws on the engine where it draws more.
fn either(row: &MethodRow) -> &'static [Subject] {
    if row.on_cpu.len() > row.on_gpu.len() { row.on_cpu } else { row.on_gpu }
}

plain_display!(Misfit);

impl Misfit {
    /// What is wrong and what can be done, without the field: with what the technique does draw.
    pub(crate) fn reason(&self) -> Message {
        let (what, mut hint) = self.what_and_hint();
        if let Some((method, subjects)) = self.draws_instead() {
            let mut instead = pieces![format!("; {method} can be used with ")];
            for (at, subject) in subjects.iter().enumerate() {
                let gap = match at {
                    0 => "",
                    _ if at + 1 == subjects.len() => " or ",
                    _ => ", ",
                };
                instead.extend(pieces![gap, subject.choice()]);
            }
            // a face without such a field has other ways to choose the subject
            hint.push(MessagePart::Where(Field::Receivers, instead));
        }
        Message { what: pieces![what], hint }
    }
}

impl Worded for Misfit {
    fn message(&self) -> Message {
        self.reason().of(self.field().into())
    }
}

impl std::error::Error for Misfit {}

impl MethodRow {
    /// The engine that draws if only the technique and the engine are chosen: the processor if the technique can use
    /// it.
    ///
    /// # Errors
    /// [`Misfit`] if the technique does not draw the subject, or not on that engine.
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

    /// Refuses options that the technique does not use. The requested engine is for the hint.
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
