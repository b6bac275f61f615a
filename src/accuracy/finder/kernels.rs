//! The kernels that answer the finders' questions, and how the lanes of their packets are filled.

use std::sync::Arc;

use crate::accuracy::finder::Finder;
use crate::accuracy::finder::Settings;
use crate::accuracy::finder::search::Answer;
use crate::accuracy::finder::search::Span;
use crate::derive;
use crate::derive::Arithmetic;
use crate::derive::Output;
use crate::derive::Precision;
use crate::derive::RayGraph;
use crate::derive::Rounding;
use crate::derive::Spec;
use crate::diagnostic::Diagnostic;
use crate::graph::Graph;
use crate::graph::Value;
use crate::interval::Interval;
use crate::kernel::Backend;
use crate::kernel::Real;
use crate::kernel::verdict;
use crate::program::scene::COORDINATES;
use crate::program::scene::Scene;
use crate::program::scene::Shape;
use crate::render::Batch;
use crate::render::Compiled;
use crate::render::Format;
use crate::render::Program;
use crate::render::Ray;
use crate::render::less_half;
use crate::render::simplify;

/// Output slots of an enclosure.
const ENCLOSURE: usize = 3;

/// The bounds of all rays, rounded up to powers of two, and what they have in common.
pub struct Reach {
    origin: f64,
    direction: f64,
    end: f64,
    /// The origin or the direction of all rays, which then is no lane input.
    shared_origin: Option<[f64; 3]>,
    shared_direction: Option<[f64; 3]>,
    /// The domain, so much wider that rounding does not carry any point of a ray inside it out of it. What is said of
    /// points outside the domain is not used: rays are clipped to it.
    domain: Vec<Interval>,
    rounding: Rounding,
}

impl Reach {
    /// `None` if no ray meets the domain.
    pub fn new(rays: &[Option<Ray>], scene: &Scene, settings: &Settings) -> Option<Self> {
        let met: Vec<(&Ray, f64)> =
            rays.iter().flatten().filter_map(|ray| Some((ray, ray.clip(&scene.domain)?.1[1]))).collect();
        let &(first, _) = met.first()?;
        let largest = |part: fn(&Ray) -> [f64; 3]| {
            let most = met.iter().flat_map(|(ray, _)| part(ray)).fold(0.0f64, |m, x| m.max(x.abs()));
            most.max(f64::MIN_POSITIVE).log2().ceil().exp2()
        };
        let shared = |part: fn(&Ray) -> [f64; 3]| {
            let value = part(first);
            met.iter().all(|(ray, _)| part(ray) == value).then_some(value)
        };
        let (origin, direction) = (largest(|ray| ray.origin), largest(|ray| ray.direction));
        let end = met.iter().fold(0.0f64, |m, &(_, exit)| m.max(exit)).max(f64::MIN_POSITIVE).log2().ceil().exp2();
        // A coordinate o + t d errs by a few units in the last place of its terms, 24 or 53 bits below them.
        let bits = if settings.precision == Precision::Single { -20 } else { -49 };
        let far = scene.domain.iter().fold(0.0f64, |m, range| m.max(range.mag()));
        let margin = (origin + direction * end + far) * f64::from(bits).exp2();
        let wider = |range: &Interval| Interval::new(range.lo() - margin, range.hi() + margin);
        Some(Self {
            origin,
            direction,
            end: 2.0 * end,
            shared_origin: shared(|ray| ray.origin),
            shared_direction: shared(|ray| ray.direction),
            domain: scene.domain.iter().map(|range| wider(range).unwrap_or(*range)).collect(),
            rounding: settings.rounding,
        })
    }

    fn promise(&self, scene: &Scene, name: &str) -> Option<Interval> {
        if let Some(parameter) = scene.parameters.iter().find(|parameter| parameter.name == name) {
            let range = parameter.range?;
            return Interval::new(f32::down(range.lo()).to_f64(), f32::up(range.hi()).to_f64());
        }
        if derive::ORIGIN.contains(&name) {
            Interval::new(-self.origin, self.origin)
        } else if derive::DIRECTION.contains(&name) {
            Interval::new(-self.direction, self.direction)
        } else if name == derive::PARAMETER {
            Interval::new(0.0, self.end)
        } else {
            None
        }
    }

    /// The inputs that differ from ray to ray.
    fn varying(&self) -> Vec<&'static str> {
        let mut names = Vec::new();
        if self.shared_origin.is_none() {
            names.extend(derive::ORIGIN);
        }
        if self.shared_direction.is_none() {
            names.extend(derive::DIRECTION);
        }
        names
    }

    /// Their values.
    fn values(&self, ray: &Ray) -> impl Iterator<Item = f64> + use<> {
        let origin = self.shared_origin.is_none().then_some(ray.origin);
        let direction = self.shared_direction.is_none().then_some(ray.direction);
        origin.into_iter().chain(direction).flatten()
    }

    /// The other inputs, rounded to nearest if kernels are.
    fn constants<T: Real>(&self) -> Vec<(&'static str, f64)> {
        let origin = self.shared_origin.map(|values| derive::ORIGIN.into_iter().zip(values));
        let direction = self.shared_direction.map(|values| derive::DIRECTION.into_iter().zip(values));
        let both = origin.into_iter().flatten().chain(direction.into_iter().flatten());
        both.map(|(name, value)| match self.rounding {
            Rounding::Outward => (name, value),
            Rounding::Nearest => (name, T::nearest(value).to_f64()),
        })
        .collect()
    }
}

