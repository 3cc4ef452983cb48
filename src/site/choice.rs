//! The words by which people choose a side, and a model's upward axis.

use crate::choice::words;
use crate::formats::Up;
use crate::view::Side;

words!(Up, ["y" => Up::Y, "z" => Up::Z]);
words!(
    Side,
    [
        "north" => Side::North,
        "east" => Side::East,
        "south" => Side::South,
        "west" => Side::West
    ]
);
