//! What an exported function does in its rounding mode: it moves rows or columns through packets on the stack and calls the
//! kernel on them.
//!
//! A body takes one argument, the record of the exported function's arguments and of the kernel that was chosen. Rows go
//! through in chunks of as many packets as fit into [`CHUNK`] bytes, at least one. A chunk is filled and emptied one vector
//! of 128 bits at a time. A vector that reaches beyond the last row repeats rows: each of its lanes stands for some row, and
//! equal rows give equal results, so that no lane has to be kept from storing.

use cranelift_codegen::Context;
use cranelift_codegen::ir::AbiParam;
use cranelift_codegen::ir::Block;
use cranelift_codegen::ir::InstBuilder;
use cranelift_codegen::ir::MemFlagsData;
use cranelift_codegen::ir::Signature;
use cranelift_codegen::ir::StackSlotData;
use cranelift_codegen::ir::StackSlotKind;
use cranelift_codegen::ir::Value;
use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::types;
use cranelift_codegen::isa::CallConv;
use cranelift_codegen::isa::TargetIsa;
use cranelift_frontend::FunctionBuilder;
use cranelift_frontend::FunctionBuilderContext;

use crate::codegen::emit;
use crate::codegen::emit::VECTOR;
use crate::codegen::object::Kind;
use crate::codegen::object::Parts;
use crate::codegen::object::Routine;
use crate::codegen::object::lanes::Format;
use crate::codegen::object::lanes::Lanes;
use crate::codegen::object::lanes::Place;
use crate::codegen::object::lanes::THEIRS;
use crate::derive::Rounding;
use crate::diagnostic::Diagnostic;

/// The offsets of the record that a body takes.
pub mod record {
    pub const INPUTS: i32 = 0;
    pub const PARAMETERS: i32 = 8;
    pub const OUTPUTS: i32 = 16;
    /// Unset for points.
    pub const VERDICTS: i32 = 24;
    /// Rows, or groups of packets.
    pub const COUNT: i32 = 32;
    pub const KERNEL: i32 = 40;
    pub const SIZE: u32 = 48;
}

/// Bytes of one slot of one packet.
const PACKET: i64 = 64;

/// Vectors of one slot of one packet.
const VECTORS: i64 = PACKET / VECTOR as i64;

/// Bytes of packets on the stack, unless one group takes more.
const CHUNK: i64 = 4 << 10;

/// Bytes of stack for packets and parameters at most.
pub const MAX_BUFFER: i64 = 256 << 10;

/// How a caller lays out its arrays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Layout {
    Rows,
    Columns,
    Packets,
}

impl Layout {
    pub fn suffix(self) -> &'static str {
        match self {
            Layout::Rows => "",
            Layout::Columns => "_columns",
            Layout::Packets => "_packets",
        }
    }
}

/// What a body has to know of its routine.
pub struct Shape {
    format: Format,
    kind: Kind,
    variables: i64,
    outputs: i64,
    uniforms: i64,
    /// Proves nothing: all verdicts are 0.
    silent: bool,
}

impl Shape {
    /// # Errors
    /// `KERNEL_TOO_LARGE` if one group of packets is too much for the stack; `INTERNAL` if the counts do not match the program.
    pub fn of(routine: &Routine) -> Result<Self, Diagnostic> {
        let program = &routine.program;
        let shape = Self {
            format: Format::of(program.precision),
            kind: routine.kind,
            variables: routine.variables as i64,
            outputs: routine.outputs as i64,
            uniforms: program.uniform_slots as i64,
            silent: routine.rounding == Rounding::Nearest,
        };
        let fits = shape.input_slots() == program.input_slots as i64
            && shape.output_slots() == program.outputs.len() as i64
            && shape.uniforms == routine.defaults.len() as i64
            && shape.uniforms % shape.ends() == 0;
        if !fits {
            return Err(emit::internal(&format!("the program of {} has another shape", routine.symbol)));
        }
        let buffer = shape.group_bytes().saturating_add(shape.uniforms.saturating_mul(shape.format.size()));
        if buffer > MAX_BUFFER {
            return Err(emit::too_large(program));
        }
        Ok(shape)
    }

    /// Numbers of one coordinate or parameter.
    fn ends(&self) -> i64 {
        match self.kind {
            Kind::Boxes => 2,
            Kind::Points => 1,
        }
    }

    fn input_slots(&self) -> i64 {
        self.variables * self.ends()
    }

