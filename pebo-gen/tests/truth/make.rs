//! Random models whose truth is known by construction.
//!
//! The transform is chosen first, `phi_i = a_i(y) g_i(x_i) + b_i(y)`, then its rate h(y, u) and the rates of the
//! outputs; the rates of the states follow from them. The truth of the model is that of its parts.

use super::draw::Draw;
use super::formula::{Comparison, Evaluation, Formula, Values};

/// The truth of a model.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Truth {
    /// Every claim holds: it must not be refuted.
    Holds,
    /// A claim fails: it must not be accepted.
    Fails,
    /// Not known by construction: an accepted model has to satisfy the judge.
    Open,
}

/// A model with its truth.
pub(crate) struct GeneratedModel {
    pub(crate) text: String,
    pub(crate) truth: Truth,
    pub(crate) kind: &'static str,
}

/// A function of one argument, written `@`: its text, its derivative, the conditions of both.
type Part = (&'static str, &'static str);

/// Functions that are never zero.
const NEVER_ZERO: &[Part] = &[
    ("2", "0"),
    ("(@^2 + 1)", "2*@"),
    ("exp(@)", "exp(@)"),
    ("cosh(@)", "sinh(@)"),
    ("(sin(@) + 2)", "cos(@)"),
    ("sqrt(@^2 + 1)", "@/sqrt(@^2 + 1)"),
    ("1/(@^2 + 1)", "(-2*@/(@^2 + 1)^2)"),
    ("(tanh(@) + 2)", "(1 - tanh(@)^2)"),
    ("(1 + @^4)", "4*@^3"),
    ("(@^2 - @ + 1)", "(2*@ - 1)"),
];

/// Functions that are zero somewhere.
const SOMEWHERE_ZERO: &[Part] = &[
    ("@", "1"),
    ("(@ - 1)", "1"),
    ("cos(@)", "(-sin(@))"),
    ("(@^2 - 1)", "2*@"),
    ("sin(@)", "cos(@)"),
    ("tanh(@)", "(1 - tanh(@)^2)"),
    ("(exp(@) - 1)", "exp(@)"),
    ("atan(@)", "1/(@^2 + 1)"),
    ("(1 - abs(@)*@)", "(-2*abs(@))"),
    ("(max(@, 0)^2 - 1)", "2*max(@, 0)"),
];

/// Functions that a transform may add.
const ADDED: &[Part] = &[
    ("0", "0"),
    ("@^2", "2*@"),
    ("sin(@)", "cos(@)"),
    ("abs(@)*@", "2*abs(@)"),
    ("log(@^2 + 1)", "2*@/(@^2 + 1)"),
    ("(-@)^3", "(-3*@^2)"),
    ("sqrt(@^2)*@", "2*sqrt(@^2)"),
    ("tanh(2*@)", "2*(1 - tanh(2*@)^2)"),
    ("min(@, 1)^3", "(3*min(@, 1)^2*(1 + sign(1 - @))/2)"),
    ("@/(1 + @^2)", "(1 - @^2)/(1 + @^2)^2"),
];

/// One-to-one functions of a state with their derivatives, and their assumptions on it.
const ONE_TO_ONE: &[(&str, &str, &str)] = &[
    ("@", "1", ""),
    ("@", "1", "@ > -2"),
    ("2*@", "2", ""),
    ("exp(@)", "exp(@)", ""),
    ("atan(@)", "1/(@^2 + 1)", ""),
    ("sinh(@)", "cosh(@)", ""),
    ("log(@)", "1/@", "@ > 0"),
    ("@^2", "2*@", "@ > 0"),
    ("@^2", "2*@", "@ > 0.5"),
    ("@^3", "3*@^2", "@ > 0"),
    ("sqrt(@)", "1/(2*sqrt(@))", "@ > 0"),
    ("1/@", "(-1/@^2)", "@ > 0"),
    ("sin(@)", "cos(@)", "-1 < @ < 1"),
    ("cos(@)", "(-sin(@))", "0.1 < @ < 3"),
    ("@^2", "2*@", "@ < 0"),
    ("tan(@)", "(1 + tan(@)^2)", "-1 < @ < 1"),
];

