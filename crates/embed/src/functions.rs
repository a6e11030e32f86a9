//! Float functions over whole rows, written so that the compiler can use vector instructions. No function of the
//! platform's maths library is called. Coefficients: `oracle/fit.py`.

/// Beyond this erf is 1 to single precision.
const ERF_LIMIT: f32 = 3.92;
/// Numerator of `erf(x) = x P(x^2) / Q(x^2)`.
const ERF_P: [f32; 7] =
    [1.128_378_8, 0.206_076_44, 0.051_392_25, 3.971_168e-3, 1.489_361_3e-4, -1.993_939_3e-6, 1.991_958_4e-8];
/// Its denominator.
const ERF_Q: [f32; 5] = [1.0, 0.515_959_3, 0.117_548_88, 0.014_885_902, 1.023_672_7e-3];
/// `2^f` for f in [-1/2, 1/2].
const POWERS: [f32; 7] =
    [1.0, std::f32::consts::LN_2, 0.240_226_5, 0.055_503_27, 9.618_026e-3, 1.340_044_2e-3, 1.546_974e-4];

/// The error function, to 5e-7.
#[inline]
pub(crate) fn erf(x: f32) -> f32 {
    let x = x.clamp(-ERF_LIMIT, ERF_LIMIT);
    let square = x * x;
    x * horner(&ERF_P, square) / horner(&ERF_Q, square)
}

/// The exponential of a number that is not positive, to a relative 3e-7; 0 below -87.
#[inline]
pub(crate) fn exp_of_negative(x: f32) -> f32 {
    // Adding this moves the fraction bits of a small float out: what is left is its nearest whole number.
    const ROUNDER: f32 = 12_582_912.0;
    let exponent = x.max(-87.0) * std::f32::consts::LOG2_E;
    let shifted = exponent + ROUNDER;
    let whole = shifted - ROUNDER;
    let power = f32::from_bits((shifted.to_bits() << 23).wrapping_add(1.0_f32.to_bits()));
    let value = power * horner(&POWERS, exponent - whole);
    if x < -87.0 { 0.0 } else { value }
}

/// `x (1 + erf(x / sqrt 2)) / 2` of each value (Hendrycks and Gimpel 2016, the exact form).
pub(crate) fn gelu(values: &mut [f32]) {
    for x in values {
        *x *= 0.5 + 0.5 * erf(*x * std::f32::consts::FRAC_1_SQRT_2);
    }
}

/// `exp(scale x_i) / sum_j exp(scale x_j)`, with the greatest taken off first. `scale` is positive.
pub(crate) fn softmax(values: &mut [f32], scale: f32) {
    let greatest = values.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    for x in values.iter_mut() {
        *x = exp_of_negative((*x - greatest) * scale);
    }
    let factor = 1.0 / sum(values);
    values.iter_mut().for_each(|x| *x *= factor);
}

/// Mean 0 and variance 1, then scaled and shifted (Ba, Kiros and Hinton 2016).
pub(crate) fn layer_norm(values: &mut [f32], scale: &[f32], shift: &[f32], epsilon: f32) {
    let count = values.len() as f32;
    let mean = sum(values) / count;
    values.iter_mut().for_each(|x| *x -= mean);
    let factor = 1.0 / (sum_of_squares(values) / count + epsilon).sqrt();
    for ((x, scale), shift) in values.iter_mut().zip(scale).zip(shift) {
        *x = *x * factor * scale + shift;
    }
}

/// Scaled to length 1; zeros stay zeros.
pub(crate) fn unit_length(values: &mut [f32]) {
    let length = sum_of_squares(values).sqrt();
    if length > 0.0 {
        values.iter_mut().for_each(|x| *x /= length);
    }
}

/// Sum in eight lanes, then over the lanes: always in this order.
fn sum(values: &[f32]) -> f32 {
    let mut lanes = [0.0_f32; 8];
    let chunks = values.chunks_exact(8);
    let rest: f32 = chunks.remainder().iter().sum();
    for chunk in chunks {
        lanes.iter_mut().zip(chunk).for_each(|(lane, x)| *lane += x);
    }
    lanes.iter().sum::<f32>() + rest
}

fn sum_of_squares(values: &[f32]) -> f32 {
    let mut lanes = [0.0_f32; 8];
    let chunks = values.chunks_exact(8);
    let rest: f32 = chunks.remainder().iter().map(|x| x * x).sum();
    for chunk in chunks {
        lanes.iter_mut().zip(chunk).for_each(|(lane, x)| *lane += x * x);
    }
    lanes.iter().sum::<f32>() + rest
}

#[inline]
fn horner<const N: usize>(coefficients: &[f32; N], x: f32) -> f32 {
    let mut result = coefficients[N - 1];
    for k in (0..N - 1).rev() {
        result = result * x + coefficients[k];
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn erf_is_that_of_libm() {
        for i in -60_000..=60_000 {
            let x = i as f32 * 1e-4;
            assert!((f64::from(erf(x)) - libm::erf(f64::from(x))).abs() < 5e-7, "{x}");
        }
    }

    #[test]
    fn exponential_is_that_of_libm() {
        for i in 0..87_000 {
            let x = i as f32 * -1e-3;
            let expected = libm::exp(f64::from(x));
            // The rounding of x times log2 e grows with x.
            let allowed = 3e-7 + 1.2e-7 * f64::from(-x);
            assert!((f64::from(exp_of_negative(x)) / expected - 1.0).abs() < allowed, "{x}");
        }
        assert_eq!((exp_of_negative(0.0), exp_of_negative(-100.0)), (1.0, 0.0));
        assert_eq!(exp_of_negative(f32::NEG_INFINITY), 0.0);
    }

    #[test]
    fn gelu_by_known_values() {
        let mut values = [0.0, 1.0, -1.0, 8.0, -8.0];
        gelu(&mut values);
        let expected = [0.0, 0.841_344_8, -0.158_655_25, 8.0, 0.0];
        values.iter().zip(expected).for_each(|(x, e)| assert!((x - e).abs() < 2e-6, "{x} {e}"));
    }

    #[test]
    fn softmax_by_hand() {
        // Logarithms of 1, 2, 4 at scale 1/2 of their doubles: shares 1/7, 2/7, 4/7.
        let ln2 = std::f32::consts::LN_2;
        let mut values = [0.0, 2.0 * ln2, 4.0 * ln2];
        softmax(&mut values, 0.5);
        values.iter().zip([1.0, 2.0, 4.0]).for_each(|(x, e)| assert!((x - e / 7.0).abs() < 1e-6));
    }

    #[test]
    fn layer_norm_by_hand() {
        // Mean 3, deviations -2, 0, 2; variance 8/3.
        let mut values = [1.0, 3.0, 5.0];
        layer_norm(&mut values, &[1.0, 1.0, 2.0], &[0.0, 1.0, 0.0], 0.0);
        let unit = 1.5_f32.sqrt();
        values.iter().zip([-unit, 1.0, 2.0 * unit]).for_each(|(x, e)| assert!((x - e).abs() < 1e-6));
    }
}
