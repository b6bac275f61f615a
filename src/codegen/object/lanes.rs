//! Vectors of 128 bits in the code around kernels: moving numbers between rows and lanes. Nothing here computes with numbers
//! but to compare them, so no rounding mode matters.

use cranelift_codegen::ir::ConstantData;
use cranelift_codegen::ir::InstBuilder;
use cranelift_codegen::ir::MemFlagsData;
use cranelift_codegen::ir::Type;
use cranelift_codegen::ir::Value;
use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::types;
use cranelift_frontend::FunctionBuilder;

use crate::codegen::emit::VECTOR;
use crate::derive::Precision;

/// The lane types of a precision.
#[derive(Debug, Clone, Copy)]
pub struct Format {
    pub number: Type,
    pub scalar: Type,
    /// The integer of a lane's width.
    pub word: Type,
}

impl Format {
    pub fn of(precision: Precision) -> Self {
        match precision {
            Precision::Single => Self { number: types::F32X4, scalar: types::F32, word: types::I32 },
            Precision::Double => Self { number: types::F64X2, scalar: types::F64, word: types::I64 },
        }
    }

    /// Bytes of a number.
    pub fn size(self) -> i64 {
        self.scalar.bytes().into()
    }

    /// Numbers in a vector.
    pub fn lanes(self) -> i64 {
        VECTOR as i64 / self.size()
    }
}

/// An address with a distance from it.
#[derive(Debug, Clone, Copy)]
pub struct Place {
    pub base: Value,
    pub offset: i32,
}

/// Memory of the caller: of any alignment.
pub const THEIRS: MemFlagsData = MemFlagsData::new().with_notrap();

/// Emits vector code into a function.
pub struct Lanes<'a, 'f> {
    pub b: &'a mut FunctionBuilder<'f>,
    pub format: Format,
}

impl Lanes<'_, '_> {
    fn bytes(&mut self, vector: Vec<u8>) -> Value {
        let handle = self.b.func.dfg.constants.insert(ConstantData::from(vector));
        self.b.ins().vconst(self.format.number, handle)
    }

    /// The low bits of a word in every lane.
    fn every(&mut self, word: u64) -> Value {
        let size = self.format.size() as usize;
        self.bytes(word.to_le_bytes()[..size].repeat(VECTOR / size))
    }

    /// The bits of +inf, by which the sign bit is found, too.
    fn infinity_bits(&self) -> u64 {
        match self.format.scalar {
            types::F32 => f32::INFINITY.to_bits().into(),
            _ => f64::INFINITY.to_bits(),
        }
    }

    pub fn negate(&mut self, vector: Value) -> Value {
        let sign = self.every(1 << (self.format.scalar.bits() - 1));
        self.b.ins().bxor(vector, sign)
    }

    /// Lower and upper ends as kernels take them, the lower negated. Where they are NaN or not in order: the whole line.
    pub fn ends(&mut self, lo: Value, hi: Value) -> (Value, Value) {
        let ordered = self.b.ins().fcmp(FloatCC::LessThanOrEqual, lo, hi);
        let ordered = self.b.ins().bitcast(self.format.number, MemFlagsData::new(), ordered);
        let infinity = self.every(self.infinity_bits());
        let negated = self.negate(lo);
        let negated = self.b.ins().bitselect(ordered, negated, infinity);
        let hi = self.b.ins().bitselect(ordered, hi, infinity);
        (negated, hi)
    }

    /// The same for one interval in words.
    pub fn scalar_ends(&mut self, place: Place) -> (Value, Value) {
        let upper = place.offset + self.format.size() as i32;
        let lo = self.b.ins().load(self.format.scalar, THEIRS, place.base, place.offset);
        let hi = self.b.ins().load(self.format.scalar, THEIRS, place.base, upper);
        let ordered = self.b.ins().fcmp(FloatCC::LessThanOrEqual, lo, hi);
        let [lo, hi] = [lo, hi].map(|end| self.b.ins().bitcast(self.format.word, MemFlagsData::new(), end));
        let sign = self.b.ins().iconst(self.format.word, 1 << (self.format.scalar.bits() - 1));
        let infinity = self.infinity_bits() as i64;
        let infinity = self.b.ins().iconst(self.format.word, infinity);
        let negated = self.b.ins().bxor(lo, sign);
        (self.b.ins().select(ordered, negated, infinity), self.b.ins().select(ordered, hi, infinity))
    }

    /// One vector from consecutive numbers.
    pub fn load(&mut self, place: Place) -> Value {
        self.b.ins().load(self.format.number, THEIRS, place.base, place.offset)
    }

    pub fn store(&mut self, vector: Value, place: Place) {
        self.b.ins().store(THEIRS, vector, place.base, place.offset);
    }

