//! How verdicts look: a colour and a hatch each, so that they differ without colour, too, and their words.

use crate::look::LOOK;
use crate::rules::Verdict;
use eframe::egui::{self, Color32, Painter, Pos2, Sense, Stroke, Ui, pos2, vec2};

/// The distance between the lines of a hatch, points.
const HATCH: f32 = 7.0;

/// The lines across a colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::desktop) enum Hatch {
    /// The colour alone.
    None,
    /// Lines that rise to the right.
    Rising,
    /// Lines that fall to the right.
    Falling,
    /// Level lines.
    Level,
}

/// A colour with its hatch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::desktop) struct VerdictPaint {
    pub(in crate::desktop) colour: Color32,
    pub(in crate::desktop) hatch: Hatch,
}

impl VerdictPaint {
    pub(in crate::desktop) fn of(verdict: Verdict) -> VerdictPaint {
        let ([r, g, b], hatch) = match verdict {
            Verdict::Pass => (LOOK.passing, Hatch::None),
            Verdict::Close => (LOOK.too_close, Hatch::Falling),
            Verdict::Fail => (LOOK.failing, Hatch::Rising),
            Verdict::Report => (LOOK.only_reported, Hatch::Level),
        };
        VerdictPaint { colour: Color32::from_rgb(r, g, b), hatch }
    }

    /// The colour of hatch and border.
    pub(in crate::desktop) fn ink(self) -> Color32 {
        let [r, g, b, _] = self.colour.to_array();
        Color32::from_rgb(r / 2, g / 2, b / 2)
    }

    /// Draws the hatch within a convex outline.
    pub(in crate::desktop) fn hatch(self, painter: &Painter, corners: &[Pos2]) {
        let level = |at: &Pos2| match self.hatch {
            Hatch::None => None,
            Hatch::Rising => Some(at.x + at.y),
            Hatch::Falling => Some(at.x - at.y),
            Hatch::Level => Some(at.y),
        };
        let Some(levels) = corners.iter().map(level).collect::<Option<Vec<f32>>>() else { return };
        let (low, high) = levels.iter().fold((f32::MAX, f32::MIN), |(low, high), at| (low.min(*at), high.max(*at)));
        // what is this large lies beyond the picture
        if !(high - low).is_finite() || high - low > 20_000.0 {
            return;
        }
        let stroke = Stroke::new(1.0, self.ink().gamma_multiply(0.7));
        for number in (low / HATCH).ceil() as i64..=(high / HATCH).floor() as i64 {
            let wanted = number as f32 * HATCH;
            let mut ends = Vec::new();
            for at in 0..corners.len() {
                let next = (at + 1) % corners.len();
                let (from, to) = (levels[at], levels[next]);
                if (from < wanted) != (to < wanted) {
                    ends.push(corners[at].lerp(corners[next], (wanted - from) / (to - from)));
                }
            }
            if let [from, to] = ends[..] {
                painter.line_segment([from, to], stroke);
            }
        }
    }
}

/// A verdict in a word.
pub(in crate::desktop) fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Pass => "passes",
        Verdict::Close => "is too close to say",
        Verdict::Fail => "fails",
        Verdict::Report => "is only reported",
    }
}

/// A small field in a verdict's colour and hatch.
pub(in crate::desktop) fn swatch(ui: &mut Ui, verdict: Verdict) {
    let (rect, _) = ui.allocate_exact_size(vec2(18.0, 13.0), Sense::hover());
    paint_swatch(ui.painter(), rect, verdict);
}

/// The same in a given place.
pub(in crate::desktop) fn paint_swatch(painter: &Painter, rect: egui::Rect, verdict: Verdict) {
    let paint = VerdictPaint::of(verdict);
    painter.rect_filled(rect, 2.0, paint.colour);
    let inner = painter.with_clip_rect(rect.intersect(painter.clip_rect()));
    let corners =
        [rect.left_top(), pos2(rect.right(), rect.top()), rect.right_bottom(), pos2(rect.left(), rect.bottom())];
    paint.hatch(&inner, &corners);
    painter.rect_stroke(rect, 2.0, Stroke::new(1.0, paint.ink()), egui::StrokeKind::Inside);
}
