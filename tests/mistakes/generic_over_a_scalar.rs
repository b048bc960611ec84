#[pebo_macros::pebo_model]
mod plant {
    struct X<T> {
        p: T,
    }

    struct Y<T> {
        q: T,
    }

    fn f_x<T: Copy>(y: &Y<T>) -> X<T> {
        X { p: y.q }
    }

    fn phi<T: Copy>(x: &X<T>) -> [T; 1] {
        [x.p]
    }
}

fn main() {}
