//! Programs against direct evaluation of the expression tree, and their shape.

use std::collections::BTreeMap;

use proptest::prelude::*;

use super::*;
use pebo_cas::{Arena, Expr, Function, Node, Rational, Symbol};

/// A value and a bound on the effect of rounding in any order of the same operations.
#[derive(Clone, Copy, Debug)]
struct Rounded {
    value: f64,
    error: f64,
}

/// Direct evaluation of the tree, with the running error bound of each operation.
fn evaluate(arena: &Arena, expr: Expr, point: &BTreeMap<Symbol, f64>) -> Rounded {
    let mut known: BTreeMap<Expr, Rounded> = BTreeMap::new();
    for e in arena.postorder(&[expr]) {
        let exact = |value: f64| Rounded { value, error: f64::EPSILON * value.abs() };
        let rounded = match arena.node(e) {
            Node::Number(value) => exact(value.to_f64()),
            Node::Pi => exact(std::f64::consts::PI),
            Node::Symbol(symbol) => Rounded { value: point[&symbol], error: 0.0 },
            Node::Sum(sum) => {
                let constant = exact(sum.constant.to_f64());
                let (mut total, mut size) = (constant, constant.value.abs());
                for (term, coefficient) in &sum.terms {
                    let (term, c) = (known[term], coefficient.to_f64());
                    total.value += c * term.value;
                    total.error += c.abs() * term.error;
                    size += (c * term.value).abs();
                }
                let operations = f64::from(u32::try_from(sum.terms.len()).unwrap()) + 2.0;
                total.error += operations * f64::EPSILON * size;
                total
            }
            Node::Product(product) => {
                let mut total = exact(product.coefficient.to_f64());
                for (base, exponent) in &product.factors {
                    let (base, k) = (known[base], exponent.to_f64());
                    let value = base.value.powf(k);
                    let slope = (k * base.value.powf(k - 1.0)).abs();
                    let error = slope * base.error + (k.abs() + 2.0) * f64::EPSILON * value.abs();
                    total.error = total.error * value.abs() + total.value.abs() * error;
                    total.value *= value;
                    total.error += f64::EPSILON * total.value.abs();
                }
                total
            }
            Node::Call(function, arguments) => {
                let a = known[&arguments[0]];
                let (value, slope) = match function {
                    Function::Sin => (a.value.sin(), 1.0),
                    Function::Cos => (a.value.cos(), 1.0),
                    Function::Tanh => (a.value.tanh(), 1.0),
                    Function::Abs => (a.value.abs(), 1.0),
                    Function::Exp => (a.value.exp(), a.value.exp()),
                    Function::Atan2 => {
                        let b = known[&arguments[1]];
                        (a.value.atan2(b.value), 2.0 / a.value.hypot(b.value))
                    }
                    other => panic!("{other:?} is not generated"),
                };
                let second = arguments.get(1).map_or(0.0, |b| known[b].error);
                Rounded { value, error: slope * (a.error + second) + 2.0 * f64::EPSILON * value.abs() }
            }
        };
        known.insert(e, rounded);
    }
    known[&expr]
}

/// One construction step: the operation, and its expressions in the pool.
type Step = (u8, u8, u8);

const NAMES: [&str; 5] = ["p", "q", "x", "y", "E"];

/// Expressions built step by step; a step whose value is out of proportion at the point is left out.
fn grow(arena: &Arena, point: &BTreeMap<Symbol, f64>, steps: &[Step]) -> Vec<Expr> {
    let mut pool: Vec<Expr> = NAMES.iter().map(|name| arena.variable(name)).collect();
    pool.push(arena.number(Rational::new(2, 3).unwrap()));
    pool.push(arena.number(-3));
    pool.push(arena.pi());
    let count = pool.len();
    for &(kind, a, b) in steps {
        let (a, b) = (pool[usize::from(a) % pool.len()], pool[usize::from(b) % pool.len()]);
        let positive = arena.add(arena.one(), arena.mul(a, a));
        let fraction = |n: i64, d: i64| Rational::new(n, d).unwrap();
        let grown = match kind % 14 {
            0 | 1 => arena.add(a, b),
            2 | 3 => arena.sub(a, b),
            4 | 5 => arena.mul(a, b),
            6 => arena.div(b, positive),
            7 => arena.power(a, &fraction(3, 1)),
            8 => arena.power(positive, &fraction(-3, 2)),
            9 => arena.power(positive, &fraction(1, 3)),
            10 => arena.call(Function::Sin, &[a]),
            11 => arena.call(Function::Cos, &[a]),
            12 => arena.call(Function::Atan2, &[b, positive]),
            _ => arena.neg(arena.call(Function::Tanh, &[a])),
        };
        let value = evaluate(arena, grown, point).value;
        if value.is_finite() && value.abs() < 1e6 {
            pool.push(grown);
        }
    }
    pool.split_off(count)
}

