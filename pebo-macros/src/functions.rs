//! What was derived as functions of the author's own structs.

use pebo_gen::Derived;
use pebo_gen::analysis::Class;
use pebo_gen::emit::Scalar;
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};
use syn::ext::IdentExt as _;
use syn::{Fields, Item, ItemMod, ItemStruct, Visibility};

/// What the functions are written for.
pub(crate) struct Functions<'a> {
    pub(crate) derived: &'a Derived,
    pub(crate) module: &'a ItemMod,
    pub(crate) type_name: &'a Ident,
    pub(crate) scalar: Scalar,
}

impl Functions<'_> {
    /// `h`, `phi_0`, `phi_1` and `phi_left`, but for names that the module has already; and a use of the author's
    /// functions, which nothing but the macro may call.
    pub(crate) fn tokens(&self) -> TokenStream {
        let added = self.paper().into_iter().filter(|(name, _)| self.visibility_of(name).is_none());
        let (names, added): (Vec<&str>, Vec<TokenStream>) = added.unzip();
        let own = ["f_x", "f_y", "g_y", "phi", "phi_left", "identities"]
            .into_iter()
            .filter(|name| self.visibility_of(name).is_some());
        let used = own.chain(names).map(|name| format_ident!("{name}"));
        let conversions = self.conversions();
        quote! {
            #conversions
            #(#added)*
            const _: () = {
                #(let _ = #used;)*
            };
        }
    }

    /// The emitted functions for the author's structs. The left inverse is there if it is of all states.
    fn paper(&self) -> Vec<(&'static str, TokenStream)> {
        if self.structure("Y").is_none() {
            return Vec::new();
        }
        let (type_name, visibility) = (self.type_name, self.visibility());
        let scalar = format_ident!("{}", self.scalar.name());
        let model = quote!(observer::#type_name::new(&observer::Parameters::default()));
        let (signals, inputs) = match self.structure("U") {
            Some(_) => (quote!(y: &Y, u: &U), quote!(u.into())),
            None => (quote!(y: &Y), quote!(observer::U)),
        };
        let (start, extension) = match self.derived.derivation.class {
            Class::Pebo => (quote!(chi), quote!([#scalar; NZ])),
            // Its state is a vector and a matrix, which only the runtime moves as they belong together.
            Class::Gpebo => (quote!(extension), quote!(&pebo_runtime::Fundamental<#scalar, NZ>)),
        };
        let h = quote! {
            /// `h` of the cascade.
            #visibility fn h(#signals) -> [#scalar; NZ] { #model.h(y.into(), #inputs) }
        };
        let phi_0 = quote! {
            /// What is known in the regression.
            #visibility fn phi_0(#start: #extension, #signals) -> [#scalar; NR] {
                #model.phi_0(#start, y.into(), #inputs)
            }
        };
        let phi_1 = quote! {
            /// The factor of the unknown in the regression, by rows.
            #visibility fn phi_1(#start: #extension, #signals) -> [[#scalar; NE]; NR] {
                #model.phi_1(#start, y.into(), #inputs)
            }
        };
        let phi_left = self.recovered().map(|_| {
            quote! {
                /// The left inverse: the states for which `phi(x, y) = z`.
                #visibility fn phi_left(z: [#scalar; NZ], y: &Y) -> X { #model.phi_left(z, y.into()).into() }
            }
        });
        let always = [("h", h), ("phi_0", phi_0), ("phi_1", phi_1)];
        always.into_iter().chain(phi_left.map(|phi_left| ("phi_left", phi_left))).collect()
    }

    /// From the author's samples to the observer's, and from its estimates to the author's. The structures themselves
    /// may be less visible than the model.
    fn conversions(&self) -> TokenStream {
        let samples = ["Y", "U"].into_iter().filter_map(|letter| {
            let (structure, argument) = (format_ident!("{letter}"), format_ident!("{}", letter.to_lowercase()));
            let vector = self.vector(letter, &argument)?;
            Some(quote! {
                impl From<&#structure> for observer::#structure {
                    fn from(#argument: &#structure) -> Self { #vector.into() }
                }
                impl From<#structure> for observer::#structure {
                    fn from(#argument: #structure) -> Self { Self::from(&#argument) }
                }
            })
        });
        let samples: TokenStream = samples.collect();
        let estimate = self.recovered().map(|entries| {
            let scalar = format_ident!("{}", self.scalar.name());
            quote! {
                impl From<observer::X> for X {
                    fn from(x: observer::X) -> Self {
                        let x: [#scalar; NX] = pebo_runtime::nalgebra::SVector::from(x).into();
                        X { #entries }
                    }
                }
            }
        });
        quote!(#samples #estimate)
    }

    /// The fields of the author's states, from the array `x` of those recovered; none unless all are.
    fn recovered(&self) -> Option<TokenStream> {
        let recovered = &self.derived.derivation.left_inverse.result.as_ref()?.x;
        let arena = &self.derived.plant.arena;
        let names: Vec<String> = recovered.iter().map(|(state, _)| arena.name(*state)).collect();
        let fields = fields(self.structure("X")?);
        let place = |field: &&Ident| names.iter().position(|name| field.unraw() == name);
        let places: Vec<usize> = fields.iter().map(place).collect::<Option<_>>()?;
        Some(quote!(#(#fields: x[#places]),*))
    }

    fn vector(&self, letter: &str, argument: &Ident) -> Option<TokenStream> {
        let fields = fields(self.structure(letter)?);
        Some(if fields.is_empty() {
            quote!(pebo_runtime::nalgebra::SVector::zeros())
        } else {
            quote!(pebo_runtime::nalgebra::SVector::from([#(#argument.#fields),*]))
        })
    }

    /// As visible as the author's transform.
    fn visibility(&self) -> &Visibility {
        self.visibility_of("phi").or_else(|| self.visibility_of("f_x")).unwrap_or(&Visibility::Inherited)
    }

    /// Of the function or constant of this name, if there is one.
    fn visibility_of(&self, name: &str) -> Option<&Visibility> {
        self.items().find_map(|item| match item {
            Item::Fn(item) if item.sig.ident == name => Some(&item.vis),
            Item::Const(item) if item.ident == name => Some(&item.vis),
            _ => None,
        })
    }

    fn structure(&self, name: &str) -> Option<&ItemStruct> {
        self.items().find_map(|item| match item {
            Item::Struct(item) if item.ident == name => Some(item),
            _ => None,
        })
    }

    fn items(&self) -> impl Iterator<Item = &Item> {
        self.module.content.iter().flat_map(|(_, items)| items)
    }
}

fn fields(item: &ItemStruct) -> Vec<&Ident> {
    match &item.fields {
        Fields::Named(fields) => fields.named.iter().filter_map(|field| field.ident.as_ref()).collect(),
        _ => Vec::new(),
    }
}
