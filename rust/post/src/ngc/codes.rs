//! Which codes there are. G codes are in tenths: 382 is G38.2.

/// Codes that move.
const MOTIONS: [u32; 32] = [
    0, 10, 20, 30, 50, 51, 52, 53, 330, 331, 382, 383, 384, 385, 700, 710, 711, 712, 720, 721, 722, 730, 740, 760, 810,
    820, 830, 840, 850, 860, 880, 890,
];

/// Codes that use the axis words of their block otherwise.
const SETTINGS: [u32; 9] = [100, 280, 281, 300, 301, 431, 432, 520, 920];

/// Codes that use no axis words.
const OTHERS: [u32; 46] = [
    40, 70, 80, 170, 171, 180, 181, 190, 191, 200, 210, 400, 410, 411, 420, 421, 430, 490, 530, 540, 550, 560, 570,
    580, 590, 591, 592, 593, 610, 611, 640, 800, 900, 901, 910, 911, 921, 922, 923, 930, 940, 950, 960, 970, 980, 990,
];

/// M codes whose meaning is known; those that say nothing about motion are passed over.
const MISCELLANEOUS: [u32; 33] = [
    0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 19, 30, 48, 49, 50, 51, 52, 53, 60, 61, 62, 63, 64, 65, 66, 67, 68, 70, 71, 72, 73,
    98, 99,
];

pub(super) fn known_g(code: u32) -> bool {
    takes_axes(code) || OTHERS.contains(&code)
}

pub(super) fn known_m(code: u32) -> bool {
    MISCELLANEOUS.contains(&code)
}

/// Whether a code moves by the axis words of its block.
pub(super) fn moves(code: u32) -> bool {
    MOTIONS.contains(&code)
}

/// Whether a code uses the axis words of its block; two such codes do not go together.
pub(super) fn takes_axes(code: u32) -> bool {
    moves(code) || SETTINGS.contains(&code)
}

/// As it is written.
pub(super) fn name_g(code: u32) -> String {
    match code % 10 {
        0 => format!("G{}", code / 10),
        tenth => format!("G{}.{tenth}", code / 10),
    }
}
