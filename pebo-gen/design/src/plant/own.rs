//! The generator's own symbols: coordinates, extension, unknowns.
//!
//! They differ from the author's, whatever these are called, and each family is printed so that no two symbols of a
//! plant look alike: `z1`, `chi1`, `theta1`, `xi1` and `Psi11` are names that no model may declare, and `eta1` gives
//! way to a declared name.

use crate::model::Model;
use pebo_cas::{Arena, Symbol};

/// The largest index for which two in a row are distinct without a mark between them.
const LARGEST_DIGIT: usize = 9;

/// The symbols that a transform of so many components brings with it.
pub(super) struct Own {
    pub(super) z: Vec<Symbol>,
    pub(super) chi: Vec<Symbol>,
    pub(super) theta: Vec<Symbol>,
    pub(super) xi: Vec<Symbol>,
    pub(super) psi: Vec<Vec<Symbol>>,
}

impl Own {
    pub(super) fn of(arena: &Arena, components: usize) -> Self {
        // Entered as expressions at once, so that results print them in this order, behind the plant's.
        let own = |name: String| {
            let symbol = arena.generated(&name);
            arena.of_symbol(symbol);
            symbol
        };
        let indexed = |letter: &str| (1..=components).map(|i| own(format!("{letter}{i}"))).collect();
        let between = if components <= LARGEST_DIGIT { "" } else { "_" };
        let row = |row: usize| (1..=components).map(|column| own(format!("Psi{row}{between}{column}"))).collect();
        Self {
            z: indexed("z"),
            chi: indexed("chi"),
            theta: indexed("theta"),
            xi: indexed("xi"),
            psi: (1..=components).map(row).collect(),
        }
    }
}

/// The name of a regression's unknowns without their number: `eta`, or `eta_` in a model with a name as `eta1`.
pub(super) fn letter_of_unknowns(model: &Model) -> String {
    let simulation = model.simulation.iter();
    let outside = simulation.flat_map(|s| s.signals.iter().map(|e| &e.name).chain(s.define.iter().map(|e| &e.name)));
    let names: Vec<&str> = model.names().chain(outside).map(|name| name.value.as_str()).collect();
    let mut letter = "eta".to_owned();
    let numbered = |name: &str, letter: &str| {
        name.strip_prefix(letter).is_some_and(|rest| !rest.is_empty() && rest.bytes().all(|b| b.is_ascii_digit()))
    };
    while names.iter().any(|name| numbered(name, &letter)) {
        letter.push('_');
    }
    letter
}

#[cfg(all(test, feature = "yaml"))]
mod tests {
    use std::collections::BTreeSet;

    use crate::model::Model;
    use crate::plant::Plant;
    use crate::source::Source;
    use pebo_cas::Symbol;

    /// A plant with so many states, each declared with these names besides.
    fn plant(components: usize, parameters: &str) -> Plant {
        let list = |entry: &dyn Fn(usize) -> String| (1..=components).map(entry).collect::<Vec<_>>().join(", ");
        let x = list(&|i| format!("p{i}"));
        let text = format!(
            "model: m\nparameters: [{parameters}]\nx: [{x}]\ny: [q]\nf_x: {{{}}}\nphi: [{x}]\n",
            list(&|i| format!("p{i}: -p{i}")),
        );
        Plant::resolve(&Model::parse(&Source::new("m", text.as_str()).unwrap()).unwrap()).unwrap()
    }

    #[test]
    fn no_two_symbols_of_a_plant_are_one_or_look_alike() {
        // 11 components: Psi[1,11] and Psi[11,1] are two.
        for (components, parameters, eta) in [
            (2, "a", "eta1"),
            (11, "a", "eta1"),
            (3, "eta1", "eta_1"),
            (3, "eta7, eta_2", "eta__1"),
            (3, "eta, chi, z, theta, xi, Psi, eta1a", "eta1"),
        ] {
            let plant = plant(components, parameters);
            let declared = plant.parameters.iter().map(|p| p.symbol).chain(plant.x.iter().map(|s| s.symbol));
            let declared: Vec<Symbol> = declared.chain(plant.y.iter().map(|o| o.symbol)).collect();
            let families = [&plant.z, &plant.chi, &plant.theta, &plant.xi, &plant.eta(components)];
            let generated = families.into_iter().flatten().chain(plant.psi.iter().flatten()).copied();
            let all: Vec<Symbol> = declared.into_iter().chain(generated).collect();
            let distinct: BTreeSet<Symbol> = all.iter().copied().collect();
            let printed: BTreeSet<String> = all.iter().map(|symbol| plant.arena.name(*symbol)).collect();
            assert_eq!((distinct.len(), printed.len()), (all.len(), all.len()), "{components}, {parameters}");
            assert_eq!(plant.arena.name(plant.eta(1)[0]), eta, "{parameters}");
        }
    }

    #[test]
    fn entries_of_the_fundamental_matrix_have_a_mark_beyond_nine() {
        let printed = |plant: &Plant, row: usize, column: usize| plant.arena.name(plant.psi[row - 1][column - 1]);
        let nine = plant(9, "a");
        assert_eq!((printed(&nine, 1, 9), printed(&nine, 9, 1)), ("Psi19".to_owned(), "Psi91".to_owned()));
        let eleven = plant(11, "a");
        assert_eq!((printed(&eleven, 1, 11), printed(&eleven, 11, 1)), ("Psi1_11".to_owned(), "Psi11_1".to_owned()));
    }
}