    fn output_slots(&self) -> i64 {
        match self.kind {
            Kind::Boxes => 3 * self.outputs,
            Kind::Points => self.outputs,
        }
    }

    fn group_bytes(&self) -> i64 {
        (self.input_slots() + self.output_slots()).saturating_mul(PACKET)
    }

    /// Groups of one chunk.
    fn groups(&self) -> i64 {
        (CHUNK / self.group_bytes().max(1)).max(1)
    }

    /// Rows of one group.
    fn group_rows(&self) -> i64 {
        PACKET / self.format.size()
    }
}

/// Of bodies: the record.
pub fn signature() -> Signature {
    let mut signature = Signature::new(CallConv::SystemV);
    signature.params = vec![AbiParam::new(types::I64)];
    signature
}

/// Fills `context` with a body.
pub fn define(shape: &Shape, layout: Layout, parts: Parts, isa: &dyn TargetIsa, context: &mut Context) {
    context.func.signature = signature();
    let mut builder_context = FunctionBuilderContext::new();
    let mut b = FunctionBuilder::new(&mut context.func, &mut builder_context);
    let entry = b.create_block();
    b.append_block_params_for_function_params(entry);
    b.switch_to_block(entry);
    let record = b.block_params(entry)[0];
    let mut body = Body { b: &mut b, shape, layout, parts, record };
    if let Some(probe) = body.parts.probe {
        body.b.ins().call(probe, &[]);
    }
    match layout {
        Layout::Packets => body.packets(),
        Layout::Rows | Layout::Columns => body.chunks(),
    }
    b.ins().return_(&[]);
    b.seal_all_blocks();
    b.finalize(isa.frontend_config());
}

/// Fills `context` with a function that does nothing but touch the pages of a frame of so many bytes.
pub fn define_probe(bytes: u32, isa: &dyn TargetIsa, context: &mut Context) {
    let mut builder_context = FunctionBuilderContext::new();
    let mut b = FunctionBuilder::new(&mut context.func, &mut builder_context);
    let entry = b.create_block();
    b.switch_to_block(entry);
    b.create_sized_stack_slot(StackSlotData::new(StackSlotKind::ExplicitSlot, bytes, 4));
    b.ins().return_(&[]);
    b.seal_all_blocks();
    b.finalize(isa.frontend_config());
}

struct Body<'a, 'f> {
    b: &'a mut FunctionBuilder<'f>,
    shape: &'a Shape,
    layout: Layout,
    parts: Parts,
    record: Value,
}

/// The caller's arrays.
#[derive(Clone, Copy)]
struct Arrays {
    inputs: Value,
    outputs: Value,
    verdicts: Value,
    /// Rows of all of them.
    count: Value,
}

/// The rows that the lanes of one vector stand for.
struct Rows {
    each: Vec<Value>,
    /// Whether they follow each other.
    in_a_row: bool,
}