fn point(arena: &Arena, values: [f64; 5]) -> BTreeMap<Symbol, f64> {
    NAMES.iter().map(|name| arena.symbol(name)).zip(values).collect()
}

fn run(program: &Program, point: &BTreeMap<Symbol, f64>) -> Vec<f64> {
    let inputs: Vec<f64> = program.inputs.iter().map(|symbol| point[symbol]).collect();
    let mut outputs = vec![0.0; program.outputs.len()];
    Interpreter::new(program).run(&inputs, &mut outputs);
    outputs
}

/// Factors are regrouped and divisions turned into multiplications by reciprocals: each adds roundings of the size that
/// the running error counts already.
const REGROUPED: f64 = 8.0;

fn assert_close(arena: &Arena, exprs: &[Expr], values: &[f64], point: &BTreeMap<Symbol, f64>) {
    for (&expr, &value) in exprs.iter().zip(values) {
        let direct = evaluate(arena, expr, point);
        let difference = (value - direct.value).abs();
        assert!(
            difference <= REGROUPED * direct.error + f64::MIN_POSITIVE,
            "{}: {value} against {}, bound {}",
            arena.print(expr),
            direct.value,
            direct.error
        );
    }
}

fn steps() -> impl Strategy<Value = Vec<Step>> {
    proptest::collection::vec(any::<Step>(), 1..30)
}

proptest! {
    #[test]
    fn a_program_has_the_value_of_its_expressions(
        steps in steps(),
        values in proptest::array::uniform5(-2.0..2.0_f64),
    ) {
        let arena = Arena::new();
        let point = point(&arena, values);
        let exprs = grow(&arena, &point, &steps);
        let inputs: Vec<Symbol> = point.keys().copied().collect();
        let program = lower(&arena, &inputs, &exprs).unwrap();
        assert_close(&arena, &exprs, &run(&program, &point), &point);
        prop_assert_eq!(&program, &lower(&arena, &inputs, &exprs).unwrap());
        prop_assert!(program.uses().iter().all(|&uses| uses > 0));
    }

    #[test]
    fn staging_changes_no_value(
        steps in steps(),
        values in proptest::array::uniform5(-2.0..2.0_f64),
    ) {
        let arena = Arena::new();
        let mut point = point(&arena, values);
        let exprs = grow(&arena, &point, &steps);
        let parameters = [arena.symbol("p"), arena.symbol("q"), arena.symbol("E")];
        let (sampled, arguments) = ([arena.symbol("x")], vec![arena.symbol("y")]);
        let (first, second) = exprs.split_at(exprs.len() / 2);
        let task = |outputs: &[Expr], is_regular| Task {
            arguments: arguments.clone(),
            parts: Vec::new(),
            outputs: outputs.to_vec(),
            is_regular,
        };
        let staged = stage(&arena, &parameters, &sampled, &[task(first, true), task(second, false)]).unwrap();
        let stored = run(&staged.setup, &point);
        point.extend(staged.constants.iter().map(|constant| constant.0).zip(stored));
        let kept = run(&staged.sample, &point);
        point.extend(staged.terms.iter().map(|term| term.0).zip(kept));
        for (program, outputs) in staged.programs.iter().zip([first, second]) {
            assert_close(&arena, outputs, &run(program, &point), &point);
        }
    }
}

