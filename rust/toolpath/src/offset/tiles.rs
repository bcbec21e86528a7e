//! Places put together in tiles: neighbours share a search.

use styluscam_geometry::Vector;

/// Places in a tile, about.
const MEMBERS: f64 = 16.0;
/// Triangles under a tile, about, at most.
const TRIANGLES: f64 = 24.0;

/// Places in the order of their tiles.
pub struct Tiles {
    /// Numbers of places, tile after tile.
    pub members: Vec<u32>,
    /// Where each tile's members begin, and the end.
    pub starts: Vec<u32>,
}

impl Tiles {
    /// Tiles of places over a mesh of `triangles` within a box: small enough for few triangles, large enough for some places.
    pub fn of(places: &[[f64; 2]], triangles: usize, (low, high): (Vector, Vector)) -> Self {
        let size = Size::of(places);
        let per_triangle = ((high.x - low.x) * (high.y - low.y) / triangles as f64).sqrt();
        let side = (size.per_place() * std::env::var("MEM").map_or(MEMBERS, |x| x.parse().unwrap()).sqrt())
            .min(per_triangle * std::env::var("TRI").map_or(TRIANGLES, |x| x.parse().unwrap()).sqrt())
            .max(1e-9 * size.extent());
        size.sorted(places, side)
    }
}

/// The box around places.
struct Size {
    low: [f64; 2],
    high: [f64; 2],
    count: usize,
}

impl Size {
    fn of(places: &[[f64; 2]]) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for place in places {
            for i in 0..2 {
                low[i] = low[i].min(place[i]);
                high[i] = high[i].max(place[i]);
            }
        }
        Self { low, high, count: places.len() }
    }

    fn extent(&self) -> f64 {
        (self.high[0] - self.low[0]).max(self.high[1] - self.low[1]).max(f64::MIN_POSITIVE)
    }

    /// Side of a square that holds one place, mm.
    fn per_place(&self) -> f64 {
        let area = (self.high[0] - self.low[0]) * (self.high[1] - self.low[1]);
        let along = self.extent() / self.count as f64;
        (area / self.count as f64).sqrt().max(along)
    }

    /// By rows of tiles, every other one backwards: each tile begins beside the last.
    fn sorted(&self, places: &[[f64; 2]], side: f64) -> Tiles {
        let count = |i: usize| ((self.high[i] - self.low[i]) / side).floor() + 1.0;
        let columns = count(0) as u64;
        let key = |place: &[f64; 2]| {
            let column = ((place[0] - self.low[0]) / side) as u64;
            let row = ((place[1] - self.low[1]) / side) as u64;
            row * columns + if row % 2 == 0 { column } else { columns - 1 - column.min(columns - 1) }
        };
        let tiles = count(0) * count(1);
        if tiles <= 2.0 * places.len() as f64 + 64.0 {
            counted(places.iter().map(key), tiles as usize)
        } else {
            compared(places.iter().map(key).collect())
        }
    }
}

/// Counting sort: many places, few tiles.
fn counted(keys: impl Iterator<Item = u64> + Clone, tiles: usize) -> Tiles {
    let mut starts = vec![0_u32; tiles + 1];
    for key in keys.clone() {
        starts[key as usize + 1] += 1;
    }
    for tile in 1..starts.len() {
        starts[tile] += starts[tile - 1];
    }
    let mut next = starts.clone();
    let mut members = vec![0; starts[tiles] as usize];
    for (place, key) in keys.enumerate() {
        let at = &mut next[key as usize];
        members[*at as usize] = place as u32;
        *at += 1;
    }
    starts.dedup();
    Tiles { members, starts }
}

/// By comparison: places far from each other.
fn compared(keys: Vec<u64>) -> Tiles {
    let mut members: Vec<u32> = (0..keys.len() as u32).collect();
    members.sort_unstable_by_key(|m| (keys[*m as usize], *m));
    let mut starts: Vec<u32> = vec![0];
    for (at, pair) in members.windows(2).enumerate() {
        if keys[pair[0] as usize] != keys[pair[1] as usize] {
            starts.push(at as u32 + 1);
        }
    }
    starts.push(members.len() as u32);
    Tiles { members, starts }
}
