//! Reads dates and times of day in the cells of a recording.
//!
//! In: text as ISO 8601 has it, `2026-11-25T10:00:00.25Z`, with a space for the T, without an offset, or the time of day
//! alone. Out: nanoseconds on a scale of their own, so that a difference is exact, however late the year.

use jiff::Timestamp;
use jiff::civil::{DateTime, Time};
use jiff::tz::TimeZone;

/// The instant in nanoseconds; of a time of day, those since midnight.
pub(super) fn moment(text: &str) -> Option<i128> {
    if let Ok(instant) = text.parse::<Timestamp>() {
        return Some(instant.as_nanosecond());
    }
    if let Ok(local) = text.parse::<DateTime>() {
        return Some(TimeZone::UTC.to_timestamp(local).ok()?.as_nanosecond());
    }
    Some(text.parse::<Time>().ok()?.duration_since(Time::midnight()).as_nanos())
}

#[cfg(test)]
mod tests {
    use super::moment;

    #[test]
    fn dates_and_times_are_instants() {
        // 2026-11-25 is 20782 days after 1970-01-01.
        let second = 1_000_000_000;
        let ten = (20782 * 86400 + 36000) * second;
        for text in ["2026-11-25T10:00:00Z", "2026-11-25 10:00:00", "2026-11-25T11:00:00+01:00", "2026-11-25 10:00"] {
            assert_eq!(moment(text), Some(ten), "{text}");
        }
        assert_eq!(moment("2026-11-25 10:00:00.25").unwrap() - moment("2026-11-25 10:00:00").unwrap(), 250_000_000);
        assert_eq!((moment("10:00:01"), moment("00:00")), (Some(36001 * second), Some(0)));
        for text in ["V", "rad/s", "", "-", "25.11.2026 10:00", "2026-13-01T00:00:00"] {
            assert_eq!(moment(text), None, "{text}");
        }
    }
}
