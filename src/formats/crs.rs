//! Names of reference systems, and the order of their two coordinates.

/// A reference system as a file names it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct NamedSystem {
    /// `EPSG:25832`, or the file's own text if it contains no code.
    pub crs: String,
    /// Whether the name asks for the axis order of the system's authority, as the OGC's URNs and URLs do.
    pub is_official: bool,
}

/// Reads the name of a system in any of its forms: `EPSG:25832`, `urn:ogc:def:crs:EPSG::25832`,
/// `https://www.opengis.net/def/crs/EPSG/0/7415`, `urn:adv:crs:ETRS89_UTM32*DE_DHHN2016_NH`. For a compound system it
/// returns the horizontal one, which comes first.
pub(super) fn named_system(text: &str) -> Option<NamedSystem> {
    let text = text.trim();
    let lower = text.to_ascii_lowercase();
    let is_official = lower.starts_with("urn:ogc:def:crs")
        || lower.starts_with("urn:x-ogc:def:crs")
        || lower.contains("opengis.net/def/crs");
    if let Some(code) = epsg_in(&lower) {
        return Some(NamedSystem { crs: format!("EPSG:{code}"), is_official });
    }
    if lower.contains("crs84") {
        // longitude first by definition
        return Some(NamedSystem { crs: "EPSG:4326".into(), is_official: false });
    }
    let crs = surveyed_in_germany(&lower).map_or_else(|| text.to_owned(), |code| format!("EPSG:{code}"));
    (!text.is_empty()).then_some(NamedSystem { crs, is_official: false })
}

/// The first EPSG code in a text: the last number after that word, before anything else begins.
fn epsg_in(lower: &str) -> Option<u32> {
    let behind = &lower[lower.find("epsg")? + "epsg".len()..];
    let own = behind.split([',', '&', '+', ' ', ';']).next()?;
    let mut numbers = own.split(|c: char| !c.is_ascii_digit()).filter(|digits| !digits.is_empty());
    numbers.next_back()?.parse().ok().filter(|&code| code > 0)
}

/// The code of a system of the German surveyors, who write eastings first.
fn surveyed_in_germany(lower: &str) -> Option<u32> {
    let name = lower.strip_prefix("urn:adv:crs:")?;
    let zone = |behind: &str| name.split_once(behind)?.1.chars().next()?.to_digit(10);
    match (name.split_once("etrs89_utm3"), zone("_3gk")) {
        (Some((_, zone)), _) => match zone.chars().next()? {
            digit @ '1'..='3' => Some(25830 + digit.to_digit(10)?),
            _ => None,
        },
        (None, Some(zone @ 2..=5)) => Some(31464 + zone),
        _ => None,
    }
}

/// Whether the official axis order of a system is north (or latitude) before east.
pub(super) fn is_north_first(crs: &str) -> bool {
    let Some(code) = crs.strip_prefix("EPSG:").and_then(|code| code.parse::<u32>().ok()) else {
        return false;
    };
    let before = NORTH_FIRST.partition_point(|&(_, last)| last < code);
    NORTH_FIRST.get(before).is_some_and(|&(first, _)| first <= code)
}

