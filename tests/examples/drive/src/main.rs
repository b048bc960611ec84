//! The load torque of a motor from its speed, as in README.md.

use pebo_runtime::Fault;

/// The observer of `drive.yaml`, written while the crate is compiled.
#[pebo_macros::pebo_model("drive.yaml", scalar = f32)]
mod drive {}

/// The estimated load torque after some samples, at a constant voltage.
fn load(motor: &mut Motor, samples: usize) -> Result<f32, Fault> {
    let (voltage, period) = (12.0, 1e-4);
    let mut observer = drive::Drive::observer(&drive::Parameters::default())?;
    let mut load = 0.0;
    for _ in 0..samples {
        // The speed now, the voltage since the sample before, the period.
        let estimate = observer.step(drive::Y { omega: motor.speed() }, drive::U { v: voltage }, period)?;
        load = estimate.t_l;
        motor.apply(voltage, period);
    }
    Ok(load)
}

/// The motor, with a load of 0.1 N m.
#[derive(Default)]
struct Motor {
    i: f32,
    omega: f32,
}

impl Motor {
    fn speed(&self) -> f32 {
        self.omega
    }

    /// One step of Euler's rule, with the new current in the rate of the speed.
    fn apply(&mut self, v: f32, dt: f32) {
        self.i += dt * (v - self.i - 0.1 * self.omega) / 5e-3;
        self.omega += dt * (0.1 * self.i - 1e-4 * self.omega - 0.1) / 1e-3;
    }
}

fn main() -> Result<(), Fault> {
    println!("load torque after 0.2 s: {:.3} N m", load(&mut Motor::default(), 2000)?);
    Ok(())
}

#[test]
fn the_load_is_found() {
    let load = load(&mut Motor::default(), 2000);
    // Euler's rule moves the current, as it falls by 10 A/s, by a period's worth: 1e-3 A, a torque of 1e-4 N m.
    assert!(load.is_ok_and(|load| (load - 0.1).abs() < 5e-4), "{load:?}");
}
