//! Each extension by hand: a parabola, kinks, poles, points, boxes without end.

use super::*;
use crate::graph::parse;

fn interval(lo: f64, hi: f64) -> Interval {
    Interval::new(lo, hi).unwrap()
}

/// The output f of a graph.
fn formula(text: &str) -> Formula {
    let graph = parse(text).unwrap();
    Formula::new(&graph, graph.output("f").unwrap())
}

fn boxed(ends: &[(f64, f64)]) -> Vec<Decorated> {
    ends.iter().map(|&(lo, hi)| Decorated::new(interval(lo, hi))).collect()
}

/// x (10 - x).
const PARABOLA: &str = "v0 = var x\nv1 = const 10\nv2 = sub v1, v0\nv3 = mul v0, v2\nout f = v3";

#[test]
fn names_lead_back() {
    for &extension in Extension::ALL {
        assert_eq!(extension.to_string().parse(), Ok(extension));
    }
    let said = "taylor".parse::<Extension>().unwrap_err().to_string();
    assert!(said.contains("`taylor`") && said.contains("affine1") && said.contains("centred2"));
}

#[test]
fn each_extension_of_a_parabola() {
    // The range on [4, 6] is [24, 25].
    let f = formula(PARABOLA);
    let on = |extension, parts| f.enclose_in_parts(extension, &boxed(&[(4.0, 6.0)]), parts);
    let expect = |extension, lo, hi| {
        let found = on(extension, 1);
        assert_eq!((found.interval(), found.decoration()), (interval(lo, hi), Decoration::Com), "{extension}");
    };
    expect(Extension::Natural, 16.0, 36.0);
    // 25 - e^2 without the sign of the square.
    expect(Extension::Affine(Symbols::One), 24.0, 26.0);
    expect(Extension::Intersected(Symbols::Three), 24.0, 26.0);
    // A full form sees that the factors are opposite.
    expect(Extension::Affine(Symbols::Full), 24.0, 25.0);
    // 25 + [-2, 2] [-1, 1], and 25 + 0 [-1, 1] - [0, 1].
    expect(Extension::MeanValue, 23.0, 27.0);
    expect(Extension::SecondOrder, 24.0, 25.0);
}

#[test]
fn parts_converge_and_cover() {
    let f = formula(PARABOLA);
    for &extension in Extension::ALL {
        let mut before = f64::INFINITY;
        for parts in [4, 16, 64, 256] {
            let found = f.enclose_in_parts(extension, &boxed(&[(4.0, 6.0)]), parts).interval();
            assert!(found.contains_interval(interval(24.0, 25.0)), "{extension}: {found}");
            let excess = found.width() - 1.0;
            // Halved parts halve the excess of the natural extension and quarter that of all others.
            let order = if extension == Extension::Natural { 1.0 } else { 2.0 };
            assert!(
                excess <= before * 4f64.powf(-order) * 1.01 + 1e-13,
                "{extension} in {parts}: {excess} after {before}"
            );
            before = excess;
        }
    }
}

#[test]
fn points_and_unbounded_inputs_are_not_cut() {
    let f = formula("v0 = var x\nv1 = var y\nv2 = add v0, v1\nout f = v2");
    let found = f.enclose_in_parts(Extension::Natural, &boxed(&[(1.0, 1.0), (2.0, f64::INFINITY)]), 1000);
    assert_eq!((found.interval(), found.decoration()), (interval(3.0, f64::INFINITY), Decoration::Dac));
}

#[test]
fn what_is_not_continuous_falls_back() {
    // 1/x across its pole, floor across a step, the square root beyond its domain.
    let texts = [
        "v0 = var x\nv1 = const 1\nv2 = div v1, v0\nout f = v2",
        "v0 = var x\nv1 = floor v0\nout f = v1",
        "v0 = var x\nv1 = sqrt v0\nout f = v1",
    ];
    for text in texts {
        let f = formula(text);
        let x = boxed(&[(-1.0, 2.0)]);
        let natural = f.enclose(Extension::Natural, &x);
        assert!(natural.decoration() < Decoration::Dac);
        for extension in [Extension::MeanValue, Extension::SecondOrder] {
            assert_eq!(f.enclose(extension, &x), natural, "{extension}");
        }
        for &extension in Extension::ALL {
            let found = f.enclose(extension, &x);
            assert!(found.interval().contains_interval(interval(0.0, 1.0)), "{extension}: {found}");
            assert_eq!(found.decoration(), natural.decoration());
        }
    }
}

#[test]
fn kinks_have_a_mean_value_form_and_none_of_second_order() {
    // |x| + x on [-1, 3]: 1 + 1 + [0, 2] [-2, 2].
    let f = formula("v0 = var x\nv1 = abs v0\nv2 = add v0, v1\nout f = v2");
    for extension in [Extension::MeanValue, Extension::SecondOrder] {
        assert_eq!(f.enclose(extension, &boxed(&[(-1.0, 3.0)])).interval(), interval(-2.0, 6.0));
    }
}

#[test]
fn nowhere_defined_is_empty() {
    let f = formula("v0 = var x\nv1 = ln v0\nv2 = mul v1, v1\nout f = v2");
    for &extension in Extension::ALL {
        let found = f.enclose(extension, &boxed(&[(-2.0, -1.0)]));
        assert_eq!((found.interval(), found.decoration()), (Interval::EMPTY, Decoration::Trv), "{extension}");
    }
}

#[test]
fn infinite_boxes_are_no_trouble() {
    let f = formula("v0 = var x\nv1 = sqr v0\nv2 = exp v1\nv3 = sub v2, v0\nout f = v3");
    for &extension in Extension::ALL {
        for ends in [(f64::NEG_INFINITY, f64::INFINITY), (1.0, f64::INFINITY), (f64::MIN, f64::MAX), (1e300, 1e301)] {
            let found = f.enclose(extension, &boxed(&[ends]));
            assert!(found.interval().hi() == f64::INFINITY, "{extension} on {ends:?}: {found}");
        }
    }
}

#[test]
fn costs_are_counted() {
    let f = formula(PARABOLA);
    let cost = |extension| f.operations(extension);
    assert_eq!(cost(Extension::Natural), 2 + 14);
    assert!(cost(Extension::Affine(Symbols::One)) < cost(Extension::Affine(Symbols::Three)));
    assert!(cost(Extension::Affine(Symbols::Three)) < cost(Extension::Intersected(Symbols::Three)));
    assert!(cost(Extension::MeanValue) < cost(Extension::SecondOrder));
}