/// The cost of lowering one formula in x, y, d (arguments) and L, C (parameters).
fn staged(build: impl FnOnce(&Arena) -> Vec<Expr>) -> (Arena, StagedPrograms) {
    let arena = Arena::new();
    let parameters = ["L", "C"].map(|name| arena.symbol(name));
    let arguments = ["x", "y", "d"].map(|name| arena.symbol(name)).to_vec();
    let outputs = build(&arena);
    let task = Task { arguments, parts: Vec::new(), outputs, is_regular: true };
    let staged = stage(&arena, &parameters, &[], &[task]).unwrap();
    (arena, staged)
}

fn cost(build: impl FnOnce(&Arena) -> Vec<Expr>) -> String {
    let (_, staged) = staged(build);
    Cost::of(&staged.programs[0]).to_string()
}

fn formulas(build: impl FnOnce(&Arena) -> Vec<Expr>) -> Vec<String> {
    let (arena, staged) = staged(build);
    staged.constants.iter().map(|constant| arena.print(constant.1)).collect()
}

#[test]
fn small_powers_are_multiplications() {
    let power = |n: i64, d: i64| cost(move |a| vec![a.power(a.variable("x"), &Rational::new(n, d).unwrap())]);
    assert_eq!(power(2, 1), "1 mul");
    assert_eq!(power(3, 1), "2 mul");
    assert_eq!(power(4, 1), "2 mul");
    assert_eq!(power(7, 1), "4 mul");
    assert_eq!(power(-1, 1), "1 div");
    assert_eq!(power(-2, 1), "1 mul, 1 div");
    assert_eq!(power(1, 2), "1 sqrt");
    assert_eq!(power(3, 2), "1 mul, 1 sqrt");
    assert_eq!(power(-1, 2), "1 div, 1 sqrt");
    assert_eq!(power(1, 3), "1 call");
    assert_eq!(power(1_000_000_000, 1), "1 call");
}

#[test]
fn a_power_of_a_quotient_keeps_the_range_of_its_base() {
    let arena = Arena::new();
    let [q, r, k] = ["q", "r", "K"].map(|name| arena.symbol(name));
    let [x, y, z] = [q, r, k].map(|symbol| arena.of_symbol(symbol));
    let power = |base, exponent: i64| arena.power(base, &Rational::from(exponent));
    let (one, tiny) = (arena.one(), Rational::from(10).pow(-1000).unwrap());
    // Each alone leaves the range of double precision.
    let huge = BTreeMap::from([(q, 2e10), (r, 1e10), (k, -1e10)]);
    let cases = [
        (power(arena.div(x, y), 100), 2_f64.powi(100)),
        (power(arena.div(x, z), 101), -(2_f64.powi(101))),
        (arena.div(one, power(arena.div(z, x), 99)), -(2_f64.powi(99))),
        (arena.scale(power(x, 100), &tiny), 2_f64.powi(100)),
        (arena.scale(power(x, 100), &-&tiny), -(2_f64.powi(100))),
    ];
    for (value, expected) in cases {
        let outputs = vec![value];
        let task = Task { arguments: vec![q, r], parts: Vec::new(), outputs, is_regular: true };
        let staged = stage(&arena, &[k], &[], &[task]).unwrap();
        let setup = run(&staged.setup, &huge);
        let mut point = huge.clone();
        point.extend(staged.constants.iter().map(|constant| constant.0).zip(setup));
        let computed = run(&staged.programs[0], &point)[0];
        let rounding = 300.0 * f64::EPSILON * expected.abs();
        assert!((computed - expected).abs() <= rounding, "{}: {computed}", arena.print(value));
    }
}

#[test]
fn constants_that_meet_are_one() {
    let build = |a: &Arena| {
        let [x, y, d, l, c] = ["x", "y", "d", "L", "C"].map(|name| a.variable(name));
        let sum = a.add(a.div(x, l), a.div(y, l));
        vec![a.div(sum, c), a.add(d, sum)]
    };
    // The factor 1/L leaves the sum and meets 1/C in the first: no product of both is computed with each call.
    assert_eq!(formulas(build), ["1/L", "1/(L*C)"]);
    assert_eq!(cost(build), "2 add, 2 mul");
}

