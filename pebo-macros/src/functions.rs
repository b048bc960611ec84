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
        quote! {
            #(#added)*
            const _: () = {
                #(let _ = #used;)*
            };
        }
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
        let recovered = &self.derived.derivation.left_inverse.result.as_ref()?.x;
        let arena = &self.derived.plant.arena;
        let names: Vec<String> = recovered.iter().map(|(state, _)| arena.name(*state)).collect();
        let fields = fields(self.structure("X")?);
        let places: Option<Vec<usize>> =
            fields.iter().map(|field| names.iter().position(|name| field.unraw() == name)).collect();
        let places = places?;
        let outputs = self.vector("Y", &format_ident!("y"))?;
        Some(quote! {
            /// The left inverse: the states for which `phi(x, y) = z`.
            #visibility fn phi_left(z: [#scalar; NZ], y: &Y) -> X {
                let z = pebo_runtime::nalgebra::SVector::from(z);
                let x: [#scalar; NX] = pebo_runtime::Model::phi_left(&#model, &z, &#outputs).into();
                X { #(#fields: x[#places]),* }
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
        self.function("phi").map_or(&Visibility::Inherited, |item| &item.vis)
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
