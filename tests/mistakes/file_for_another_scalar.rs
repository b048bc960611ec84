#[pebo_macros::pebo_model("models/plant.yaml", scalar = f16)]
struct Plant;

fn main() {}