#[test]
fn several_denominators_are_one_division() {
    let quotient = cost(|a| {
        let [x, y, d] = ["x", "y", "d"].map(|name| a.variable(name));
        vec![a.div(a.div(x, y), a.add(a.one(), d))]
    });
    assert_eq!(quotient, "1 add, 1 mul, 1 div");
}

#[test]
fn a_shared_denominator_is_divided_by_once() {
    let shared = cost(|a| {
        let [x, y, d] = ["x", "y", "d"].map(|name| a.variable(name));
        let below = a.add(a.one(), a.mul(d, d));
        vec![a.div(x, below), a.div(y, below)]
    });
    assert_eq!(shared, "1 add, 3 mul, 1 div");
}

#[test]
fn a_fraction_before_a_quotient_joins_the_divisor_that_nothing_shares() {
    let third = |shared: bool| {
        cost(move |a| {
            let [x, y, d] = ["x", "y", "d"].map(|name| a.variable(name));
            let scaled = |e| a.scale(a.div(e, d), &Rational::new(1, 3).unwrap());
            if shared { vec![scaled(x), scaled(y)] } else { vec![scaled(x)] }
        })
    };
    // x/(3*d); then x*(1/3)*(1/d).
    assert_eq!(third(false), "1 mul, 1 div");
    assert_eq!(third(true), "4 mul, 1 div");
}

#[test]
fn a_division_by_parameters_is_a_multiplication() {
    let build = |a: &Arena| {
        let [x, d, l, c] = ["x", "d", "L", "C"].map(|name| a.variable(name));
        vec![a.div(a.mul(x, d), a.mul(l, c)), a.neg(a.div(d, a.mul(l, c)))]
    };
    assert_eq!(formulas(build), ["1/(L*C)"]);
    assert_eq!(cost(build), "1 add, 2 mul");
}

#[test]
fn a_coefficient_joins_its_parameters() {
    let build = |a: &Arena| {
        let [x, y, l] = ["x", "y", "L"].map(|name| a.variable(name));
        vec![a.sub(y, a.scale(a.div(x, l), &Rational::from(2)))]
    };
    assert_eq!(formulas(build), ["2/L"]);
    assert_eq!(cost(build), "1 add, 1 mul");
}

#[test]
fn factors_of_several_summands_leave_the_sum() {
    let build = |a: &Arena| {
        let [x, y, l, c] = ["x", "y", "L", "C"].map(|name| a.variable(name));
        vec![a.sum([a.mul(x, l), a.neg(a.mul(x, c)), a.mul(y, a.sub(l, c))])]
    };
    assert_eq!(formulas(build), ["L - C"]);
    assert_eq!(cost(build), "1 add, 1 mul");
}

/// The smaller power leaves x^2*y + x*d: the larger would leave y + d/x.
#[test]
fn the_smallest_power_leaves_a_sum() {
    let square = |a: &Arena| {
        let [x, y, d] = ["x", "y", "d"].map(|name| a.variable(name));
        (a.product([x, x, y]), a.mul(x, d))
    };
    assert_eq!(cost(|a| vec![a.add(square(a).0, square(a).1)]), "1 add, 2 mul");
    let inverse = |a: &Arena, expr: Expr| a.div(a.one(), expr);
    let below = |a: &Arena| {
        let [x, y, d] = ["x", "y", "d"].map(|name| a.variable(name));
        a.add(a.mul(y, inverse(a, x)), a.mul(d, inverse(a, a.mul(x, x))))
    };
    assert_eq!(cost(|a| vec![below(a)]), "1 add, 2 mul, 1 div");
}

#[test]
fn a_pair_of_factors_that_products_share_is_one_value() {
    let products = cost(|a| {
        let [x, y, d] = ["x", "y", "d"].map(|name| a.variable(name));
        let sin = a.call(Function::Sin, &[x]);
        vec![a.product([x, y, d]), a.product([x, d, sin])]
    });
    assert_eq!(products, "3 mul, 1 call");
}