/// Functions of a state that are not injective under their assumptions.
const NOT_ONE_TO_ONE: &[(&str, &str, &str)] = &[
    ("@^2", "2*@", "@ != 0"),
    ("@^2", "2*@", "-1 < @ < 2"),
    ("cos(@)", "(-sin(@))", "-0.1 < @ < 3"),
    ("sin(@)", "cos(@)", "-2 < @ < 2"),
    ("@^4", "4*@^3", "@ != 0"),
    ("cosh(@)", "sinh(@)", "@ != 0"),
    ("(@^3 - @)", "(3*@^2 - 1)", "-2 < @ < 2"),
    ("exp(@^2)", "2*@*exp(@^2)", "@ != 0"),
    ("abs(@)", "(@/abs(@))", "@ != 0"),
    ("(@ - 1)^2", "2*(@ - 1)", "@ > 0"),
];

/// Terms in a state that vanish on part of its values only, or are small: easily missed.
const SUBTLE: &[&str] = &[
    "1e-6*@^2*sin(@)",
    "(abs(@) + @)*@^2",
    "(abs(@ - 3) + @ - 3)*@^2",
    "(sqrt(@^2) - @)*sin(@)",
    "(sin(@)^2 + cos(@)^2 - 1 + 1e-3*@^3)",
    "(@ - 1)*(@ - 2)*@*(@ + 1)*@^2*exp(-@)",
    "(exp(2*@) - exp(@)^2 + tanh(@)/50)",
    "(atan(@) + atan(1/@) - pi/2)",
    "(log(@^2) - 2*log(abs(@)) + @^5/1000)",
    "sin(@)*q1",
];

/// Known rates of a transform, in the outputs and the input.
const KNOWN: &[&str] = &[
    "u",
    "u - q1",
    "sin(q1)*u",
    "exp(-q1^2)",
    "u*q1/(q1^2 + 1)",
    "1",
    "0",
    "cos(q1)^2 + u^2",
    "abs(q1) + u",
    "tanh(5*u)",
    "sat(3*u) - max(q1, u)",
    "b*sign(u)",
    "b*u - q1^3",
    "sqrt(b)*u",
];

fn at(function: &str, argument: &str) -> String {
    function.replace('@', &format!("({argument})"))
}

/// The model of a seed.
pub(crate) fn model(seed: u64) -> GeneratedModel {
    let mut draw = Draw::new(seed);
    let states = 1 + draw.below(3).min(draw.below(3));
    let kind = *draw.of(&[
        &"plain",
        &"plain",
        &"plain",
        &"singular",
        &"singular",
        &"subtle",
        &"subtle",
        &"not one-to-one",
        &"functions of theta",
        &"nonlinear",
        &"monotone",
        &"never",
        &"identity",
        &"generalised",
        &"unmeasured signal",
        &"excitation",
    ]);
    let truth = if kind == "not one-to-one" { Truth::Fails } else { Truth::Holds };
    let hidden = draw.below(states);
    let mut recipe =
        Recipe { draw, kind, states, hidden, truth, assume: Vec::new(), parts: Vec::new(), outputs: Vec::new() };
    recipe.transform();
    recipe.outputs();
    let rates = recipe.rates();
    recipe.written(&rates)
}

/// One component of the transform, `a(m) g(x) + b(n)`.
struct Component {
    x: String,
    g: &'static str,
    slope: &'static str,
    factor: Part,
    of: String,
    added: Part,
    over: String,
    text: String,
}

/// A model in the making; `hidden` is the component that its kind is about.
struct Recipe {
    draw: Draw,
    kind: &'static str,
    states: usize,
    hidden: usize,
    truth: Truth,
    assume: Vec<String>,
    parts: Vec<Component>,
    outputs: Vec<String>,
}

/// The output in which a transform is singular.
const BLIND: &str = "m";

impl Recipe {
    fn output(&mut self) -> String {
        format!("q{}", 1 + self.draw.below(self.states))
    }

