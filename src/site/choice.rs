//! The words for a side, and for a model's up axis.

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