/// The kernels of one shape.
pub struct Programs<T: Real> {
    /// Enclosure of the field, verdict of the condition.
    pub field: Program<T>,
    /// Enclosure of the slope, verdict of the field; for the finders that ask.
    pub slope: Option<Program<T>>,
    /// Value of the field; with rounding to nearest, for the finders that ask.
    pub point: Option<Program<T>>,
    /// As `field`, over boxes of the coordinates; for marches along an axis.
    pub boxes: Option<Program<T>>,
}

impl<T: Format> Programs<T> {
    pub fn new(
        scene: &Scene,
        shape: &Shape,
        reach: &Reach,
        settings: &Settings,
        backend: &dyn Backend,
    ) -> Result<Self, Diagnostic> {
        let constants = reach.constants::<T>();
        let make = |spec: Spec| -> Result<Program<T>, Diagnostic> {
            Ok(Compiled::<T>::new(backend, &spec)?.bind(&scene.parameters, &constants))
        };
        let orders = Orders { scene, shape, reach, settings };
        let finder = settings.finder;
        let slope = matches!(
            finder,
            Finder::Mitchell
                | Finder::IntervalNewton
                | Finder::AlefeldHansen
                | Finder::MrfNewton
                | Finder::PacketMitchell
        );
        let point = slope || matches!(finder, Finder::Mrf | Finder::MrfRo);
        Ok(Self {
            field: make(orders.field())?,
            slope: slope.then(|| make(orders.slope())).transpose()?,
            point: (point && settings.rounding == Rounding::Nearest).then(|| make(orders.point())).transpose()?,
            boxes: (finder == Finder::KMarch).then(|| make(orders.boxes())).transpose()?,
        })
    }
}

/// What the orders of a shape have in common.
struct Orders<'a> {
    scene: &'a Scene,
    shape: &'a Shape,
    reach: &'a Reach,
    settings: &'a Settings,
}

impl Orders<'_> {
    fn roots(&self) -> Vec<Value> {
        [self.shape.field].into_iter().chain(self.shape.condition).collect()
    }

    fn along_ray(&self) -> RayGraph {
        derive::along_ray(&self.scene.graph, &self.roots(), self.scene.dimension())
    }

    fn ray_lanes(&self) -> Vec<&'static str> {
        let mut lanes = self.reach.varying();
        lanes.push(derive::PARAMETER);
        lanes
    }

    fn field(&self) -> Spec {
        let mut ray = self.along_ray();
        let mut outputs = vec![Output::Enclosure(ray.roots[0])];
        if let Some(&condition) = ray.roots.get(1) {
            outputs.push(Output::Verdict(less_half(&mut ray.graph, condition)));
        }
        self.spec(ray.graph, self.ray_lanes(), outputs, &ray.coordinates, self.settings.arithmetic)
    }

    fn slope(&self) -> Spec {
        let mut ray = self.along_ray();
        let slope = derive::derivative(&mut ray.graph, ray.roots[0], ray.t);
        let outputs = vec![Output::Enclosure(slope), Output::Verdict(ray.roots[0])];
        self.spec(ray.graph, self.ray_lanes(), outputs, &ray.coordinates, Arithmetic::Interval)
    }

    fn point(&self) -> Spec {
        let ray = self.along_ray();
        let outputs = vec![Output::Value(ray.roots[0])];
        self.spec(ray.graph, self.ray_lanes(), outputs, &[], Arithmetic::Point)
    }

    fn boxes(&self) -> Spec {
        let mut graph = Graph::new();
        let coordinates: Vec<Value> = COORDINATES.iter().map(|name| graph.var(name)).collect();
        let roots = graph.import(&self.scene.graph, &self.roots(), &Default::default());
        let mut outputs = vec![Output::Enclosure(roots[0])];
        if let Some(&condition) = roots.get(1) {
            outputs.push(Output::Verdict(less_half(&mut graph, condition)));
        }
        self.spec(graph, COORDINATES.to_vec(), outputs, &coordinates, self.settings.arithmetic)
    }

    fn spec(
        &self,
        graph: Graph,
        lanes: Vec<&'static str>,
        outputs: Vec<Output>,
        coordinates: &[Value],
        arithmetic: Arithmetic,
    ) -> Spec {
        let promise = |name: &String| Some((name.clone(), self.reach.promise(self.scene, name)?));
        let promises: Vec<(String, Interval)> = graph.variables().iter().filter_map(promise).collect();
        let domain = coordinates.iter().copied().zip(self.reach.domain.iter().copied()).collect();
        let (graph, outputs, domain) = simplify(graph, outputs, domain, &promises);
        let uniforms = graph.variables().iter().filter(|name| !lanes.contains(&name.as_str())).cloned().collect();
        let symbols: &[&str] = match arithmetic {
            Arithmetic::Affine if lanes.contains(&derive::PARAMETER) => &[derive::PARAMETER],
            Arithmetic::Affine => &COORDINATES,
            Arithmetic::Interval | Arithmetic::Point => &[],
        };
        Spec {
            graph: Arc::new(graph),
            inputs: lanes.into_iter().map(str::to_owned).collect(),
            uniforms,
            outputs,
            domain,
            promises,
            arithmetic,
            symbols: symbols.iter().map(|&name| name.to_owned()).collect(),
            rounding: self.settings.rounding,
        }
    }
}

