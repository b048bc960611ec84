#[pebo_macros::pebo_model]
mod plant {
    const M: f64 = 1.0;
    const G: f64 = 9.81;

    struct X {
        p: f64,
    }

    struct Y {
        q: f64,
    }

    struct U {
        tau: f64,
    }

    fn f_x(y: &Y, u: &U) -> X {
        X { p: u.tau - M * G * y.q.sin() }
    }

    fn f_y(x: &X) -> Y {
        Y { q: x.p / M }
    }

    fn phi(y: &Y) -> [f64; 1] {
        [y.q]
    }
}

fn main() {}
