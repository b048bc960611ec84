#[pebo_macros::pebo_model("models/no_such_plant.yaml")]
struct Plant;

fn main() {}
