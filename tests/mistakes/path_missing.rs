#[pebo_macros::pebo_model]
struct Plant;

fn main() {}
