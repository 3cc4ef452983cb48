//! The answer of judging a site by a rule, and the geometry of what is judged: where points lie in windows, along plots
//! and on areas. The light at these points is found by `study::judge`.

mod answer;
mod counted_parts;
mod lit_spell;
mod narrow;
mod opening;
mod plot_lines;
mod triangles;

pub use answer::{
    AreaSize, DayCount, ERROR_ODDS, GroupKind, GroupRuling, JudgedThing, Judgement, ReceiverRuling, ReceiverSpells,
    Taker,
};
pub use counted_parts::CountedParts;
pub use lit_spell::{LitSpell, SpellBound, both, clipped, spells_of};
pub use opening::{Opening, WindowSpot, needed_of_window, window_spot};
pub use plot_lines::{DeemedBorder, PlotSpot};
pub use triangles::{PartTriangle, triangles, triangles_of_faces};
