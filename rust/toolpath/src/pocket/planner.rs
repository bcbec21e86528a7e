//! Level by level: what is reached next, and the pieces of its boundary.

use rayon::prelude::*;
use styluscam_motion::Watch;

use super::bound::Bound;
use super::check::bounded;
use super::cut::{left_of, Cut};
use super::entry::{largest_disc, Site};
use super::error::PocketError;
use super::fit::arcs;
use super::ground::{path_chords, reversed, Ground};
use super::growth::{Growth, WALL};
use super::material::Material;
use super::pieces::Piece;
use super::polygons::Point;
use super::request::{EntryRule, Pocket, PocketPath};
use super::sequence::{measure_room, sequenced};
use super::steering::around_ring;
use super::window::Window;

/// The largest disc that is tried, in tool radii: larger ones engage as straight passes do.
const LARGEST: f64 = 12.0;
/// What a pass is taken to sweep beyond the tool's radius, mm: slivers between chords, thinner than the chips that count.
pub const SLIVER: f64 = 4e-4;
/// Levels and entries, at most: more would mean that the path gains no ground.
const LEVELS: u32 = 20_000;
const ENTRIES: usize = 200;

/// How deep into the material an entry beside it goes at least, mm.
const BESIDE: f64 = 0.01;
/// What may be left where no entry fits, as a share of what is to be cleared: slivers.
const LEFT: f64 = 1e-3;
/// How much more room than the bound asks for a ramp leaves the first passes, as a share.
const SPARE: f64 = 1.02;

/// What a piece may exceed the bound by, rad (0.3 deg): half a degree is allowed, and the account here is good to a twentieth.
pub const ALLOWED: f64 = 0.3 * std::f64::consts::PI / 180.0;
/// How much lower the bound is taken, one after the other, where nothing within it was found, deg.
const LOWER: [f64; 4] = [0.0, 2.0, 5.0, 9.0];

/// Plans the path of a pocket by climb milling.
pub fn plan(pocket: &Pocket<'_>, watch: &Watch) -> Result<PocketPath, PocketError> {
    let ground = Ground::new(pocket)?;
    let bound = Bound::new(pocket.radius, pocket.angle);
    let widest = largest_disc(&ground.kernel, &ground.discs, pocket.radius).map_or(0.0, |(_, radius)| radius);
    let largest = widest.min(LARGEST * pocket.radius).max(pocket.smoothing);
    let bounds = LOWER.map(|lower| Bound::new(pocket.radius, pocket.angle - lower.to_radians()));
    let growths = Growth::all(&ground.kernel, [&ground.free, &ground.discs], bounds, [largest, pocket.smoothing]);
    let most = pocket.angle + ALLOWED;
    let material = Material::new(ground.goal.clone());
    let free = Material::new(ground.free.clone());
    let whole = material.area.area();
    let steering = Bound::steering(pocket.radius, pocket.angle);
    let mut planner = Planner {
        ground,
        bound,
        steering,
        growths,
        most,
        two_way: pocket.two_way,
        entry: (pocket.entry, pocket.smoothing),
        material,
        cleared: Vec::new(),
        free,
        cuts: Vec::new(),
        at: None,
    };
    watch.begin("clearing the pocket", 1000);
    let (mut told, mut entries, mut has_room) = (0, 0, true);
    let mut has_begun = planner.has_air();
    for level in 0..LEVELS {
        if planner.material.is_empty() {
            break;
        }
        if !has_begun || !(0..planner.growths.len()).any(|growth| planner.level(level, growth)) {
            has_begun = true;
            entries += 1;
            has_room = planner.enter(level);
            if entries > ENTRIES || !has_room {
                break;
            }
        }
        let done = (1000.0 * (1.0 - planner.material.area.area() / whole)).max(0.0) as usize;
        watch.advance(done.saturating_sub(told))?;
        told = told.max(done);
    }
    let left = planner.material.area.area().max(0.0);
    if !has_room && left > LEFT * whole {
        return Err(planner.no_entry(left));
    }
    let mut runs = sequenced(&planner.cuts, &planner.ground, &planner.free, (pocket.radius, pocket.stepovers), watch)?;
    measure_room(&mut runs, &planner.free);
    Ok(PocketPath { runs, goal: whole, left })
}