impl<'f> Body<'_, 'f> {
    fn lanes(&mut self) -> Lanes<'_, 'f> {
        Lanes { b: self.b, format: self.shape.format }
    }

    fn size(&self) -> i64 {
        self.shape.format.size()
    }

    fn field(&mut self, offset: i32) -> Value {
        self.b.ins().load(types::I64, MemFlagsData::trusted(), self.record, offset)
    }

    /// The caller's parameters through `convert`, or those of a caller that gives none.
    fn own_or_default(&mut self, convert: impl FnOnce(&mut Self, Value) -> Value) -> Value {
        let given = self.field(record::PARAMETERS);
        let Some(defaults) = self.parts.defaults else { return given };
        let [own, default, done] = [(); 3].map(|()| self.b.create_block());
        self.b.append_block_param(done, types::I64);
        self.b.ins().brif(given, own, &[], default, &[]);
        self.b.switch_to_block(own);
        let converted = convert(self, given);
        self.b.ins().jump(done, &[converted.into()]);
        self.b.switch_to_block(default);
        let address = self.b.ins().symbol_value(types::I64, defaults);
        self.b.ins().jump(done, &[address.into()]);
        self.b.switch_to_block(done);
        self.b.block_params(done)[0]
    }

    fn call_kernel(&mut self, arguments: [Value; 4]) {
        let kernel = self.field(record::KERNEL);
        let signature = self.b.import_signature(emit::signature());
        self.b.ins().call_indirect(signature, kernel, &arguments);
    }

    /// Bytes of the stack that start at a multiple of a packet's alignment, which the stack itself does not have.
    fn buffer(&mut self, bytes: i64) -> Value {
        let size = u32::try_from(bytes + PACKET - 1).expect("checked by `Shape::of`");
        let slot = self.b.create_sized_stack_slot(StackSlotData::new(StackSlotKind::ExplicitSlot, size, 4));
        let address = self.b.ins().stack_addr(types::I64, slot, 0);
        let beyond = self.b.ins().iadd_imm_s(address, PACKET - 1);
        self.b.ins().band_imm_s(beyond, -PACKET)
    }

    /// Packets are what kernels take.
    fn packets(&mut self) {
        let [inputs, outputs, count] = [record::INPUTS, record::OUTPUTS, record::COUNT].map(|field| self.field(field));
        let uniforms = self.own_or_default(|_, given| given);
        self.call_kernel([inputs, outputs, uniforms, count]);
    }

    fn chunks(&mut self) {
        let shape = self.shape;
        let (groups, group_rows) = (shape.groups(), shape.group_rows());
        let arrays = Arrays {
            inputs: self.field(record::INPUTS),
            outputs: self.field(record::OUTPUTS),
            verdicts: if shape.kind == Kind::Boxes { self.field(record::VERDICTS) } else { self.record },
            count: self.field(record::COUNT),
        };
        let uniforms = self.own_or_default(|body, given| body.uniforms(given));
        let buffer = self.buffer(groups * shape.group_bytes());
        let results = self.b.ins().iadd_imm_s(buffer, groups * shape.input_slots() * PACKET);

        // chunk(its first row)
        let [head, chunk, done] = [(); 3].map(|()| self.b.create_block());
        self.b.append_block_param(head, types::I64);
        let zero = self.b.ins().iconst(types::I64, 0);
        self.b.ins().jump(head, &[zero.into()]);
        self.b.switch_to_block(head);
        let start = self.b.block_params(head)[0];
        let more = self.b.ins().icmp(IntCC::UnsignedLessThan, start, arrays.count);
        self.b.ins().brif(more, chunk, &[], done, &[]);

        self.b.switch_to_block(chunk);
        let left = self.b.ins().isub(arrays.count, start);
        let rows = self.b.ins().iconst(types::I64, groups * group_rows);
        let rows = self.b.ins().umin(left, rows);
        let now = self.rounded_up(rows, group_rows);
        let filled = self.b.ins().imul_imm_s(now, VECTORS);
        self.each_vector(filled, start, arrays, |body, vector, rows| {
            let packets = body.packet(buffer, vector, shape.input_slots());
            body.fill(arrays, rows, packets);
        });
        self.call_kernel([buffer, results, uniforms, now]);
        let used = self.rounded_up(rows, shape.format.lanes());
        self.each_vector(used, start, arrays, |body, vector, rows| {
            let packets = body.packet(results, vector, shape.output_slots());
            body.empty(arrays, rows, packets);
        });
        let next = self.b.ins().iadd(start, rows);
        self.b.ins().jump(head, &[next.into()]);
        self.b.switch_to_block(done);
    }

    /// `rows / unit`, rounded up; the unit is a power of two, the rows are few.
    fn rounded_up(&mut self, rows: Value, unit: i64) -> Value {
        let beyond = self.b.ins().iadd_imm_s(rows, unit - 1);
        self.b.ins().ushr_imm_u(beyond, i64::from(unit.trailing_zeros()))
    }

    /// The caller's parameters as uniforms.
    fn uniforms(&mut self, given: Value) -> Value {
        let (count, size, ends) = (self.shape.uniforms, self.size(), self.shape.ends());
        let uniforms = self.buffer(count * size);
        let word = self.shape.format.word;
        for i in (0..count).step_by(ends as usize) {
            let offset = (i * size) as i32;
            if ends == 2 {
                let (negated, hi) = self.lanes().scalar_ends(Place { base: given, offset });
                self.b.ins().store(MemFlagsData::trusted(), negated, uniforms, offset);
                self.b.ins().store(MemFlagsData::trusted(), hi, uniforms, offset + size as i32);
            } else {
                let value = self.b.ins().load(word, THEIRS, given, offset);
                self.b.ins().store(MemFlagsData::trusted(), value, uniforms, offset);
            }
        }
        uniforms
    }

    /// Where a chunk's vector lies in packets of that many slots.
    fn packet(&mut self, buffer: Value, vector: Value, slots: i64) -> Value {
        let group = self.b.ins().ushr_imm_u(vector, i64::from(VECTORS.trailing_zeros()));
        let group = self.b.ins().imul_imm_s(group, slots * PACKET);
        let inside = self.b.ins().band_imm_s(vector, VECTORS - 1);
        let inside = self.b.ins().imul_imm_s(inside, VECTOR as i64);
        let packet = self.b.ins().iadd(buffer, group);
        self.b.ins().iadd(packet, inside)
    }

    /// A loop over the vectors of a chunk that starts at a row. Columns have two: where the array is no shorter than a
    /// vector, a vector beyond its end moves back to it and is one load still.
    fn each_vector(&mut self, vectors: Value, start: Value, arrays: Arrays, each: impl Fn(&mut Self, Value, &Rows)) {
        let lanes = self.shape.format.lanes();
        let done = self.b.create_block();
        if self.layout == Layout::Columns {
            let [long, short] = [(); 2].map(|()| self.b.create_block());
            let enough = self.b.ins().icmp_imm_u(IntCC::UnsignedGreaterThanOrEqual, arrays.count, lanes);
            self.b.ins().brif(enough, long, &[], short, &[]);
            self.b.switch_to_block(long);
            let last = self.b.ins().iadd_imm_s(arrays.count, -lanes);
            self.counted(vectors, done, |body, vector| {
                let row = body.first_row(start, vector);
                let row = body.b.ins().umin(row, last);
                each(body, vector, &Rows { each: vec![row], in_a_row: true });
            });
            self.b.switch_to_block(short);
        }
        let last = self.b.ins().iadd_imm_s(arrays.count, -1);
        self.counted(vectors, done, |body, vector| {
            let row = body.first_row(start, vector);
            let rows = (0..lanes).map(|lane| {
                let row = body.b.ins().iadd_imm_s(row, lane);
                body.b.ins().umin(row, last)
            });
            let rows = rows.collect();
            each(body, vector, &Rows { each: rows, in_a_row: false });
        });
        self.b.switch_to_block(done);
    }

    fn first_row(&mut self, start: Value, vector: Value) -> Value {
        let row = self.b.ins().imul_imm_s(vector, self.shape.format.lanes());
        self.b.ins().iadd(start, row)
    }

    /// A loop from 0 to `end`, then on to `done`.
    fn counted(&mut self, end: Value, done: Block, each: impl FnOnce(&mut Self, Value)) {
        let [head, step] = [(); 2].map(|()| self.b.create_block());
        self.b.append_block_param(head, types::I64);
        let zero = self.b.ins().iconst(types::I64, 0);
        self.b.ins().jump(head, &[zero.into()]);
        self.b.switch_to_block(head);
        let i = self.b.block_params(head)[0];
        let more = self.b.ins().icmp(IntCC::UnsignedLessThan, i, end);
        self.b.ins().brif(more, step, &[], done, &[]);
        self.b.switch_to_block(step);
        each(self, i);
        let next = self.b.ins().iadd_imm_s(i, 1);
        self.b.ins().jump(head, &[next.into()]);
    }

    /// Where the entries of an array are for these rows, entry 0 first. A row of the array has `entries` entries of
    /// `numbers` numbers of `size` bytes; in columns each number is its own entry.
    fn walk(&mut self, array: Value, count: Value, rows: &Rows, row_bytes: i64, size: i64) -> Walk {
        match self.layout {
            Layout::Columns => {
                let bases = rows.each.iter().map(|&row| self.element(array, row, size)).collect();
                let step = self.b.ins().imul_imm_s(count, size);
                Walk { bases, offset: 0, step: Some(step) }
            }
            _ => {
                let bases = rows.each.iter().map(|&row| self.element(array, row, row_bytes)).collect();
                Walk { bases, offset: 0, step: None }
            }
        }
    }

    fn element(&mut self, array: Value, index: Value, bytes: i64) -> Value {
        let offset = self.b.ins().imul_imm_s(index, bytes);
        self.b.ins().iadd(array, offset)
    }

    /// The places of the walk's next entry, which has that many bytes in a row of the array.
    fn next(&mut self, walk: &mut Walk, bytes: i64) -> Vec<Place> {
        let places = walk.bases.iter().map(|&base| Place { base, offset: walk.offset }).collect();
        match walk.step {
            Some(step) => walk.bases.iter_mut().for_each(|base| *base = self.b.ins().iadd(*base, step)),
            None => walk.offset += bytes as i32,
        }
        places
    }

    /// One vector of the walk's next column.
    fn load(&mut self, walk: &mut Walk, rows: &Rows) -> Value {
        let places = self.next(walk, self.size());
        if rows.in_a_row { self.lanes().load(places[0]) } else { self.lanes().gather(&places) }
    }

    fn store(&mut self, vector: Value, walk: &mut Walk, rows: &Rows) {
        let places = self.next(walk, self.size());
        if rows.in_a_row {
            self.lanes().store(vector, places[0]);
        } else {
            self.lanes().scatter(vector, &places);
        }
    }

    /// Rows to the inputs of a kernel.
    fn fill(&mut self, arrays: Arrays, rows: &Rows, packets: Value) {
        let size = self.size();
        let mut walk = self.walk(arrays.inputs, arrays.count, rows, self.shape.input_slots() * size, size);
        for variable in 0..self.shape.variables {
            let slot = (variable * self.shape.ends() * PACKET) as i32;
            let vectors = match (self.shape.kind, self.layout) {
                (Kind::Points, _) => vec![self.load(&mut walk, rows)],
                (Kind::Boxes, Layout::Rows) => {
                    let places = self.next(&mut walk, 2 * size);
                    let (lo, hi) = self.lanes().gather_pairs(&places);
                    let (negated, hi) = self.lanes().ends(lo, hi);
                    vec![negated, hi]
                }
                (Kind::Boxes, _) => {
                    let [lo, hi] = [(); 2].map(|()| self.load(&mut walk, rows));
                    let (negated, hi) = self.lanes().ends(lo, hi);
                    vec![negated, hi]
                }
            };
            for (i, vector) in vectors.into_iter().enumerate() {
                self.b.ins().store(MemFlagsData::trusted(), vector, packets, slot + i as i32 * PACKET as i32);
            }
        }
    }

    /// The outputs of a kernel to rows.
    fn empty(&mut self, arrays: Arrays, rows: &Rows, packets: Value) {
        let size = self.size();
        let row_bytes = self.shape.outputs * self.shape.ends() * size;
        let mut walk = self.walk(arrays.outputs, arrays.count, rows, row_bytes, size);
        let slot = |body: &mut Self, slot: i64| {
            let number = body.shape.format.number;
            body.b.ins().load(number, MemFlagsData::trusted(), packets, (slot * PACKET) as i32)
        };
        if self.shape.kind == Kind::Points {
            for output in 0..self.shape.outputs {
                let value = slot(self, output);
                self.store(value, &mut walk, rows);
            }
            return;
        }
        for output in 0..self.shape.outputs {
            let (negated, hi) = (slot(self, 3 * output), slot(self, 3 * output + 1));
            let lo = self.lanes().negate(negated);
            if self.layout == Layout::Rows {
                let places = self.next(&mut walk, 2 * size);
                self.lanes().scatter_pairs(lo, hi, &places);
            } else {
                self.store(lo, &mut walk, rows);
                self.store(hi, &mut walk, rows);
            }
        }
        self.verdicts(arrays, rows, |body, output| slot(body, 3 * output + 2));
    }

    /// The verdicts of a kernel to rows, if the caller wants them.
    fn verdicts(&mut self, arrays: Arrays, rows: &Rows, word: impl Fn(&mut Self, i64) -> Value) {
        let size = i64::from(types::I32.bytes());
        let [wanted, done] = [(); 2].map(|()| self.b.create_block());
        self.b.ins().brif(arrays.verdicts, wanted, &[], done, &[]);
        self.b.switch_to_block(wanted);
        let mut walk = self.walk(arrays.verdicts, arrays.count, rows, self.shape.outputs * size, size);
        for output in 0..self.shape.outputs {
            let places: Vec<Place> = self.next(&mut walk, size);
            let mut words = word(self, output);
            if self.shape.silent {
                words = self.b.ins().bxor(words, words);
            }
            match rows.in_a_row {
                true => self.lanes().store_words(words, places[0]),
                false => self.lanes().scatter_words(words, &places),
            }
        }
        self.b.ins().jump(done, &[]);
        self.b.switch_to_block(done);
    }
}

/// The way through an array's entries.
struct Walk {
    /// The address of the current entry for each lane, less `offset`.
    bases: Vec<Value>,
    offset: i32,
    /// From one column to the next; none in rows.
    step: Option<Value>,
}
