//! The load torque of a motor from its speed, as in README.md.

use pebo_runtime::Fault;

/// The observer of `drive.yaml`, written as the crate is compiled.
#[pebo_macros::pebo_model("drive.yaml", scalar = f32)]
mod drive {}

fn load_after(seconds: f32, mut plant: Plant) -> Result<f32, Fault> {
    let mut observer = drive::Drive::observer(&drive::Parameters::default())?;
    let (period, voltage) = (1e-4, 12.0);
    let mut load = 0.0;
    for _ in 0..(seconds / period) as usize {
        // The speed now, the voltage since the sample before, the period.
        let estimate = observer.step(drive::Y { omega: plant.speed() }, drive::U { v: voltage }, period)?;
        load = estimate.t_l;
        plant.run(voltage, period);
    }
    Ok(load)
}

/// The motor, with a load of 0.1 N m.
#[derive(Default)]
struct Plant {
    i: f32,
    omega: f32,
}

impl Plant {
    fn speed(&self) -> f32 {
        self.omega
    }

    /// Semi-implicit Euler.
    fn run(&mut self, v: f32, dt: f32) {
        self.i += dt * (v - self.i - 0.1 * self.omega) / 5e-3;
        self.omega += dt * (0.1 * self.i - 1e-4 * self.omega - 0.1) / 1e-3;
    }
}

fn main() -> Result<(), Fault> {
    println!("load torque after 0.2 s: {:.3} N m", load_after(0.2, Plant::default())?);
    Ok(())
}

#[test]
fn the_load_is_found() {
    // Euler's rule at this period moves the apparent torque by some thousandths.
    assert!(load_after(0.2, Plant::default()).is_ok_and(|load| (load - 0.1).abs() < 0.01));
}