#[test]
fn signs_end_in_subtractions() {
    let negated =
        |build: fn(&Arena, [Expr; 3]) -> Expr| cost(|a| vec![build(a, ["x", "y", "d"].map(|name| a.variable(name)))]);
    assert_eq!(negated(|a, [x, y, d]| a.sub(x, a.sub(y, d))), "2 add");
    assert_eq!(negated(|a, [x, y, d]| a.neg(a.mul(a.sub(x, y), d))), "1 add, 1 mul");
    assert_eq!(negated(|a, [x, y, _]| a.sub(x, a.mul(a.sub(y, a.one()), y))), "2 add, 1 mul");
    assert_eq!(negated(|a, [x, ..]| a.scale(x, &Rational::from(-2))), "1 mul");
    assert_eq!(negated(|a, [x, y, _]| a.neg(a.add(x, y))), "2 add");
}

#[test]
fn a_sign_never_costs_a_second_division() {
    let quotients = cost(|a| {
        let [x, y, d] = ["x", "y", "d"].map(|name| a.variable(name));
        let below = a.add(a.one(), a.mul(d, d));
        vec![a.div(x, below), a.neg(a.div(y, below))]
    });
    assert_eq!(quotients, "2 add, 3 mul, 1 div");
}

#[test]
fn both_signs_of_a_difference_are_one_value() {
    let both = cost(|a| {
        let [x, y, d] = ["x", "y", "d"].map(|name| a.variable(name));
        let difference = a.sub(a.one(), d);
        vec![a.add(x, a.mul(y, difference)), a.add(y, a.mul(x, a.sub(d, a.one())))]
    });
    assert_eq!(both, "3 add, 2 mul");
}

#[test]
fn irrational_numbers_are_computed_once() {
    let build = |a: &Arena| {
        let x = a.variable("x");
        vec![a.mul(x, a.sqrt(a.number(2))), a.mul(x, a.pi())]
    };
    assert_eq!(cost(build), "2 mul");
    assert_eq!(formulas(build), ["sqrt(2)"]);
}

/// The stored values of a sample of q and r, and the cost of computing them and of the rest, for formulas that run with
/// every sample and for one that does not.
fn sampled(regular: &[&str], seldom: &str, name: impl Fn(&Arena, &str) -> Expr) -> (Vec<String>, [String; 3]) {
    let arena = Arena::new();
    let [q, r, u, l] = ["q", "r", "u", "L"].map(|name| arena.symbol(name));
    let task = |outputs: Vec<Expr>, is_regular| Task { arguments: vec![u], parts: Vec::new(), outputs, is_regular };
    let regular = regular.iter().map(|text| name(&arena, text)).collect();
    let tasks = [task(regular, true), task(vec![name(&arena, seldom)], false)];
    let staged = stage(&arena, &[l], &[q, r], &tasks).unwrap();
    let terms = staged.terms.iter().map(|term| arena.print(term.1)).collect();
    let [first, second] = staged.programs.as_slice() else { panic!("two tasks") };
    (terms, [&staged.sample, first, second].map(|program| Cost::of(program).to_string()))
}

#[test]
fn a_kept_value_is_not_kept_again_with_a_number() {
    let formula = |a: &Arena, text: &str| {
        let [q, r, u] = ["q", "r", "u"].map(|name| a.variable(name));
        let both = a.sum([a.mul(q, r), a.power(q, &Rational::from(2)), r]);
        match text {
            "B" => both,
            // As a rate with its regressor: five times most of it, and B.
            "5*u + 5*exp(u) + tanh(u)*B" => {
                let [exp, tanh] = [Function::Exp, Function::Tanh].map(|function| a.call(function, &[u]));
                let five = Rational::from(5);
                a.add(a.combine(&Rational::ZERO, [(u, five.clone()), (exp, five)]), a.mul(tanh, both))
            }
            other => panic!("{other}"),
        }
    };
    let (terms, cost) = sampled(&["5*u + 5*exp(u) + tanh(u)*B", "B"], "B", formula);
    assert_eq!(terms, ["r + q*(q + r)"]);
    assert_eq!(cost, ["2 add, 1 mul", "2 add, 3 mul, 2 call", "none"]);
}

