#[pebo_macros::pebo_model]
mod plant {
    const M: f64 = 1.0;

    struct X {
        p: f64,
    }

    impl X {
        fn velocity(&self) -> f64 {
            self.p / M
        }
    }

    struct Y {
        q: f64,
    }

    struct U {
        tau: f64,
    }

    fn f_x(y: &Y, u: &U) -> X {
        X { p: u.tau - y.q.sin() }
    }

    fn f_y(x: &X) -> Y {
        Y { q: x.velocity() }
    }

    fn phi(x: &X) -> [f64; 1] {
        [x.p]
    }
}

fn main() {}
