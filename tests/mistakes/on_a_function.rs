#[pebo_macros::pebo_model]
fn plant() {}

fn main() {}