#[test]
fn terms_of_a_sample_are_kept_if_they_take_more_than_a_few_operations() {
    let formula = |a: &Arena, text: &str| {
        let [q, r, u] = ["q", "r", "u"].map(|name| a.variable(name));
        match text {
            "u*q*r" => a.product([u, q, r]),
            "u*sin(q)" => a.mul(u, a.call(Function::Sin, &[q])),
            "u/(1 + r)" => a.div(u, a.add(a.one(), r)),
            "cos(q)" => a.call(Function::Cos, &[q]),
            "u + cos(r)" => a.add(u, a.call(Function::Cos, &[r])),
            other => panic!("{other}"),
        }
    };
    let kept = |regular: &[&str], seldom| sampled(regular, seldom, formula);
    let costs = |costs: [&str; 3]| costs.map(str::to_owned);
    assert_eq!(kept(&["u*q*r"], "cos(q)"), (vec![], costs(["none", "2 mul", "1 call"])));
    let (terms, cost) = kept(&["u*sin(q)", "u/(1 + r)"], "u + cos(r)");
    assert_eq!(terms, ["sin(q)", "1/(r + 1)"]);
    assert_eq!(cost, costs(["1 add, 1 div, 1 call", "2 mul", "1 add, 1 call"]));
    // A rare function uses values that are stored anyway.
    let (terms, cost) = kept(&["u + cos(r)"], "u + cos(r)");
    assert_eq!(terms, ["cos(r)"]);
    assert_eq!(cost, costs(["1 call", "1 add", "1 add"]));
}

#[test]
fn an_angle_that_others_make_up_is_not_called_for() {
    use Function::{Cos, Sin};

    let angles = |terms: &[(Function, &[(&str, i64)])]| {
        let arena = Arena::new();
        let inputs = ["q", "r", "s"].map(|name| arena.symbol(name));
        let values = terms.iter().map(|&(function, summands)| {
            let angle = arena.sum(summands.iter().map(|&(q, k)| arena.scale(arena.variable(q), &Rational::from(k))));
            arena.call(function, &[angle])
        });
        let values: Vec<Expr> = values.collect();
        Cost::of(&lower(&arena, &inputs, &values).unwrap()).to_string()
    };
    // Sine and cosine of one angle are one call.
    assert_eq!(angles(&[(Sin, &[("q", 1)]), (Cos, &[("q", 1)])]), "1 call");
    assert_eq!(angles(&[(Sin, &[("q", 1)]), (Sin, &[("r", 1)]), (Cos, &[("q", 1), ("r", 1)])]), "1 add, 2 mul, 2 call");
    assert_eq!(
        angles(&[(Sin, &[("q", 1)]), (Sin, &[("r", 1)]), (Sin, &[("q", 1), ("r", -1)])]),
        "1 add, 2 mul, 2 call"
    );
    // q + r less q is r; twice an angle is its sum with itself.
    assert_eq!(angles(&[(Sin, &[("q", 1)]), (Cos, &[("q", 1), ("r", 1)]), (Sin, &[("r", 1)])]), "1 add, 2 mul, 2 call");
    assert_eq!(angles(&[(Sin, &[("q", 1)]), (Cos, &[("q", 2)])]), "1 add, 2 mul, 1 call");
    // Neither summand is needed by itself.
    assert_eq!(angles(&[(Sin, &[("q", 1), ("r", 1)]), (Sin, &[("s", 1)])]), "1 add, 2 call");
    // One of q + r, q + s and q + r + s needs calls, whatever the others have in common with it.
    let sums: [&[(&str, i64)]; 3] = [&[("q", 1), ("r", 1)], &[("q", 1), ("s", 1)], &[("q", 1), ("r", 1), ("s", 1)]];
    let [first, second, both] = sums.map(|sum| (Cos, sum));
    assert_eq!(angles(&[(Sin, &[("r", 1)]), (Sin, &[("s", 1)]), first, second, both]), "4 add, 6 mul, 3 call");
}

