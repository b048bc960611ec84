//! `#[pebo_model]`: an observer at compile time, from a plant in plain Rust or from a model file.
//!
//! The crate that uses the attribute depends on `pebo-runtime` as well, which the written code calls. A claim that is
//! not proved is a compile error at the formula that is to blame, with the generator's diagnostics.
//!
//! Model files need the feature `files`, which is a default one. Without it there is less to compile.

#[cfg(feature = "files")]
mod file;
mod functions;
mod plain;
mod refusal;

use proc_macro2::TokenStream;
use syn::{Error, Item, LitStr};

/// Writes the observer of a model.
///
/// On a module of plain Rust, the module is the model. `X`, `Y`, `U` and `W` are structs whose fields are the
/// unmeasured states, the measured outputs, the inputs, and unmeasured signals that are not estimated; `f_x` and `f_y`
/// are their rates, `phi` is the candidate transform, and constants are the parameters. `g_y`, `phi_left` and `identities`
/// may be given likewise. All of them stay as they are, and can be called; the module gets besides them
///
/// - the module `observer`, which `pebo-gen` would emit for the model, and its items: the model's type, named like
///   the module in camel case, `Parameters`, `Observer` and the sizes;
/// - `h`, `phi_0`, `phi_1` and `phi_left` as functions of the module's structs, but for names that it has already;
/// - conversions by which `Observer::step` takes the module's `Y` and `U` as they are, and its estimate becomes an `X`.
///
/// ```
/// #[pebo_macros::pebo_model(assume(M > 0, L > 0))]
/// pub mod pendulum {
///     const M: f64 = 1.0;
///     const L: f64 = 0.5;
///     const G: f64 = 9.81;
///
///     pub struct X { pub p: f64 }
///     pub struct Y { pub q: f64 }
///     pub struct U { pub tau: f64 }
///
///     pub fn f_x(y: &Y, u: &U) -> X {
///         X { p: u.tau - M * G * L * y.q.sin() }
///     }
///     pub fn f_y(x: &X) -> Y {
///         Y { q: x.p / (M * L.powi(2)) }
///     }
///     pub fn phi(x: &X) -> [f64; 1] {
///         [x.p]
///     }
/// }
///
/// let [rate] = pendulum::h(&pendulum::Y { q: 0.0 }, &pendulum::U { tau: 2.0 });
/// assert_eq!(rate, 2.0);
/// ```
///
/// The attribute takes `title = ".."` (else the module's documentation is the title), `reference = ".."`,
/// `class = "pebo"` or `class = "gpebo"` (else either will do), `assume(L > 0, 0 < d < 1)`,
/// `angles(q = 2.0 * PI)` and `units(L = "H", i = "A")`.
///
/// With the path of a model file, relative to the crate's own folder, it stands on a unit struct, which becomes the
/// model's type beside a module of the same name in snake case, or on an empty module, which it fills. The crate is
/// built again when the file changes. `scalar = f32` writes for single precision.
///
/// ```text
/// #[pebo_macros::pebo_model("models/cuk.yaml")]
/// pub struct Cuk;
/// ```
#[proc_macro_attribute]
pub fn pebo_model(arguments: proc_macro::TokenStream, item: proc_macro::TokenStream) -> proc_macro::TokenStream {
    expand(arguments.into(), item.into()).unwrap_or_else(Error::into_compile_error).into()
}

fn expand(arguments: TokenStream, item: TokenStream) -> Result<TokenStream, Error> {
    let path = arguments.clone().into_iter().next().and_then(|first| syn::parse2::<LitStr>(first.into()).ok());
    match (syn::parse2(item)?, path) {
        (Item::Mod(module), None) => Ok(plain::module(arguments, &module)),
        #[cfg(feature = "files")]
        (Item::Mod(module), Some(_)) => file::module(arguments, module),
        #[cfg(feature = "files")]
        (Item::Struct(item), _) => file::structure(arguments, &item),
        #[cfg(not(feature = "files"))]
        (_, Some(path)) => Err(Error::new(
            path.span(),
            "pebo-macros was built without the feature `files`, which reads model files\n\
             help: remove `default-features = false` from the dependency, or add `features = [\"files\"]`",
        )),
        (other, _) => Err(Error::new_spanned(
            other,
            "this attribute needs a module of plain Rust, or the path of a model file and a unit struct\n\
             help: write `pub mod plant { .. }`, or #[pebo_model(\"models/plant.yaml\")] `pub struct Plant;`",
        )),
    }
}

/// The package's front page, of which the example is a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod front_page {}
