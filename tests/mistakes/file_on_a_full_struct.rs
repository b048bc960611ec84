#[pebo_macros::pebo_model("models/plant.yaml")]
struct Plant {
    a: f64,
}

fn main() {}