#[test]
fn a_subexpression_is_computed_once_as_written() {
    let arena = Arena::new();
    let [x, y, d] = ["x", "y", "d"].map(|name| arena.symbol(name));
    let (part, difference) = (arena.generated("B"), arena.sub(arena.one(), arena.of_symbol(d)));
    let named = arena.of_symbol(part);
    let outputs = [x, y].map(|signal| arena.mul(arena.of_symbol(signal), named)).to_vec();
    let task = |parts, outputs| Task { arguments: vec![x, y, d], parts, outputs, is_regular: true };
    let value = arena.mul(difference, arena.of_symbol(y));
    let staged = stage(&arena, &[], &[], &[task(vec![(part, value)], [vec![named], outputs].concat())]).unwrap();
    assert_eq!(Cost::of(&staged.programs[0]).to_string(), "1 add, 3 mul");
    let point = BTreeMap::from([(x, 3.0), (y, 5.0), (d, 0.25)]);
    assert_eq!(run(&staged.programs[0], &point), [3.75, 11.25, 18.75]);
    let unknown = arena.symbol("w");
    let strange = stage(&arena, &[], &[], &[task(vec![(part, arena.of_symbol(unknown))], vec![named])]);
    assert_eq!(strange.unwrap_err(), UndeclaredSymbol(unknown));
}

#[test]
fn an_undeclared_symbol_is_an_error() {
    let arena = Arena::new();
    let (x, w) = (arena.symbol("x"), arena.symbol("w"));
    let sum = arena.add(arena.of_symbol(x), arena.of_symbol(w));
    assert_eq!(lower(&arena, &[x], &[sum]), Err(UndeclaredSymbol(w)));
}

#[test]
fn an_exponential_less_one_keeps_its_digits() {
    let arena = Arena::new();
    let [x, y] = ["x", "y"].map(|name| arena.variable(name));
    let symbols = [x, y].map(|expr| arena.as_symbol(expr).unwrap());
    let less_one = arena.sub(arena.call(Function::Exp, &[x]), arena.one());
    let scaled = arena.sub(arena.mul(y, arena.call(Function::Exp, &[x])), y);
    let program = lower(&arena, &symbols, &[less_one, arena.neg(less_one), scaled]).unwrap();
    let exponentials = program.operations.iter().filter(|operation| matches!(operation, Operation::ExpM1(..)));
    assert_eq!((exponentials.count(), program.operations.len()), (1, 3), "{program:?}");
    let mut values = [0.0; 3];
    Interpreter::new(&program).run(&[1e-9, 2.0], &mut values);
    // The difference exp(1e-9) - 1 = 1e-9 + 5e-19 has 7 digits; a few roundings are allowed.
    for (value, exact) in values.into_iter().zip([1.000_000_000_5e-9, -1.000_000_000_5e-9, 2.000_000_001e-9]) {
        assert!((value / exact - 1.0).abs() < 4.0 * f64::EPSILON, "{value:e}");
    }
}

#[test]
fn a_logarithm_beside_one_keeps_its_digits() {
    let arena = Arena::new();
    let x = arena.symbol("x");
    let argument = |constant: i64| arena.add(arena.of_symbol(x), arena.number(constant));
    let values = [1, 2].map(|constant| arena.call(Function::Log, &[argument(constant)]));
    let program = lower(&arena, &[x], &values).unwrap();
    let beside = program.operations.iter().filter(|operation| matches!(operation, Operation::Ln1P(..)));
    assert_eq!((beside.count(), program.operations.len()), (1, 3), "{program:?}");
    let mut values = [0.0; 2];
    Interpreter::new(&program).run(&[1e-9], &mut values);
    // The logarithm of the sum has 7 digits of ln(1 + 1e-9) = 1e-9 - 5e-19.
    assert!((values[0] / 9.999_999_995e-10 - 1.0).abs() < 4.0 * f64::EPSILON, "{:e}", values[0]);
}

#[test]
fn harmonics_are_worked_out_once() {
    let arena = Arena::new();
    let q = arena.symbol("q");
    let harmonic = |k: i64| arena.call(Function::Cos, &[arena.scale(arena.of_symbol(q), &Rational::from(k))]);
    let sum = arena.sum((1..=40).map(harmonic));
    let program = lower(&arena, &[q], &[sum]).unwrap();
    // Six operations for each harmonic and one for its summand.
    assert!(program.operations.len() <= 40 * 7, "{}", program.operations.len());
}
