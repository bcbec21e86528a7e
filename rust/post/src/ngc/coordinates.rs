//! Codes that move no axis but what its coordinates mean: G10, G28.1, G43, G52, G54, G92 and their kin.

use super::block::Block;
use super::fault::TraceFault;
use super::note::Gap;
use super::offsets::{less, system_code, System, SYSTEMS};
use super::path::Pace;
use super::tracer::Tracer;
use crate::block::{Code, Length};
use styluscam_motion::MoveKind;

/// The first parameters of the positions that G28 and G30 go to, and of G92's offset.
const HOMES: [usize; 2] = [5161, 5181];
const LOCAL: usize = 5211;
const LOCAL_IN_FORCE: usize = 5210;

/// G10 L11 measures tools in this coordinate system: G59.3.
const FIXTURE: usize = 8;

impl Tracer<'_> {
    /// The axis words of a block, mm; X halved where it is a diameter.
    pub(super) fn lengths(&self, block: &Block) -> [Option<f64>; 3] {
        let [x, y, z] = block.axes().map(|word| word.map(|value| value * self.modes.unit()));
        [if self.modes.diameter { x.map(|x| x / 2.0) } else { x }, y, z]
    }

    /// Changes the offsets; the machine stands still, and its position gets other coordinates.
    fn offset(&mut self, change: impl FnOnce(&mut Self)) {
        let machine = self.offsets.in_machine(self.position);
        change(self);
        self.position = self.offsets.of_machine(machine);
    }

    pub(super) fn call_system(&mut self, index: usize) {
        self.offset(|tracer| tracer.offsets.call(index));
        self.modes.system = index;
    }

    pub(super) fn set_system(&mut self, block: &Block) {
        for code in &block.g {
            let Some(index) = (0..SYSTEMS).find(|index| system_code(*index) == *code) else { continue };
            let set = self.offsets.stored.get(index).is_some_and(|stored| *stored != System::default());
            if index != self.offsets.index && !set {
                self.note(Gap::WorkOffset);
            }
            self.call_system(index);
        }
    }

    /// G43, G43.1, G43.2 and G49. The tool table is not here: lengths are those that G10 L1 has set.
    pub(super) fn set_tool_length(&mut self, block: &Block) -> Result<(), TraceFault> {
        let number = block.count(b'h', "H")?.unwrap_or(self.loaded);
        let length = block.codes().filter_map(|code| if let Code::Length(length) = code { Some(length) } else { None });
        let offset = match length.last() {
            Some(Length::Table | Length::Tip) => self.length_of(number),
            Some(Length::Words) => {
                let words = self.lengths(block);
                [0, 1, 2].map(|axis| words[axis].unwrap_or(self.offsets.tool[axis]))
            }
            Some(Length::Added) => {
                let (table, words) = (self.length_of(number), self.lengths(block));
                [0, 1, 2].map(|axis| self.offsets.tool[axis] + words[axis].unwrap_or(table[axis]))
            }
            Some(Length::Off) => [0.0; 3],
            None => return Ok(()),
        };
        self.offset(|tracer| tracer.offsets.tool = offset);
        Ok(())
    }

    fn length_of(&mut self, number: u32) -> [f64; 3] {
        self.lengths.get(&number).copied().unwrap_or_else(|| {
            self.note(Gap::ToolTable);
            [0.0; 3]
        })
    }

    pub(super) fn set_offsets(&mut self, block: &Block, code: u32) -> Result<(), TraceFault> {
        match code {
            100 => self.set_data(block)?,
            280 | 300 => self.go_home(block, code)?,
            281 => self.parameters.set_run(HOMES[0], self.offsets.in_machine(self.position)),
            301 => self.parameters.set_run(HOMES[1], self.offsets.in_machine(self.position)),
            520 => {
                let words = self.lengths(block);
                let local = [0, 1, 2].map(|axis| words[axis].unwrap_or(self.offsets.local[axis]));
                self.set_local_offset(local);
            }
            920 => {
                let words = self.lengths(block);
                let (position, local) = (self.position, self.offsets.local);
                let moved = [0, 1, 2].map(|axis| words[axis].map_or(0.0, |word| position[axis] - word));
                self.set_local_offset([0, 1, 2].map(|axis| local[axis] + moved[axis]));
            }
            // G43.1, G43.2: done with the tool's length
            _ => {}
        }
        Ok(())
    }

    /// G92.1, G92.2 and G92.3.
    pub(super) fn turn_local_offset(&mut self, block: &Block) {
        for code in &block.g {
            match code {
                921 => self.set_local_offset([0.0; 3]),
                922 => self.offset(|tracer| tracer.offsets.local = [0.0; 3]),
                923 => {
                    let kept = self.parameters.run(LOCAL);
                    self.set_local_offset(kept);
                }
                _ => continue,
            }
            let in_force = f64::from(u8::from(*code == 923));
            self.parameters.set_number(LOCAL_IN_FORCE, in_force);
        }
    }

    fn set_local_offset(&mut self, local: [f64; 3]) {
        self.parameters.set_run(LOCAL, local);
        self.parameters.set_number(LOCAL_IN_FORCE, 1.0);
        self.offset(|tracer| tracer.offsets.local = local);
    }

    /// G28 and G30: over the position that is named, if any, to the stored one; then only along the axes that are named.
    fn go_home(&mut self, block: &Block, code: u32) -> Result<(), TraceFault> {
        let named = self.lengths(block).map(|word| word.is_some());
        let any = named.contains(&true) || block.turns();
        if any {
            let end = self.target(block, false)?;
            self.rapid(end)?;
        }
        let home = self.offsets.of_machine(self.parameters.run(HOMES[usize::from(code == 300)]));
        let position = self.position;
        self.positioned = [0, 1, 2].map(|axis| self.positioned[axis] || !any || named[axis]);
        self.rapid([0, 1, 2].map(|axis| if named[axis] || !any { home[axis] } else { position[axis] }))
    }

    pub(super) fn rapid(&mut self, end: [f64; 3]) -> Result<(), TraceFault> {
        let pace = Pace { kind: MoveKind::Rapid, feed: 0.0, line: self.line_of_program() };
        self.path.line(&self.offsets, end, pace)?;
        self.position = end;
        Ok(())
    }

    /// G10.
    fn set_data(&mut self, block: &Block) -> Result<(), TraceFault> {
        let number = block.count(b'p', "P of G10")?;
        let missing = TraceFault::WordMissing { what: "P of G10" };
        match block.count(b'l', "L of G10")? {
            Some(1) => self.set_length(block, number.ok_or(missing)?),
            Some(10) => self.measure(block, number.ok_or(missing)?, self.offsets.index),
            Some(11) => self.measure(block, number.ok_or(missing)?, FIXTURE),
            Some(kind @ (2 | 20)) => {
                // 0 is the one in force
                let index = match number.ok_or(missing)? {
                    0 => self.offsets.index,
                    number => number as usize - 1,
                };
                if index >= SYSTEMS {
                    return Err(TraceFault::NotNatural { what: "P of G10, 0 to 9" });
                }
                self.set_zero(block, index, kind == 20);
            }
            Some(_) => self.note(Gap::Code { code: "this form of G10".into() }),
            None => return Err(TraceFault::WordMissing { what: "L of G10" }),
        }
        Ok(())
    }

    fn set_length(&mut self, block: &Block, number: u32) {
        let words = self.lengths(block);
        let known = self.lengths.get(&number).copied().unwrap_or_default();
        self.keep_length(number, [0, 1, 2].map(|axis| words[axis].unwrap_or(known[axis])));
    }

    /// L10, L11: the length with which the position where the machine stands has the coordinates of the block.
    fn measure(&mut self, block: &Block, number: u32, system: usize) {
        let words = self.lengths(block);
        let known = self.lengths.get(&number).copied().unwrap_or_default();
        let machine = self.offsets.in_machine(self.position);
        let mut there = self.offsets;
        there.tool = [0.0; 3];
        if system != self.offsets.index {
            there.call(system);
            there.local = [0.0; 3];
        }
        let position = there.of_machine(machine);
        self.keep_length(number, [0, 1, 2].map(|axis| words[axis].map_or(known[axis], |word| position[axis] - word)));
    }

    fn keep_length(&mut self, number: u32, length: [f64; 3]) {
        // more tools than any magazine: such a program counts, it does not measure
        if self.lengths.len() < 10_000 {
            self.lengths.insert(number, length);
        }
    }

    /// L2 and L20: the zero of a coordinate system.
    fn set_zero(&mut self, block: &Block, index: usize, measured_here: bool) {
        let words = self.lengths(block);
        let machine = self.offsets.in_machine(self.position);
        let turn = block.word(b'r').filter(|_| !measured_here);
        let measured = self.offsets.origin_for(machine, words, index);
        let Some(stored) = self.offsets.stored.get_mut(index) else { return };
        let origin =
            if measured_here { measured } else { [0, 1, 2].map(|axis| words[axis].unwrap_or(stored.origin[axis])) };
        *stored = System { origin, turn_deg: turn.unwrap_or(stored.turn_deg) };
        if index == self.offsets.index {
            self.call_system(index);
        }
    }

    /// The end that a block's words name, in the program's coordinates, mm.
    pub(super) fn target(&mut self, block: &Block, of_machine: bool) -> Result<[f64; 3], TraceFault> {
        let words = self.lengths(block);
        for (positioned, word) in self.positioned.iter_mut().zip(words) {
            *positioned |= word.is_some();
        }
        let position = self.position;
        if of_machine {
            let machine = self.offsets.in_machine(position);
            let end = [0, 1, 2].map(|axis| words[axis].unwrap_or(machine[axis]));
            return Ok(self.offsets.of_machine(end));
        }
        let mut end = [0, 1, 2].map(|axis| match words[axis] {
            Some(word) if self.modes.common.incremental => position[axis] + word,
            word => word.unwrap_or(position[axis]),
        });
        if block.distance.is_some() || block.angle.is_some() {
            if words[0].is_some() || words[1].is_some() {
                return Err(TraceFault::PolarWithCartesian);
            }
            self.positioned = [true, true, self.positioned[2]];
            [end[0], end[1]] = self.polar_target(block);
        }
        Ok(end)
    }

    /// `@` and `^`: distance from the program's zero and angle, or what is added to them.
    fn polar_target(&self, block: &Block) -> [f64; 2] {
        let (distance, angle) = super::path::polar(self.position);
        let word = block.distance.map(|word| word * self.modes.unit());
        if self.modes.common.incremental {
            return super::path::cartesian(distance + word.unwrap_or(0.0), angle + block.angle.unwrap_or(0.0));
        }
        super::path::cartesian(word.unwrap_or(distance), block.angle.unwrap_or(angle))
    }

    /// How far the tip would go, mm.
    pub(super) fn distance_to(&self, end: [f64; 3]) -> f64 {
        let [x, y, z] = less(end, self.position);
        libm::sqrt(x * x + y * y + z * z)
    }
}
