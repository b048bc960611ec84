//! Plants from the literature that were written down after the search was: the known truth of each, which the search
//! finds.

use pebo_gen::analysis::{AtEstimate, Class};
use pebo_gen::search::{BoundClass, Search, SearchVerdict};

use super::{search, written};

/// The truth of a plant.
enum Truth {
    /// It has a transform with a plain cascade, which is to be found.
    Pebo,
    /// It has one with a generalised cascade, which is to be found. With a plain one there is none that is smooth, or
    /// of a plant without inputs none that is affine in x; or the outputs are not affine in it.
    Gpebo,
    /// It has one with a generalised cascade, which is to be found; whether it has a plain one is not known.
    Found,
    /// No smooth transform with a plain cascade recovers its states, and none affine in x with a generalised one.
    None,
    /// It has one in which the outputs are monotone, which is to be found.
    Monotone,
}

struct Case {
    from: &'static str,
    lines: &'static str,
    truth: Truth,
}

const CASES: &[Case] = &[
    Case {
        from: "Chua's circuit with a cubic diode (Zhong 1994): the second voltage",
        lines: "parameters: [a, b, m0, m1]\nx: [v2]\ny: [v1, i]\nassume: [a > 0, b > 0]\n\
                f_x: {v2: v1 - v2 + i}\nf_y: {v1: a*(v2 - v1 - m0*v1 - m1*v1^3), i: -b*v2}",
        truth: Truth::Pebo,
    },
    Case {
        from: "Lorenz 1963 from its first state: T(y) Lambda changes with y, so that no T is constant along it",
        lines: "parameters: [s, r, b]\nx: [Y, Z]\ny: [X]\nassume: [s > 0]\n\
                f_x: {Y: X*(r - Z) - Y, Z: X*Y - b*Z}\nf_y: {X: s*(Y - X)}",
        truth: Truth::Gpebo,
    },
    Case {
        from: "Roessler 1976 from its first state",
        lines: "parameters: [a, b, c]\nx: [Y, Z]\ny: [X]\nf_x: {Y: X + a*Y, Z: b + Z*(X - c)}\nf_y: {X: -Y - Z}",
        truth: Truth::Gpebo,
    },
    Case {
        from: "TORA (Wan, Bernstein, Coppola 1996): the metric is flat, as that of every M of one angle and a slide",
        lines: "parameters: [M, c, J, k]\nx: [p1, p2]\ny: [s, th]\nu: [tau]\n\
                assume: [M > 0, c > 0, J > 0, c^2 < M*J]\n\
                mechanical: {M: [[M, c*cos(th)], [c*cos(th), J]], V: k*s^2/2, G: [[0], [1]]}",
        truth: Truth::Pebo,
    },
    Case {
        from: "ball and beam (Hauser, Sastry, Kokotovic 1992): one Killing field; p2^2 makes the rates affine",
        lines: "parameters: [m, J, g]\nx: [p1, p2]\ny: [r, th]\nu: [tau]\nassume: [m > 0, J > 0, g > 0]\n\
                mechanical: {M: [[m, 0], [0, J + m*r^2]], V: m*g*r*sin(th), G: [[0], [1]]}",
        truth: Truth::Gpebo,
    },
    Case {
        from: "acrobot (Spong 1995)",
        lines: "parameters: [c1, c2, c3, g1, g2]\nx: [p1, p2]\ny: [q1, q2]\nu: [tau]\n\
                assume: [c1 > 0, c2 > 0, c3^2 < c1*c2]\n\
                mechanical: {M: [[c1 + c2 + 2*c3*cos(q2), c2 + c3*cos(q2)], [c2 + c3*cos(q2), c2]], \
                V: -g1*cos(q1) - g2*cos(q1 + q2), G: [[0], [1]]}",
        truth: Truth::None,
    },
    Case {
        from: "satellite in polar coordinates (Brockett 1970): a flat metric whose angle no formula holds",
        lines: "parameters: [m, mu]\nx: [pr, pt]\ny: [r, th]\nu: [ur, ut]\nassume: [m > 0, r > 0]\n\
                f_x: {pr: pt^2/(m*r^3) - mu/r^2 + ur, pt: ut}\nf_y: {r: pr/m, th: pt/(m*r^2)}",
        truth: Truth::Pebo,
    },
    Case {
        from: "predator and prey with saturation (Holling 1959, Rosenzweig, MacArthur 1963): an integral over the prey",
        lines: "parameters: [r, K, a, h, e, m]\nx: [P]\ny: [N]\nassume: [a > 0, h > 0, N > 0, P > 0]\n\
                f_x: {P: e*a*N/(1 + a*h*N)*P - m*P}\nf_y: {N: r*N*(1 - N/K) - a*N/(1 + a*h*N)*P}",
        truth: Truth::Pebo,
    },
    Case {
        from: "stirred tank (Monod 1949, Bastin, Dochain 1990), substrate measured: biomass",
        lines: "parameters: [mu, K, k]\nx: [X]\ny: [S]\nu: [D, Sin]\n\
                assume: [mu > 0, K > 0, k > 0, S > 0, X > 0]\n\
                f_x: {X: mu*S/(K + S)*X - D*X}\nf_y: {S: D*(Sin - S) - k*mu*S/(K + S)*X}",
        truth: Truth::Gpebo,
    },
    Case {
        from: "the same, biomass measured: S + k X, in which the growth rate is a fraction",
        lines: "parameters: [mu, K, k]\nx: [S]\ny: [X]\nu: [D, Sin]\n\
                assume: [mu > 0, K > 0, k > 0, S > 0, X > 0]\n\
                f_x: {S: D*(Sin - S) - k*mu*S/(K + S)*X}\nf_y: {X: mu*S/(K + S)*X - D*X}",
        truth: Truth::Found,
    },
    Case {
        from: "susceptible, exposed, infected (Anderson, May 1991)",
        lines: "parameters: [beta, s, g]\nx: [S, E]\ny: [I]\nassume: [beta > 0, s > 0, I > 0]\n\
                f_x: {S: -beta*S*I, E: beta*S*I - s*E}\nf_y: {I: s*E - g*I}",
        truth: Truth::Gpebo,
    },
    Case {
        from: "minimal model of glucose (Bergman, Ider, Bowden, Cobelli 1979)",
        lines: "parameters: [p1, p2, p3, n, Gb, Ib]\nx: [X, I]\ny: [G]\nu: [D, U]\nassume: [G > 0]\n\
                f_x: {X: -p2*X + p3*(I - Ib), I: -n*(I - Ib) + U}\nf_y: {G: -(p1 + X)*G + p1*Gb + D}",
        truth: Truth::Gpebo,
    },
    Case {
        from: "synchronous generator of third order (Bergen 1986) from its angle",
        lines: "parameters: [M, D, a, b, V, T]\nx: [w, E]\ny: [del]\nu: [Pm, Ef]\nassume: [M > 0, T > 0, V > 0]\n\
                f_x: {w: (Pm - E*V*sin(del) - D*w)/M, E: (-a*E + b*cos(del) + Ef)/T}\nf_y: {del: w}",
        truth: Truth::Gpebo,
    },
    Case {
        from: "quarter car (Hrovat 1997): velocities from deflections",
        lines: "parameters: [ms, mu, k, c, kt]\nx: [vs, vu]\ny: [d, t]\nu: [F, vr]\nassume: [ms > 0, mu > 0]\n\
                f_x: {vs: (-k*d - c*(vs - vu) + F)/ms, vu: (k*d + c*(vs - vu) - kt*t - F)/mu}\n\
                f_y: {d: vs - vu, t: vu - vr}",
        truth: Truth::Pebo,
    },
    Case {
        from: "FitzHugh 1961, Nagumo 1962: the recovery from the voltage",
        lines: "parameters: [e, a, b]\nx: [w]\ny: [v]\nu: [I]\nf_x: {w: e*(v + a - b*w)}\nf_y: {v: v - v^3/3 - w + I}",
        truth: Truth::Pebo,
    },
    Case {
        from: "Hindmarsh, Rose 1984: two currents from the voltage",
        lines: "parameters: [a, b, c, d, r, s, x0]\nx: [Y, Z]\ny: [X]\nu: [I]\n\
                f_x: {Y: c - d*X^2 - Y, Z: r*(s*(X - x0) - Z)}\nf_y: {X: Y - a*X^3 + b*X^2 - Z + I}",
        truth: Truth::Gpebo,
    },
    Case {
        from: "van de Vusse 1964: an integrating factor that leaves the rate affine, not free of x",
        lines: "parameters: [k1, k2, k3]\nx: [A]\ny: [B]\nu: [D, Ain]\nassume: [k1 > 0, A > 0]\n\
                f_x: {A: -k1*A - k3*A^2 + D*(Ain - A)}\nf_y: {B: k1*A - k2*B - D*B}",
        truth: Truth::Gpebo,
    },
    Case {
        from: "Oregonator (Field, Noyes 1974) from its catalyst",
        lines: "parameters: [e, q, f, d]\nx: [X, Y]\ny: [Z]\nassume: [X > 0, Y > 0, Z > 0, e > 0, d > 0]\n\
                f_x: {X: (q*Y - X*Y + X*(1 - X))/e, Y: (-q*Y - X*Y + f*Z)/d}\nf_y: {Z: X - Z}",
        truth: Truth::Gpebo,
    },
    Case {
        from: "two tanks (Torricelli 1643): the volume of both is a plain cascade, under a root in the output",
        lines: "parameters: [k1, k2, A]\nx: [h1]\ny: [h2]\nu: [q]\nassume: [k1 > 0, A > 0, h1 > 0, h2 > 0]\n\
                f_x: {h1: (q - k1*sqrt(h1))/A}\nf_y: {h2: (k1*sqrt(h1) - k2*sqrt(h2))/A}",
        truth: Truth::Monotone,
    },
    Case {
        from: "an epidemic (Kermack, McKendrick 1927) with both its rates unknown",
        lines: "x: [S, beta, gamma]\ny: [I, R]\nassume: [S > 0, I > 0, beta > 0, gamma > 0]\n\
                f_x: {S: -beta*S*I, beta: 0, gamma: 0}\nf_y: {I: beta*S*I - gamma*I, R: gamma*I}",
        truth: Truth::Found,
    },
    Case {
        from: "a bicycle with unknown tyres (Riekert, Schunck 1940)",
        lines: "parameters: [m, Iz, lf, lr]\nx: [vy, Cf, Cr]\ny: [r]\nu: [delta, vx]\n\
                assume: [m > 0, Iz > 0, lf > 0, lr > 0, vx > 0, Cf > 0, Cr > 0, lr*Cr - lf*Cf > 0]\n\
                f_x: {vy: -(Cf + Cr)*vy/(m*vx) + (lr*Cr - lf*Cf)*r/(m*vx) - vx*r + Cf*delta/m, Cf: 0, Cr: 0}\n\
                f_y: {r: (lr*Cr - lf*Cf)*vy/(Iz*vx) - (lf^2*Cf + lr^2*Cr)*r/(Iz*vx) + lf*Cf*delta/Iz}",
        truth: Truth::Found,
    },
    Case {
        from: "a motor from its speed alone, resistance, inductance and torque constant unknown",
        lines: "parameters: [J]\nx: [i, R, k, e]\ny: [w]\nu: [v]\nassume: [J > 0, R > 0, k > 0, e > 0]\n\
                f_x: {i: (v - R*i - e*w)*k, R: 0, k: 0, e: 0}\nf_y: {w: e*i/J}",
        truth: Truth::Found,
    },
    Case {
        from: "a fuel cell by its Nernst voltage: partial pressures of hydrogen and oxygen",
        lines: "parameters: {E: 1.2, a: 0.0215, k: 1, m: 0.5, t: 3, s: 6}\nx: [p, o]\ny: [V]\nu: [I, q, r]\n\
                assume: [p > 0, o > 0]\nf_x: {p: (q - k*p - I)/t, o: (r - m*o - I/2)/s}\n\
                identities: [exp(2*(V - E)/a) - p^2*o]",
        truth: Truth::Found,
    },
    Case {
        from: "a tank (Torricelli 1644) with an unknown outlet",
        lines: "parameters: [A, g]\nx: [a]\ny: [h]\nu: [q]\nassume: [A > 0, g > 0, h > 0]\nf_x: {a: 0}\n\
                f_y: {h: (q - a*sqrt(2*g*h))/A}",
        truth: Truth::Pebo,
    },
    Case {
        from: "a plant of third order with unknown coefficients (Kreisselmeier 1977)",
        lines: "x: [y1, y2, a, b, c, d]\ny: [y0]\nu: [u]\n\
                f_x: {y1: y2, y2: -a*y0 - b*y1 - c*y2 + d*u, a: 0, b: 0, c: 0, d: 0}\nf_y: {y0: y1}",
        truth: Truth::Gpebo,
    },
    Case {
        from: "two tones of unknown frequencies (Hsu, Ortega, Damm 1999)",
        lines: "x: [s1, s2, s3, p, q]\ny: [s0]\nf_x: {s1: s2, s2: s3, s3: -p*s0 - q*s2, p: 0, q: 0}\nf_y: {s0: s1}",
        truth: Truth::Gpebo,
    },
    Case {
        from: "friction that grows with the third power of the position, unknown (van der Pol 1920)",
        lines: "x: [v, c, d]\ny: [q]\nu: [u]\nf_x: {v: u - c*v*q - d*v*q^3, c: 0, d: 0}\nf_y: {q: v}",
        truth: Truth::Pebo,
    },
];

