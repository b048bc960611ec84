//! Writes the observers of this crate's models.

fn main() -> Result<(), pebo_gen::BuildError> {
    pebo_gen::Builder::new().compile(&["models/pendulum.yaml"])?;
    Ok(())
}