/// Writes rays and spans into a batch, and reads answers.
pub struct Lanes<'a> {
    pub reach: &'a Reach,
    /// Whether the shape has a condition, whose verdict then follows the enclosure.
    pub condition: bool,
}

impl Lanes<'_> {
    /// Writes the parts of a ray that differ from ray to ray.
    pub fn set_ray<T: Real>(&self, batch: &mut Batch<T>, lane: usize, ray: &Ray) {
        for (input, value) in self.reach.values(ray).enumerate() {
            self.set_range(batch, lane, input, [value, value]);
        }
    }

    /// Writes an interval of the ray parameter.
    pub fn set_span<T: Real>(&self, batch: &mut Batch<T>, lane: usize, span: Span) {
        let input = batch.input_slots() / 2 - 1;
        self.set_range(batch, lane, input, span);
    }

    /// Writes an interval: rounded outward, or each end to nearest where nothing is to be proved.
    pub fn set_range<T: Real>(&self, batch: &mut Batch<T>, lane: usize, input: usize, [lo, hi]: Span) {
        match self.reach.rounding {
            Rounding::Outward => batch.set_range(lane, input, lo, hi),
            Rounding::Nearest => batch.set_box(lane, input, T::nearest(-lo), T::nearest(hi)),
        }
    }

    /// Writes the box of coordinates that a ray crosses during a span.
    pub fn set_boxes<T: Real>(&self, batch: &mut Batch<T>, lane: usize, ray: &Ray, [start, end]: Span) {
        for axis in 0..3 {
            let (o, d) = (ray.origin[axis], ray.direction[axis]);
            let (a, b) = (o + start * d, o + end * d);
            // Each is rounded twice, by half a unit in the last place of the product and of the sum.
            let margin = match self.reach.rounding {
                Rounding::Outward => {
                    let product = (d * start).abs().max((d * end).abs());
                    f64::EPSILON * (a.abs().max(b.abs()) + product) + f64::MIN_POSITIVE
                }
                Rounding::Nearest => 0.0,
            };
            self.set_range(batch, lane, axis, [a.min(b) - margin, a.max(b) + margin]);
        }
    }

    /// Writes a ray to a lane of a point kernel.
    pub fn set_point_ray<T: Real>(&self, batch: &mut Batch<T>, lane: usize, ray: &Ray) {
        for (slot, value) in self.reach.values(ray).enumerate() {
            batch.set(lane, slot, T::nearest(value));
        }
    }

    /// Writes the ray parameter to a lane of a point kernel.
    pub fn set_point<T: Real>(&self, batch: &mut Batch<T>, lane: usize, t: f64) {
        batch.set(lane, batch.input_slots() - 1, T::nearest(t));
    }

    /// The answer of the field's kernel.
    pub fn field<T: Real>(&self, batch: &Batch<T>, lane: usize) -> Answer {
        let condition = if self.condition { batch.bits(lane, ENCLOSURE) } else { TRUE };
        Answer { condition, ..enclosure(batch, lane) }
    }

    /// The answer of the slope's kernel.
    pub fn slope<T: Real>(&self, batch: &Batch<T>, lane: usize) -> Answer {
        let continuous = batch.bits(lane, ENCLOSURE) & verdict::CONTINUOUS != 0;
        Answer { continuous, ..enclosure(batch, lane) }
    }

    /// The answer of the point kernel.
    pub fn point<T: Real>(&self, batch: &Batch<T>, lane: usize) -> Answer {
        let value = batch.get(lane, 0).to_f64();
        let bits = if value > 0.0 {
            verdict::POSITIVE
        } else if value < 0.0 {
            verdict::NEGATIVE
        } else {
            0
        };
        Answer { lo: value, hi: value, bits, continuous: false, condition: TRUE }
    }
}

/// The verdict of a condition that holds.
const TRUE: u32 = verdict::POSITIVE | verdict::CONTINUOUS;

fn enclosure<T: Real>(batch: &Batch<T>, lane: usize) -> Answer {
    let bits = batch.bits(lane, 2);
    Answer {
        lo: -batch.get(lane, 0).to_f64(),
        hi: batch.get(lane, 1).to_f64(),
        bits,
        continuous: bits & verdict::CONTINUOUS != 0,
        condition: TRUE,
    }
}
