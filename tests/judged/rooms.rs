//! The table that says the room of each window.

use super::{fails_in, folder, notes, open, write};
use gnomon::site::JudgedSite;

const TABLES: &str = "[[window]]\ncomponent = \"glass\"\nrooms = \"rooms.csv\"\nroom = \"hall\"\n";

fn with(table: &str) -> JudgedSite {
    let folder = folder(TABLES);
    write(&folder, "rooms.csv", table);
    open(folder.path())
}

fn told(table: &str, words: &[&str]) {
    let folder = folder(TABLES);
    write(&folder, "rooms.csv", table);
    fails_in(folder.path(), &[words, &["rooms.csv"]].concat());
}

#[test]
fn rooms_are_given_to_windows() {
    for table in [
        "\u{feff}window,room,dwelling,usage,floor,room_area\r\nglass 2,\"bed, 1\",flat 3,living,3.25,14.5\r\n\r\nglass 1,,,,,\r\n",
        "Window;Room;Dwelling;Usage;Floor;Room_Area\nglass 1;;;;;\nglass 2;bed, 1;flat 3;living;3,25;14,5\n",
    ] {
        let site = with(table);
        let [first, second] = site.windows.as_slice() else { panic!("{:?}", site.windows) };
        assert_eq!((first.room.as_deref(), first.dwelling.as_deref(), first.floor), (Some("hall"), None, None));
        assert_eq!((second.room.as_deref(), second.dwelling.as_deref()), (Some("bed, 1"), Some("flat 3")));
        assert_eq!((second.usage.as_deref(), second.floor, second.room_m2), (Some("living"), Some(3.25), Some(14.5)));
        assert!(!notes(&site).contains("not in rooms.csv"), "{}", notes(&site));
    }
    let site = with("window,usage\nglass 1,living");
    assert!(notes(&site).contains("1 window is not in rooms.csv: \"glass 2\""), "{}", notes(&site));
}

#[test]
fn mistakes_in_rooms_are_told() {
    told("", &["line 1", "window and some of"]);
    told("window\nglass 1", &["line 1", "window and some of"]);
    told("window,rom\nglass 1,a", &["line 1", "\"rom\"", "room"]);
    told("window,room,room\nglass 1,a,b", &["line 1", "twice"]);
    told("window,room\nglass 3,a", &["line 2", "no window \"glass 3\"", "nearest", "glass"]);
    told("window,room\nglass 1,a\nglass 1,b", &["line 3", "two lines"]);
    told("window,room\n\n,attic", &["line 3", "\"attic\" has no window"]);
    told("window,room\nglass 1", &["line 2", "1 fields and 2 columns"]);
    told("window,room\n\"glass 1,a", &["line 2", "quote"]);
    told("window,floor\nglass 1,high", &["line 2", "floor is \"high\""]);
    told("window,floor\nglass 1,inf", &["line 2", "floor"]);
    told("window,room_area\nglass 1,0", &["line 2", "room_area"]);
    let none = folder(TABLES);
    fails_in(none.path(), &["[[window]] rooms", "no file"]);
    let folder = folder(TABLES);
    write(&folder, "rooms.csv", "window,room,room_area\nglass 1,a,10\nglass 2,a,11");
    fails_in(folder.path(), &["[[window]] room_area", "\"a\"", "11 m²", "10 m²"]);
}
