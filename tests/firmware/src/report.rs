//! Results as words that board and host write alike.

use pebo_runtime::nalgebra::Vector2;

/// The sink of results.
pub trait Report {
    /// Writes text.
    fn write(&mut self, text: &str);

    /// Starts the results of something.
    fn name(&mut self, name: &str) {
        self.write(name);
        self.write("\n");
    }

    /// Writes the bits of a number.
    fn word(&mut self, bits: u32) {
        for place in (0..8_u32).rev() {
            let digit = match (bits >> (4 * place)) & 15 {
                0 => "0",
                1 => "1",
                2 => "2",
                3 => "3",
                4 => "4",
                5 => "5",
                6 => "6",
                7 => "7",
                8 => "8",
                9 => "9",
                10 => "a",
                11 => "b",
                12 => "c",
                13 => "d",
                14 => "e",
                _ => "f",
            };
            self.write(digit);
        }
    }

    /// Writes an estimate and its truth.
    fn estimate(&mut self, estimate: &Vector2<f32>, truth: &Vector2<f32>) {
        self.write(" ");
        for number in [estimate.x, estimate.y, truth.x, truth.y] {
            self.write(" ");
            self.word(number.to_bits());
        }
        self.write("\n");
    }

    /// Writes whether something was as it must be.
    fn flag(&mut self, right: bool) {
        self.write(if right { "  right\n" } else { "  wrong\n" });
    }
}
