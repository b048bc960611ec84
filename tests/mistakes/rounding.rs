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
        X { p: u.tau - y.q.floor() }
    }

    fn f_y(x: &X) -> Y {
        Y { q: x.p / M }
    }

    fn phi(x: &X) -> [f64; 1] {
        [x.p]
    }
}

fn main() {}