/// Ranges of EPSG codes, first and last, in which all existing systems have northing or latitude first; compound
/// systems count by their horizontal part. From the EPSG dataset 11.022 in PROJ 9.5.1.
#[rustfmt::skip]
const NORTH_FIRST: &[(u32, u32)] = &[
    (2036, 2036), (2044, 2045), (2081, 2083), (2085, 2086), (2091, 2093), (2096, 2098), (2105, 2132), (2166, 2180),
    (2193, 2193), (2199, 2200), (2206, 2212), (2319, 2549), (2551, 2735), (2738, 2758), (2935, 2941), (2953, 2953),
    (3006, 3030), (3034, 3035), (3038, 3051), (3058, 3059), (3068, 3068), (3114, 3118), (3120, 3120), (3126, 3140),
    (3146, 3147), (3150, 3152), (3300, 3301), (3328, 3335), (3346, 3346), (3350, 3352), (3366, 3366), (3386, 3390),
    (3396, 3399), (3407, 3407), (3414, 3414), (3416, 3416), (3764, 3764), (3788, 3793), (3795, 3796), (3819, 3824),
    (3833, 3854), (3873, 3889), (3901, 3911), (4001, 4047), (4052, 4055), (4074, 4081), (4120, 4216), (4218, 4388),
    (4417, 4417), (4434, 4434), (4463, 4466), (4469, 4470), (4472, 4472), (4475, 4483), (4490, 4558), (4568, 4646),
    (4652, 4824), (4839, 5013), (5048, 5048), (5105, 5188), (5228, 5233), (5245, 5246), (5251, 5264), (5269, 5275),
    (5323, 5324), (5340, 5354), (5359, 5360), (5364, 5381), (5392, 5393), (5451, 5451), (5464, 5464), (5467, 5467),
    (5479, 5481), (5488, 5489), (5498, 5500), (5518, 5520), (5524, 5527), (5545, 5546), (5560, 5588), (5592, 5593),
    (5628, 5628), (5632, 5639), (5651, 5653), (5681, 5681), (5830, 5830), (5845, 5857), (5885, 5886), (5942, 5970),
    (6134, 6135), (6144, 6170), (6207, 6207), (6244, 6275), (6310, 6311), (6318, 6325), (6349, 6349), (6362, 6365),
    (6372, 6387), (6649, 6649), (6667, 6687), (6696, 6700), (6705, 6709), (6782, 6783), (6870, 6870), (6875, 6876),
    (6881, 6883), (6892, 6892), (6894, 6894), (6917, 6917), (6927, 6927), (6962, 6962), (6979, 6983), (6986, 6990),
    (7072, 7073), (7135, 7139), (7372, 7373), (7400, 7400), (7404, 7404), (7406, 7406), (7408, 7410), (7414, 7414),
    (7423, 7423), (7657, 7686), (7797, 7801), (7816, 7844), (7880, 7881), (7885, 7886), (7900, 7931), (8042, 8043),
    (8085, 8086), (8231, 8255), (8349, 8351), (8360, 8360), (8399, 8449), (8542, 8545), (8684, 8685), (8694, 8699),
    (8817, 8818), (8860, 8900), (8906, 8907), (8916, 8949), (8972, 9140), (9147, 9148), (9152, 9153), (9183, 9184),
    (9221, 9254), (9267, 9294), (9299, 9299), (9308, 9309), (9332, 9333), (9364, 9364), (9372, 9372), (9377, 9384),
    (9403, 9403), (9422, 9453), (9462, 9470), (9474, 9475), (9498, 9547), (9656, 9657), (9695, 9696), (9701, 9707),
    (9723, 9739), (9754, 9758), (9763, 9763), (9776, 9777), (9781, 9782), (9785, 9785), (9821, 9821), (9831, 9841),
    (9851, 9866), (9871, 9871), (9883, 9907), (9924, 9924), (9939, 9939), (9948, 9950), (9964, 9964), (9969, 9969),
    (9974, 9974), (9989, 10158), (10162, 10178), (10185, 10185), (10191, 10191), (10196, 10196), (10204, 10204),
    (10209, 10209), (10214, 10214), (10219, 10219), (10224, 10224), (10229, 10229), (10237, 10237), (10245, 10245),
    (10249, 10249), (10252, 10252), (10256, 10256), (10260, 10260), (10265, 10265), (10268, 10268), (10272, 10272),
    (10277, 10277), (10283, 10284), (10286, 10286), (10288, 10288), (10290, 10290), (10293, 10299), (10304, 10306),
    (10309, 10310), (10327, 10414), (10468, 10468), (10474, 10475), (10486, 10488), (10507, 10507), (10545, 10571),
    (10605, 10606), (10623, 10623), (10628, 10628), (10651, 10659), (10670, 10671), (10679, 10686), (11114, 20001),
    (20004, 20041), (20043, 20046), (20064, 20092), (20904, 20932), (21004, 21032), (21207, 21264), (21307, 21483),
    (21896, 21899), (22171, 22197), (22240, 22240), (23301, 23333), (25884, 25884), (27205, 27232), (27391, 27398),
    (27492, 27492), (28402, 28492), (29701, 29702), (30161, 30179), (30800, 30800), (31251, 31259), (31275, 31290),
    (31466, 31469), (31700, 31700),
];
