//! An axis: its range, and three to six marks at round values.

use super::label::Label;

/// An axis with its marks.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    /// The ends; of a logarithmic axis, their decimal logarithms.
    low: f64,
    high: f64,
    logarithmic: bool,
    pub(super) marks: Vec<Mark>,
    /// The power of ten that the marks are to be multiplied with.
    pub(super) exponent: i32,
}

/// A mark.
#[derive(Clone, Debug)]
pub(super) struct Mark {
    /// Its position, from 0 to 1.
    pub(super) place: f64,
    pub(super) label: Label,
}

/// The most decades of a logarithmic axis: smaller values are noise.
const MOST_DECADES: f64 = 12.0;

const MOST_MARKS: f64 = 6.0;

impl Axis {
    /// A linear axis from end to end.
    pub(super) fn whole(low: f64, high: f64) -> Self {
        Self { low, high, logarithmic: false, marks: Vec::new(), exponent: 0 }.marked()
    }

    /// A linear axis with room for these values and some space above and below.
    pub(super) fn linear(values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = extent(values).unwrap_or((0.0, 1.0));
        let space = match high - low {
            // Rounding noise on a constant is not worth an axis of its own.
            extent if extent > 1e-9 * low.abs().max(high.abs()) => 0.06 * extent,
            _ if high == 0.0 => 1.0,
            _ => 0.1 * high.abs(),
        };
        Self::whole(low - space, high + space)
    }

    /// A logarithmic axis with room for the absolute values of these values, from decade to decade.
    pub(super) fn logarithmic(values: impl Iterator<Item = f64>) -> Self {
        let magnitudes = values.map(f64::abs).filter(|value| *value > 0.0);
        let (low, high) = extent(magnitudes).unwrap_or((0.1, 1.0));
        let high = high.log10().ceil();
        let low = low.log10().floor().max(high - MOST_DECADES).min(high - 1.0);
        Self { low, high, logarithmic: true, marks: Vec::new(), exponent: 0 }.marked()
    }

    /// The position of a value: from 0 to 1, less if it is below a logarithmic axis.
    pub(super) fn place(&self, value: f64) -> f64 {
        let value = if self.logarithmic { value.abs().log10() } else { value };
        (value - self.low) / (self.high - self.low)
    }

    fn marked(mut self) -> Self {
        self.marks = if self.logarithmic { self.decades() } else { self.round() };
        self
    }

    /// Marks at multiples of a round step.
    fn round(&mut self) -> Vec<Mark> {
        let (low, high) = (self.low, self.high);
        // Neighbouring steps differ by two at most: the first that gives six marks or fewer gives three or more.
        let rough = ((high - low) / MOST_MARKS).log10().floor();
        let steps = [1.0, 2.0, 2.5, 5.0, 10.0, 20.0].map(|digit| digit * 10_f64.powf(rough));
        // The sum with zero makes a zero of a negative one.
        let ends = |step: f64| ((low / step - 1e-9).ceil() + 0.0, (high / step + 1e-9).floor() + 0.0);
        let fits = |step: &f64| ends(*step).1 - ends(*step).0 < MOST_MARKS;
        let step = steps.into_iter().find(fits).unwrap_or(high - low);
        let (first, last) = ends(step);
        let largest = (first.abs()).max(last.abs()) * step;
        if !(1e-2..1e4).contains(&largest) {
            // In threes, as prefixes go.
            self.exponent = 3 * whole((largest.log10() / 3.0).floor());
        }
        let unit = 10_f64.powi(self.exponent);
        let decimals = (0..9_u8).find(|d| is_whole(step / unit * 10_f64.powi(i32::from(*d)))).unwrap_or(9);
        let multiples = std::iter::successors(Some(first), |multiple| Some(multiple + 1.0));
        let multiples = multiples.take_while(|multiple| *multiple <= last);
        let mark = |multiple: f64| {
            let value = multiple * step;
            let text = format!("{:.1$}", value / unit, usize::from(decimals));
            Mark { place: (value - low) / (high - low), label: Label::text(&text.replace('-', "−")) }
        };
        multiples.map(mark).collect()
    }