    fn pick<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.draw.below(choices.len())]
    }

    fn transform(&mut self) {
        // With rates in functions of theta the state itself is taken: its functions are those of the table.
        let plain = matches!(self.kind, "functions of theta" | "generalised" | "nonlinear" | "monotone");
        for i in 0..self.states {
            let x = format!("x{}", i + 1);
            let (g, slope, domain) = match self.kind {
                "not one-to-one" if i == self.hidden => self.pick(NOT_ONE_TO_ONE),
                _ if plain => ONE_TO_ONE[0],
                _ => self.pick(ONE_TO_ONE),
            };
            if !domain.is_empty() {
                self.assume.push(domain.replace('@', &x));
            }
            let singular = self.kind == "singular" && i == self.hidden;
            let factor = if plain {
                ("1", "0")
            } else if singular {
                self.pick(SOMEWHERE_ZERO)
            } else {
                self.pick(NEVER_ZERO)
            };
            let of = if singular { BLIND.to_owned() } else { self.output() };
            let over = self.output();
            let added = if self.draw.one_in(2) || plain || singular { ADDED[0] } else { self.pick(ADDED) };
            let text = format!("{}*{} + {}", at(factor.0, &of), at(g, &x), at(added.0, &over));
            self.parts.push(Component { x, g, slope, factor, of, added, over, text });
        }
    }

    /// `y_i' = A_i + B_i phi_i`, and perhaps a multiple of the component before it.
    fn outputs(&mut self) {
        for i in 0..self.states {
            let known = self.pick(KNOWN);
            let (factor, of) = (self.pick(NEVER_ZERO).0, self.output());
            let mut rate = format!("{known} + {}*({})", at(factor, &of), self.parts[i].text);
            if i > 0
                && self.draw.one_in(2)
                && self.kind != "nonlinear"
                && self.kind != "monotone"
                && self.kind != "never"
            {
                let factor = at(self.pick(SOMEWHERE_ZERO).0, "u");
                rate = format!("{rate} - {factor}*({})", self.parts[i - 1].text);
            }
            if i == self.hidden {
                rate = self.special_output(known).unwrap_or(rate);
            }
            self.outputs.push(rate);
        }
        if self.kind == "unmeasured signal" {
            // One more output that nothing can be learnt from.
            self.outputs.push("d".to_owned());
        }
    }

    /// The rate of the output that the kind is about.
    fn special_output(&mut self, known: &str) -> Option<String> {
        let own = self.parts[self.hidden].text.clone();
        let other = (self.states > 1).then(|| self.parts[(self.hidden + 1) % self.states].text.clone());
        let within = |function: &str| format!("{known} + {}", function.replace('@', &own));
        match (self.kind, other) {
            ("functions of theta", _) => {
                let functions = ["(@)^2", "exp(@)", "(@)*sin(u) + (@)^3", "sin(@) + (@)", "sinh(@)"];
                Some(within(self.pick(&functions)))
            }
            ("nonlinear", _) => {
                self.truth = Truth::Fails;
                let functions =
                    ["1/(1 + (@)^2)", "exp(-(@)^2)", "tanh(@)", "atan(@)", "log(1 + (@)^2)", "abs(@)", "sat(@)"];
                Some(within(self.pick(&functions)))
            }
            ("monotone", _) => {
                let functions = ["tanh(@)", "atan(@)", "(@) + log(1 + (@)^2)/2", "(u^2 + 1)*atan(@)", "sin(u)*tanh(@)"];
                Some(within(self.pick(&functions)))
            }
            // The component is in no output at all.
            ("never", other) => {
                self.truth = Truth::Fails;
                Some(other.map_or_else(|| known.to_owned(), |other| format!("{known} + ({other})")))
            }
            ("excitation", Some(other)) => Some(format!("{known} + sin(u)*({own}) + ({other})")),
            _ => None,
        }
    }

    /// The rates of the states that give the transform its own; last that of the output in which it is singular.
    fn rates(&mut self) -> Vec<String> {
        // If the factor vanishes in that output, it is kept: there the plant is regular, and the transform blind.
        let stays = self.pick(KNOWN);
        let mut rates = Vec::new();
        for i in 0..self.states {
            let known = self.known_rate(i);
            let Component { g, slope, factor, x, of, added, over, .. } = &self.parts[i];
            let (g, slope) = (at(g, x), at(slope, x));
            if of == BLIND {
                // z' = a (g' x' + a' s g) with m' = a s: regular wherever a vanishes.
                rates.push(format!("({known} - {}*({stays})*{g})/({slope})", at(factor.1, of)));
                continue;
            }
            let rate_of = |name: &str| &self.outputs[name[1..].parse::<usize>().expect("an output") - 1];
            let (of_rate, over_rate) = (rate_of(of), rate_of(over));
            let drift = format!("{}*{g}*({of_rate}) + {}*({over_rate})", at(factor.1, of), at(added.1, over));
            rates.push(format!("({known} - ({drift}))/({}*{slope})", at(factor.0, of)));
        }
        let blind = self.parts.iter().find(|part| part.of == BLIND);
        rates.extend(blind.map(|part| format!("{}*({stays})", at(part.factor.0, BLIND))));
        rates
    }

    /// The rate of a component of the transform, or the term that the kind adds to it.
    fn known_rate(&mut self, i: usize) -> String {
        let (known, x) = (self.pick(KNOWN), self.parts[i].x.clone());
        match self.kind {
            "subtle" if i == self.hidden => {
                let term = self.pick(SUBTLE).replace('@', &x);
                let domain = self.assume.iter().filter(|text| Comparison::read(text).names().contains(&x));
                let (domain, g) = (domain.map(String::as_str).collect::<Vec<_>>(), at(self.parts[i].g, &x));
                // A term affine in the transform is part of a generalised cascade.
                let affine = affine_in(&term, &g, &x, &domain);
                if !vanishes(&term, &x, &domain) {
                    self.truth = if affine { Truth::Open } else { Truth::Fails };
                }
                format!("{known} + {term}")
            }
            "identity" => format!("{known} + (c^2 + s^2 - 1)*{}", self.pick(SUBTLE).replace('@', &x)),
            "generalised" => format!("{known} + {}*{x}", self.pick(&["-1", "-(1 + q1^2)", "-u^2", "-b^2", "0"])),
            _ => known.to_owned(),
        }
    }

    fn written(mut self, rates: &[String]) -> GeneratedModel {
        let x: Vec<String> = self.parts.iter().map(|part| part.x.clone()).collect();
        let mut y: Vec<(String, String)> =
            (1..).zip(&self.outputs).map(|(i, rate)| (format!("q{i}"), rate.clone())).collect();
        y.extend(rates.get(self.states).map(|rate| (BLIND.to_owned(), rate.clone())));
        let mut more = String::new();
        if self.kind == "identity" {
            y.extend([("c", "-s*u"), ("s", "c*u")].map(|(name, rate)| (name.to_owned(), rate.to_owned())));
            more += "identities: [c^2 + s^2 - 1]\n";
        }
        if self.kind == "unmeasured signal" {
            more += "w: [d]\n";
        }
        if self.kind == "monotone" {
            more += "regression: monotone\n";
        }
        if !self.assume.is_empty() {
            more = format!("{more}assume: [{}]\n", self.assume.join(", "));
        }
        let f_x: Vec<String> = x.iter().zip(rates).map(|(name, rate)| format!("  {name}: {rate}")).collect();
        let f_y: Vec<String> = y.iter().map(|(name, rate)| format!("  {name}: {rate}")).collect();
        let outputs: Vec<&str> = y.iter().map(|(name, _)| name.as_str()).collect();
        let phi: Vec<String> = self.parts.iter().map(|part| format!("  - {}", part.text)).collect();
        let text = format!(
            "model: m\nparameters: {{b: {}}}\nx: [{}]\ny: [{}]\nu: [u]\n{more}f_x:\n{}\nf_y:\n{}\nphi:\n{}\n",
            self.pick(&["2", "0.5", "7", "1e-3"]),
            x.join(", "),
            outputs.join(", "),
            f_x.join("\n"),
            f_y.join("\n"),
            phi.join("\n"),
        );
        GeneratedModel { text, truth: self.truth, kind: self.kind }
    }
}

