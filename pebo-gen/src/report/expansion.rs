//! The plant that a class stands for: its equations, and what the class is known by.

use crate::cas::Expr;
use crate::plant::{Class, Plant};

/// What a class was expanded to, as formulas.
pub(super) struct Expansion {
    /// The key of the class.
    pub(super) class: &'static str,
    /// What the equations come from, by name: an energy, the matrices of a transform.
    pub(super) origin: Vec<(&'static str, String)>,
    /// States and outputs with their rates.
    pub(super) rates: Vec<(String, String)>,
    /// The components of the transform.
    pub(super) phi: Vec<String>,
    /// Positions with their velocities in z, for a mechanical plant.
    pub(super) velocity: Vec<(String, String)>,
}

/// The expansion of a plant that was written by class.
pub(super) fn of(plant: &Plant) -> Option<Expansion> {
    let class = plant.class.as_ref()?;
    let arena = &plant.arena;
    let states = plant.x.iter().map(|s| (s.symbol, s.rate.expr));
    let outputs = plant.y.iter().filter_map(|o| Some((o.symbol, o.rate?.expr)));
    let rates = states.chain(outputs).map(|(symbol, rate)| (arena.name(symbol), arena.print(rate)));
    let matrix = |rows: &[Vec<Expr>]| {
        let row = |row: &Vec<Expr>| format!("[{}]", row.iter().map(|e| arena.print(*e)).collect::<Vec<_>>().join(", "));
        format!("[{}]", rows.iter().map(row).collect::<Vec<_>>().join(", "))
    };
    let mut velocity = Vec::new();
    let origin = match class {
        Class::Linear(linear) => vec![("T1", matrix(linear.t1.rows())), ("T2", matrix(linear.t2.rows()))],
        Class::Mechanical(mechanical) => {
            let velocities = mechanical.q.iter().zip(&mechanical.velocities);
            velocity.extend(velocities.map(|(q, formula)| (arena.name(*q), arena.print(*formula))));
            vec![("H", arena.print(mechanical.energy))]
        }
        Class::Electromechanical(coils) => {
            let magnets: Vec<Vec<Expr>> = coils.magnets.iter().map(|e| vec![*e]).collect();
            vec![("L", matrix(coils.inductance.rows())), ("mu", matrix(&magnets))]
        }
    };
    let phi = plant.phi.iter().map(|f| arena.print(f.expr)).collect();
    Some(Expansion { class: class.name(), origin, rates: rates.collect(), phi, velocity })
}
