//! Random input from a user: the window must not crash, and its memory must not grow.

use super::*;
use egui::{Modifiers, PointerButton, pos2};

/// A plain generator, so that what fails once fails again (Marsaglia's xorshift).
struct Hand(u64);

impl Hand {
    fn below(&mut self, most: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % most
    }

    fn somewhere(&mut self) -> Pos2 {
        pos2(self.below(1280) as f32, self.below(720) as f32)
    }

    fn event(&mut self, at: &mut Pos2) -> Event {
        const KEYS: [Key; 16] = [
            Key::ArrowLeft,
            Key::ArrowRight,
            Key::ArrowUp,
            Key::ArrowDown,
            Key::Tab,
            Key::Space,
            Key::Escape,
            Key::Enter,
            Key::Num1,
            Key::Num2,
            Key::Num3,
            Key::Num4,
            Key::F,
            Key::Z,
            Key::Backspace,
            Key::Home,
        ];
        let button = [PointerButton::Primary, PointerButton::Primary, PointerButton::Secondary][self.below(3) as usize];
        match self.below(10) {
            0..=2 => {
                *at = self.somewhere();
                Event::PointerMoved(*at)
            }
            3 | 4 => Event::PointerButton { pos: *at, button, pressed: true, modifiers: Modifiers::NONE },
            5 | 6 => Event::PointerButton { pos: *at, button, pressed: false, modifiers: Modifiers::NONE },
            7 => Event::Zoom(0.7 + self.below(60) as f32 / 100.0),
            8 => Event::Text(["7", ":", "x", "-", "é"][self.below(5) as usize].to_owned()),
            _ => {
                let key = KEYS[self.below(16) as usize];
                let modifiers = [Modifiers::NONE, Modifiers::SHIFT, Modifiers::COMMAND][self.below(3) as usize];
                // no dialog of the system
                let modifiers = if key == Key::Z { Modifiers::COMMAND } else { modifiers };
                Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers }
            }
        }
    }
}

/// Memory in use, MiB, where the system tells it.
fn memory_mib() -> Option<u64> {
    let pages: u64 = std::fs::read_to_string("/proc/self/statm").ok()?.split(' ').nth(1)?.parse().ok()?;
    Some(pages * 4 / 1024)
}

#[test]
fn two_thousand_events_on_the_tower() {
    let mut harness = window(Some(&sample("tower")));
    let mut hand = Hand(0x9e37_79b9_7f4a_7c15);
    let mut at = pos2(640.0, 300.0);
    let mut halfway = None;
    for event in 0..2000 {
        let event_now = hand.event(&mut at);
        harness.event(event_now);
        harness.step();
        if event == 1000 {
            halfway = memory_mib();
        }
    }
    settle_or_play(&mut harness);
    if let (Some(halfway), Some(end)) = (halfway, memory_mib()) {
        assert!(end < halfway + 500, "memory grows: {halfway} MiB after half of the events, {end} MiB at their end");
    }
}

/// A random hand may have left the day playing.
fn settle_or_play(harness: &mut Harness<'_, App>) {
    for _ in 0..20 {
        harness.step();
        std::thread::sleep(Duration::from_millis(5));
    }
}