/// Values of formulas in a state where the assumptions on the state hold and all formulas have a value.
fn sampled<const N: usize>(formulas: [&str; N], x: &str, domain: &[&str]) -> Vec<[Evaluation; N]> {
    let formulas = formulas.map(Formula::read);
    let at = |step: i32| {
        let value = f64::from(step) * 0.01 + 0.003;
        let values: Values = [(x, value), ("q1", 1.37)].map(|(name, value)| (name.to_owned(), (value, 0.0))).into();
        let inside = domain.iter().all(|text| Comparison::read(text).holds(&values));
        let found: [Evaluation; N] = std::array::from_fn(|i| formulas[i].at(&values));
        (inside && found.iter().all(|found| found.value.is_finite())).then_some(found)
    };
    (-400..400).filter_map(at).collect()
}

/// A term in a state is zero under all assumptions on the state, as far as many points tell.
fn vanishes(term: &str, x: &str, domain: &[&str]) -> bool {
    sampled([term], x, domain).iter().all(|[found]| found.value.abs() <= 1e-13 * found.size.max(1.0))
}

/// A term is an affine function of another there: all points lie on one line, up to rounding.
fn affine_in(term: &str, other: &str, x: &str, domain: &[&str]) -> bool {
    let points = sampled([term, other], x, domain);
    let (Some([t, g]), Some([u, k])) = (points.first(), points.last()) else { return false };
    points.iter().all(|[v, m]| {
        let area = (v.value - t.value) * (k.value - g.value) - (u.value - t.value) * (m.value - g.value);
        area.abs() <= 1e-12 * (v.size + u.size + t.size) * (m.size + k.size + g.size)
    })
}
