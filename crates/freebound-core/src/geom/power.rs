//! Powers of two as factors: multiplying by a power of two does not round.

/// Largest exponent of a power of two whose reciprocal is a normal number.
const GREATEST: f64 = 1022.0;

/// Power of two nearest in ratio to a number, among those that have a normal reciprocal. Returns 1 unless the number
/// is positive and finite.
pub fn power_of_two_near(number: f64) -> f64 {
    let is_usable = number > 0.0 && number.is_finite();
    if is_usable { number.log2().round().clamp(-GREATEST, GREATEST).exp2() } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multiplying_and_dividing_by_a_power_of_two_gives_every_number_back() {
        for number in [1.0, 3.0, 0.1, 1e-300, 1.7e308, 5e-324, 1e160] {
            let power = power_of_two_near(number);
            assert_eq!(((number / power) * power).to_bits(), number.to_bits(), "{number:e}");
            assert!((0.2..=4.0).contains(&(number / power)) || number < f64::MIN_POSITIVE, "{number:e}");
        }
        for none in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(power_of_two_near(none).to_bits(), 1.0_f64.to_bits(), "{none}");
        }
    }
}