/// The pieces so far and what is left.
struct Planner {
    ground: Ground,
    bound: Bound,
    steering: Bound,
    /// At the bound, and by [`LOWER`] below: for where a joint of those before goes beyond.
    growths: [Growth; LOWER.len()],
    /// The largest angle of a piece that is cut, rad.
    most: f64,
    /// Whether pieces may be cut from either end.
    two_way: bool,
    /// How the tool goes down, and the smallest radius of its path, mm.
    entry: (EntryRule, f64),
    material: Material,
    /// Boxes around all that has been taken of it.
    cleared: Vec<Window>,
    free: Material,
    cuts: Vec<Cut>,
    /// Where the last piece ends.
    at: Option<Point>,
}

impl Planner {
    /// Whether there is a position of the tool's centre outside of the material, from which growth can begin.
    fn has_air(&self) -> bool {
        !self.ground.kernel.difference(&self.ground.discs, &self.material.area).is_empty()
    }

    /// Takes all pieces of what is reached next; false where there are none.
    fn level(&mut self, level: u32, growth: usize) -> bool {
        let Some(growth) = self.growths.get_mut(growth) else { return false };
        let chosen = growth.next(&self.ground.kernel, &self.material, &self.cleared);
        // each is within the bound with the material as it is, whatever of the others is cut before it
        let mut cuts: Vec<Cut> = chosen.par_iter().filter_map(|piece| self.cut(level, piece)).collect();
        self.clear(&cuts);
        self.at = cuts.last().and_then(Cut::end).or(self.at);
        let has_cut = !cuts.is_empty();
        self.cuts.append(&mut cuts);
        has_cut
    }

    /// The path of one piece; None where there is no way onto it.
    fn cut(&self, level: u32, piece: &Piece) -> Option<Cut> {
        let (r, material) = (self.bound.radius, &self.material);
        let path = if piece.is_ring {
            around_ring(&piece.points, self.at, material, &self.free, &self.steering)?
        } else {
            arcs(&piece.points)
        };
        let points = path.len();
        let sweep = |path: &[[f64; 3]]| self.ground.kernel.sweep(&path_chords(path), r + SLIVER, WALL);
        // most pieces are cut as they are
        let (kept, mut swept) = rayon::join(|| bounded(path.clone(), material, r, self.most), || sweep(&path));
        let is_whole = kept.len() == points;
        if !is_whole {
            swept = sweep(&kept);
        }
        let path = kept;
        let may_turn = self.two_way && is_whole && !piece.is_ring;
        let two_way = may_turn && bounded(reversed(&path), material, r, self.most).len() == points;
        (path.len() > 1).then_some(Cut { path, swept, level, is_entry: false, two_way })
    }

    fn clear(&mut self, cuts: &[Cut]) {
        let kernel = &self.ground.kernel;
        self.cleared.extend(cuts.iter().filter_map(|cut| self.material.taken_by(&cut.swept)));
        self.material = left_of(kernel, &self.material, cuts);
    }

    /// Goes down where there is most room, into the material or beside it; false where that takes none of it.
    fn enter(&mut self, level: u32) -> bool {
        let kernel = &self.ground.kernel;
        let Some(disc) = self.place_of_entry() else { return false };
        let radius = self.bound.radius;
        let (rule, smoothing) = self.entry;
        let aside = SPARE * self.bound.keep(smoothing) - radius;
        let site = Site { kernel, free: &self.free, radius, aside };
        let Some(way) = site.way(disc, rule) else { return false };
        let cut = Cut { path: way.points, swept: way.swept, level, is_entry: true, two_way: false };
        let before = self.material.area.area();
        self.clear(std::slice::from_ref(&cut));
        if self.material.area.area() >= before {
            return false;
        }
        self.at = cut.end();
        self.cuts.push(cut);
        true
    }

    /// The largest disc for the tool's centre in the material, or beside it.
    fn place_of_entry(&self) -> Option<(Point, f64)> {
        let (kernel, free) = (&self.ground.kernel, &self.ground.free);
        let under = kernel.intersection(free, &self.material.area);
        let disc = largest_disc(kernel, &under, self.bound.radius).or_else(|| {
            // from another area of the tool's centre the middle of this one may be cleared, and no way leads here
            let beside = kernel.offset(&self.material.area, self.bound.radius - BESIDE, WALL);
            largest_disc(kernel, &kernel.intersection(free, &beside), self.bound.radius)
        });
        disc.filter(|(_, radius)| *radius > 0.0)
    }

    /// That no entry fits where there is most room.
    fn no_entry(&self, left: f64) -> PocketError {
        let place = self.place_of_entry();
        let at = place.map(|(at, _)| at).or(self.material.area.bounds().map(|[low, _]| low)).unwrap_or_default();
        PocketError::NoEntry { at, left, form: self.entry.0.form }
    }
}
