//! The plant that a class expands to: its equations, and the matrices or energy of the class.

use pebo_cas::{Expr, Symbol};
use pebo_design::plant::class::InVelocities;
use pebo_design::plant::{Class, Output, Plant, TransformOrigin};

/// The expansion of a class, as formulas.
pub(super) struct Expansion {
    /// The key of the class.
    pub(super) class: &'static str,
    /// The origin of the equations, by name: an energy, the matrices of a transform.
    pub(super) origin: Vec<(&'static str, String)>,
    /// States and outputs with their rates.
    pub(super) rates: Vec<(String, String)>,
    /// The components of the transform.
    pub(super) phi: Vec<String>,
    /// Positions with their momenta, which are the states of a mechanical plant.
    pub(super) momentum: Vec<(String, String)>,
    /// Positions with their velocities in z, for a mechanical plant.
    pub(super) velocity: Vec<(String, String)>,
}

/// The expansion of a plant that was written by class.
pub(super) fn of(plant: &Plant) -> Option<Expansion> {
    let class = plant.class.as_ref()?;
    let arena = &plant.arena;
    let states = plant.x.iter().map(|s| (s.symbol, s.rate.expr));
    let outputs = plant.y.iter().filter_map(|o| Some((o.symbol, o.rate?.expr)));
    let is_shown = !matches!(class, Class::Mechanical(mechanical) if mechanical.in_velocities.is_some());
    let written = states.chain(outputs).filter(|_| is_shown);
    let mut rates: Vec<(String, String)> =
        written.map(|(symbol, rate)| (arena.name(symbol), arena.print(rate))).collect();
    let matrix = |rows: &[Vec<Expr>]| {
        let row = |row: &Vec<Expr>| format!("[{}]", row.iter().map(|e| arena.print(*e)).collect::<Vec<_>>().join(", "));
        format!("[{}]", rows.iter().map(row).collect::<Vec<_>>().join(", "))
    };
    let (mut momentum, mut velocity) = (Vec::new(), Vec::new());
    if let Class::Mechanical(mechanical) = class {
        let momenta = mechanical.q.iter().zip(&plant.x);
        momentum.extend(momenta.map(|(q, state)| (arena.name(*q), arena.name(state.symbol))));
    }
    // The velocities belong to the author's T: the class knows none for another one.
    let is_own = plant.origin != TransformOrigin::Found;
    let origin = match class {
        Class::Linear(linear) => vec![("T1", matrix(linear.t1.rows())), ("T2", matrix(linear.t2.rows()))],
        Class::Mechanical(mechanical) => match &mechanical.in_velocities {
            None => {
                let velocities = mechanical.q.iter().zip(&mechanical.velocities).filter(|_| is_own);
                velocity.extend(velocities.map(|(q, formula)| (arena.name(*q), arena.print(*formula))));
                vec![("H", arena.print(mechanical.energy))]
            }
            Some(shown) => {
                rates = in_velocities(plant, shown);
                let row = |(index, q): (usize, &Symbol)| (arena.name(*q), format!("row {} of (T' M)^-1 z", index + 1));
                velocity.extend(mechanical.q.iter().enumerate().filter(|_| is_own).map(row));
                vec![("H", arena.print(shown.energy))]
            }
        },
        Class::Electromechanical(coils) => {
            let magnets: Vec<Vec<Expr>> = coils.magnets.iter().map(|e| vec![*e]).collect();
            vec![("L", matrix(coils.inductance.rows())), ("mu", matrix(&magnets))]
        }
    };
    let phi = plant.phi.iter().map(|f| arena.print(f.expr)).collect();
    Some(Expansion { class: class.name(), origin, rates, phi, momentum, velocity })
}

/// The rates of a mechanical plant whose inverse of M is too long to read.
fn in_velocities(plant: &Plant, shown: &InVelocities) -> Vec<(String, String)> {
    let arena = &plant.arena;
    let momenta = plant.x.iter().zip(&shown.rates).map(|(state, rate)| (arena.name(state.symbol), arena.print(*rate)));
    let row = |(index, output): (usize, &Output)| (arena.name(output.symbol), format!("row {} of M^-1 p", index + 1));
    momenta.chain(plant.y.iter().enumerate().map(row)).collect()
}