    /// One vector from a number at each place.
    pub fn gather(&mut self, places: &[Place]) -> Value {
        let mut vector = None;
        for (lane, place) in places.iter().enumerate() {
            let number = self.b.ins().load(self.format.scalar, THEIRS, place.base, place.offset);
            vector = Some(match vector {
                None => self.b.ins().scalar_to_vector(self.format.number, number),
                Some(vector) => self.b.ins().insertlane(vector, number, lane as u8),
            });
        }
        vector.expect("a vector has lanes")
    }

    pub fn scatter(&mut self, vector: Value, places: &[Place]) {
        for (lane, place) in places.iter().enumerate() {
            let number = self.b.ins().extractlane(vector, lane as u8);
            self.b.ins().store(THEIRS, number, place.base, place.offset);
        }
    }

    /// The first numbers of the pairs at the places, and the second ones.
    pub fn gather_pairs(&mut self, places: &[Place]) -> (Value, Value) {
        if self.format.scalar == types::F64 {
            let [x, y] = [0, 1].map(|lane| self.load(places[lane]));
            return (self.shuffle(x, y, &[0, 2]), self.shuffle(x, y, &[1, 3]));
        }
        let [x, y] = [0, 2].map(|lane| {
            let [p, q] = [places[lane], places[lane + 1]]
                .map(|place| self.b.ins().load(types::I64, THEIRS, place.base, place.offset));
            let pair = self.b.ins().scalar_to_vector(types::I64X2, p);
            let pairs = self.b.ins().insertlane(pair, q, 1);
            self.b.ins().bitcast(self.format.number, little_endian(), pairs)
        });
        (self.shuffle(x, y, &[0, 2, 4, 6]), self.shuffle(x, y, &[1, 3, 5, 7]))
    }

    /// The reverse of [`Lanes::gather_pairs`].
    pub fn scatter_pairs(&mut self, first: Value, second: Value, places: &[Place]) {
        if self.format.scalar == types::F64 {
            for (place, picked) in places.iter().zip([[0, 2], [1, 3]]) {
                let pair = self.shuffle(first, second, &picked);
                self.store(pair, *place);
            }
            return;
        }
        for (places, picked) in places.chunks(2).zip([[0, 4, 1, 5], [2, 6, 3, 7]]) {
            let pairs = self.shuffle(first, second, &picked);
            let pairs = self.b.ins().bitcast(types::I64X2, little_endian(), pairs);
            for (lane, place) in places.iter().enumerate() {
                let pair = self.b.ins().extractlane(pairs, lane as u8);
                self.b.ins().store(THEIRS, pair, place.base, place.offset);
            }
        }
    }

    /// Lanes of `x` followed by `y`, picked by their index.
    fn shuffle(&mut self, x: Value, y: Value, picked: &[u8]) -> Value {
        let size = self.format.size() as u8;
        let bytes: Vec<u8> = picked.iter().flat_map(|lane| (0..size).map(move |byte| lane * size + byte)).collect();
        let mask = self.b.func.dfg.immediates.push(ConstantData::from(bytes));
        let [x, y] = [x, y].map(|vector| self.b.ins().bitcast(types::I8X16, little_endian(), vector));
        let picked = self.b.ins().shuffle(x, y, mask);
        self.b.ins().bitcast(self.format.number, little_endian(), picked)
    }

    /// The low 32 bits of every lane in a row.
    pub fn store_words(&mut self, vector: Value, place: Place) {
        if self.format.scalar == types::F32 {
            return self.store(vector, place);
        }
        let halves = Lanes { b: &mut *self.b, format: Format::of(Precision::Single) }.low_halves(vector);
        let words = self.b.ins().extractlane(halves, 0);
        self.b.ins().store(THEIRS, words, place.base, place.offset);
    }

    /// The even lanes of this format, as one number.
    fn low_halves(&mut self, vector: Value) -> Value {
        let even = self.shuffle(vector, vector, &[0, 2, 0, 2]);
        self.b.ins().bitcast(types::I64X2, little_endian(), even)
    }

    /// The low 32 bits of every lane to the places.
    pub fn scatter_words(&mut self, vector: Value, places: &[Place]) {
        let words = if self.format.scalar == types::F64 { types::I64X2 } else { types::I32X4 };
        let words = self.b.ins().bitcast(words, little_endian(), vector);
        for (lane, place) in places.iter().enumerate() {
            let word = self.b.ins().extractlane(words, lane as u8);
            if self.format.scalar == types::F64 {
                self.b.ins().istore32(THEIRS, word, place.base, place.offset);
            } else {
                self.b.ins().store(THEIRS, word, place.base, place.offset);
            }
        }
    }
}

/// Between vectors of different lanes Cranelift wants to know in which order they lie.
fn little_endian() -> MemFlagsData {
    MemFlagsData::new().with_endianness(cranelift_codegen::ir::Endianness::Little)
}