    /// Marks at powers of ten; on a single decade, at 2 and 5 besides.
    fn decades(&self) -> Vec<Mark> {
        let count = self.high - self.low;
        let mark =
            |exponent: f64| Mark { place: (exponent - self.low) / count, label: Label::power_of_ten(whole(exponent)) };
        if count < 1.5 {
            let between = [2.0_f64, 5.0].map(|digit| Mark {
                place: digit.log10() / count,
                label: Label::text(&format!("{digit}·")).then(Label::power_of_ten(whole(self.low))),
            });
            return [mark(self.low)].into_iter().chain(between).chain([mark(self.high)]).collect();
        }
        let step = ((count + 1.0) / MOST_MARKS).ceil();
        let exponents = std::iter::successors(Some(self.high), |exponent| Some(exponent - step));
        exponents.take_while(|exponent| *exponent >= self.low).map(mark).collect()
    }
}

/// The least and the largest of the finite values.
fn extent(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let finite = values.filter(|value| value.is_finite());
    finite.fold(None, |extent, value| {
        let (low, high) = extent.unwrap_or((value, value));
        Some((value.min(low), value.max(high)))
    })
}

fn is_whole(value: f64) -> bool {
    (value - value.round()).abs() < 1e-6
}

#[expect(clippy::cast_possible_truncation, reason = "exponents of finite numbers are small")]
fn whole(exponent: f64) -> i32 {
    exponent as i32
}

#[cfg(test)]
mod tests {
    use super::{Axis, Mark};

    fn texts(axis: &Axis) -> Vec<String> {
        let text = |mark: &Mark| mark.label.runs.iter().map(|run| run.text.as_str()).collect::<String>();
        axis.marks.iter().map(text).collect()
    }

    #[test]
    fn every_range_has_three_to_six_round_marks() {
        for exponent in -9..9 {
            for digit in 0..200 {
                let extent = 10_f64.powi(exponent) * (1.0 + 9.0 * f64::from(digit) / 200.0);
                for low in [0.0, -0.37 * extent, 3.1 * extent] {
                    let axis = Axis::whole(low, low + extent);
                    assert!((3..=6).contains(&axis.marks.len()), "{low} {extent}: {:?}", texts(&axis));
                    assert!(axis.marks.iter().all(|mark| (-1e-6..1.000_001).contains(&mark.place)));
                    let mut texts = texts(&axis);
                    assert!(texts.iter().all(|text| text.chars().count() <= 6), "{texts:?}");
                    texts.dedup();
                    assert_eq!(texts.len(), axis.marks.len(), "{texts:?}");
                }
            }
        }
    }

    #[test]
    fn marks_are_what_a_person_would_write() {
        assert_eq!(texts(&Axis::whole(0.0, 1.0)), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(texts(&Axis::whole(-31.0, 2.0)), ["−30", "−20", "−10", "0"]);
        let axis = Axis::whole(0.0, 3e-5);
        assert_eq!((axis.exponent, texts(&axis)), (-6, ["0", "10", "20", "30"].map(String::from).to_vec()));
        assert_eq!(texts(&Axis::logarithmic([0.003, -2.0, 0.0].into_iter())), ["101", "100", "10−1", "10−2", "10−3"]);
        assert_eq!(texts(&Axis::logarithmic([2.0, 3.0].into_iter())), ["100", "2·100", "5·100", "101"]);
    }

    #[test]
    fn odd_values_have_an_axis() {
        for values in [vec![], vec![0.0], vec![5.0, 5.0], vec![f64::NAN, f64::INFINITY], vec![1e300, -1e300]] {
            for axis in [Axis::linear(values.iter().copied()), Axis::logarithmic(values.iter().copied())] {
                assert!((3..=7).contains(&axis.marks.len()) || axis.logarithmic, "{axis:?}");
                assert!(axis.place(5.0).is_finite());
            }
        }
    }
}