/// The class of the transform that was found, every claim being proved.
fn class(lines: &str, found: &Search) -> Class {
    let best = found.candidates.first().expect("a candidate");
    assert!(found.verdict == SearchVerdict::Found && best.is_full(), "{lines}");
    // A phi beside matrices is refused.
    if lines.contains("mechanical:") { best.derivation.class } else { written(lines, found).0 }
}

#[test]
fn searches_find_the_truth_of_plants_from_the_literature() {
    for Case { from, lines, truth } in CASES {
        let (_, found) = search(lines, None);
        let formulas = found.candidates.first().map(pebo_gen::search::Candidate::formulas);
        println!("{from}: {} {formulas:?}", found.verdict.word());
        match truth {
            Truth::Pebo => assert_eq!(class(lines, &found), Class::Pebo, "{from}: {formulas:?}"),
            Truth::Gpebo => {
                assert_eq!(class(lines, &found), Class::Gpebo, "{from}: {formulas:?}");
                let plain = search(lines, Some(Class::Pebo)).1;
                match plain.verdict {
                    SearchVerdict::Found => assert!(!plain.candidates[0].is_linear(), "{from}"),
                    _ => assert!(plain.bound.expect("a bound").excludes(), "{from}"),
                }
            }
            Truth::Found => assert_eq!(class(lines, &found), Class::Gpebo, "{from}: {formulas:?}"),
            Truth::None => {
                let bound = found.bound.expect("a bound");
                assert!(bound.class == BoundClass::Smooth && bound.excludes(), "{from}");
                assert_eq!(found.verdict, SearchVerdict::None, "{from}");
            }
            Truth::Monotone => {
                assert_eq!(found.verdict, SearchVerdict::Found, "{from}");
                let sense = found.candidates[0].derivation.at_estimate();
                assert_eq!(sense, Some(AtEstimate::Monotone), "{from}");
            }
        }
    }
}
