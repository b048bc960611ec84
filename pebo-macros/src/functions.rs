//! What was derived as functions of the author's own structs.

use pebo_gen::Derived;
use pebo_gen::analysis::Class;
use pebo_gen::emit::Scalar;
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};
use syn::ext::IdentExt as _;
use syn::{Fields, Item, ItemFn, ItemMod, ItemStruct, Visibility};

/// What the functions are written for.
pub(crate) struct Functions<'a> {
    pub(crate) derived: &'a Derived,
    pub(crate) module: &'a ItemMod,
    pub(crate) type_name: &'a Ident,
    pub(crate) scalar: Scalar,
}

impl Functions<'_> {
    /// `h`, `phi_0`, `phi_1` and `phi_left`, but for those that the module has already; and a use of the author's
    /// functions, which nothing but the macro may call.
    pub(crate) fn tokens(&self) -> TokenStream {
        let names = ["h", "phi_0", "phi_1", "phi_left"];
        let bodies = [self.h(), self.phi_0(), self.phi_1(), self.phi_left()];
        let added = names.into_iter().zip(bodies).filter(|(name, _)| self.function(name).is_none());
        let added: Vec<(&str, TokenStream)> = added.filter_map(|(name, body)| Some((name, body?))).collect();
        let own = ["f_x", "f_y", "g_y", "phi", "phi_left", "identities"]
            .into_iter()
            .filter(|name| self.function(name).is_some());
        let used = own.chain(added.iter().map(|(name, _)| *name)).map(|name| format_ident!("{name}"));
        let added = added.iter().map(|(_, body)| body);
        let conversions = self.conversions();
        quote! {
            #conversions
            #(#added)*
            const _: () = {
                #(let _ = #used;)*
            };
        }
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
            let scalar = self.scalar();
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

    fn h(&self) -> Option<TokenStream> {
        let (visibility, scalar, model) = (self.visibility(), self.scalar(), self.model());
        let (signals, values) = self.signals()?;
        Some(quote! {
            /// `h` of the cascade.
            #visibility fn h(#signals) -> [#scalar; NZ] {
                pebo_runtime::Model::h(&#model, #values).into()
            }
        })
    }

    fn phi_0(&self) -> Option<TokenStream> {
        let (visibility, scalar, model) = (self.visibility(), self.scalar(), self.model());
        let (signals, values) = self.signals()?;
        let (argument, extension) = self.extension();
        Some(quote! {
            /// What is known in the regression.
            #visibility fn phi_0(#argument, #signals) -> [#scalar; NR] {
                pebo_runtime::Model::phi_0(&#model, #extension, #values).into()
            }
        })
    }

    fn phi_1(&self) -> Option<TokenStream> {
        let (visibility, scalar, model) = (self.visibility(), self.scalar(), self.model());
        let (signals, values) = self.signals()?;
        let (argument, extension) = self.extension();
        Some(quote! {
            /// The factor of the unknown in the regression, by rows.
            #visibility fn phi_1(#argument, #signals) -> [[#scalar; NE]; NR] {
                pebo_runtime::Model::phi_1(&#model, #extension, #values).transpose().into()
            }
        })
    }

    /// The left inverse, if it is of all states.
    fn phi_left(&self) -> Option<TokenStream> {
        let (visibility, scalar, model) = (self.visibility(), self.scalar(), self.model());
        let entries = self.recovered()?;
        let outputs = self.vector("Y", &format_ident!("y"))?;
        Some(quote! {
            /// The left inverse: the states for which `phi(x, y) = z`.
            #visibility fn phi_left(z: [#scalar; NZ], y: &Y) -> X {
                let z = pebo_runtime::nalgebra::SVector::from(z);
                let x: [#scalar; NX] = pebo_runtime::Model::phi_left(&#model, &z, &#outputs).into();
                X { #entries }
            }
        })
    }

    /// The arguments `y` and `u`, and the vectors that they are.
    fn signals(&self) -> Option<(TokenStream, TokenStream)> {
        let outputs = self.vector("Y", &format_ident!("y"))?;
        Some(match self.structure("U") {
            Some(_) => {
                let inputs = self.vector("U", &format_ident!("u"))?;
                (quote!(y: &Y, u: &U), quote!(&#outputs, &#inputs))
            }
            None => (quote!(y: &Y), quote!(&#outputs, &pebo_runtime::nalgebra::SVector::zeros())),
        })
    }

    /// The argument for the dynamic extension, and the extension that it is.
    fn extension(&self) -> (TokenStream, TokenStream) {
        let scalar = self.scalar();
        match self.derived.derivation.class {
            Class::Pebo => {
                let start = quote!(pebo_runtime::nalgebra::SVector::from(chi));
                let new = quote!(<pebo_runtime::Integrator<#scalar, NZ> as pebo_runtime::Extension<#scalar, NZ>>::new);
                (quote!(chi: [#scalar; NZ]), quote!(&#new(#start)))
            }
            // Its state is a vector and a matrix, which only the runtime moves as they belong together.
            Class::Gpebo => (quote!(extension: &pebo_runtime::Fundamental<#scalar, NZ>), quote!(extension)),
        }
    }

    fn vector(&self, letter: &str, argument: &Ident) -> Option<TokenStream> {
        let fields = fields(self.structure(letter)?);
        Some(if fields.is_empty() {
            quote!(pebo_runtime::nalgebra::SVector::zeros())
        } else {
            quote!(pebo_runtime::nalgebra::SVector::from([#(#argument.#fields),*]))
        })
    }

    fn model(&self) -> TokenStream {
        let type_name = self.type_name;
        quote!(observer::#type_name::new(&observer::Parameters::default()))
    }

    fn scalar(&self) -> Ident {
        format_ident!("{}", self.scalar.name())
    }

    /// As visible as the author's transform.
    fn visibility(&self) -> &Visibility {
        self.function("phi").or_else(|| self.function("f_x")).map_or(&Visibility::Inherited, |item| &item.vis)
    }

    fn function(&self, name: &str) -> Option<&ItemFn> {
        self.items().find_map(|item| match item {
            Item::Fn(item) if item.sig.ident == name => Some(item),
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
