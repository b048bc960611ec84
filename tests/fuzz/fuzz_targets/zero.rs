//! Random expressions: a formula minus itself rewritten is never refuted, and a refuted formula is not zero.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pebo_cas::Domain;
use pebo_cas::Relation;
use pebo_cas::graph::function::Function;
use pebo_cas::Rational;
use pebo_cas::domain::zero::{Answer, decide};
use pebo_cas::{Arena, Expr};

/// The most bytes of a program: longer ones only repeat.
const LONGEST: usize = 64;

/// Builds an expression by a stack program: operands and operations, a byte each.
fn build(arena: &Arena, program: &[u8]) -> Expr {
    let mut stack: Vec<Expr> = Vec::new();
    for &byte in program.iter().take(LONGEST) {
        let mut pop = || stack.pop().unwrap_or_else(|| arena.variable("x"));
        let pushed = match byte % 24 {
            0 => arena.variable("x"),
            1 => arena.variable("y"),
            2 => arena.variable("p"),
            3 => arena.pi(),
            4 => arena.number(i64::from(byte / 24) - 4),
            5 => arena.number(Rational::new(i64::from(byte / 24) + 1, 6).unwrap_or(Rational::ONE)),
            6 | 7 => {
                let (a, b) = (pop(), pop());
                arena.add(a, b)
            }
            8 => {
                let (a, b) = (pop(), pop());
                arena.sub(a, b)
            }
            9 | 10 => {
                let (a, b) = (pop(), pop());
                arena.mul(a, b)
            }
            11 => {
                let (a, b) = (pop(), pop());
                arena.div(a, b)
            }
            12 => arena.power(pop(), &Rational::from(2)),
            13 => arena.sqrt(pop()),
            14 => arena.power(pop(), &Rational::from(-1)),
            15 => {
                let (a, b) = (pop(), pop());
                arena.call(Function::Atan2, &[a, b])
            }
            code => {
                let unary: Vec<Function> =
                    Function::table().iter().filter(|row| row.arity == 1).map(|row| row.function).collect();
                let chosen = usize::from(code - 16) + 8 * usize::from(byte / 24 % 2);
                arena.call(unary[chosen % unary.len()], &[pop()])
            }
        };
        stack.push(pushed);
    }
    arena.sum(stack)
}

fuzz_target!(|program: &[u8]| {
    let arena = Arena::new();
    let expr = build(&arena, program);
    let mut domain = Domain::default();
    domain.facts.assume(arena.variable("p"), Relation::Positive);
    // (e + x)^2 - e^2 - 2 e x - x^2, which construction does not see through.
    let x = arena.variable("x");
    let square = |e: Expr| arena.power(e, &Rational::from(2));
    let expanded = arena.sum([square(expr), arena.scale(arena.mul(expr, x), &Rational::from(2)), square(x)]);
    let identity = arena.sub(square(arena.add(expr, x)), expanded);
    assert!(!matches!(decide(&arena, identity, &domain), Answer::NonZero(_)), "{}", arena.print(expr));
    // A refutation holds at its own point, enclosed anew.
    if let Answer::NonZero(witness) = decide(&arena, expr, &domain) {
        let again = arena.separated_from_zero(expr, &witness.point);
        assert!(again.is_some_and(|value| !value.contains_zero()), "{}", arena.print(expr));
    }
});
