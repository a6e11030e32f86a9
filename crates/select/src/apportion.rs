//! Sharing a number of picks out over templates: the method of equal proportions.

/// Shares `total` picks out over parties of these weights, none above its limit.
///
/// Every party gets one pick first, in the order of the list, as far as `total` goes. Each further pick goes to the
/// party with the greatest priority `w / sqrt(n (n + 1))`, where `n` is what it has (Huntington 1928; the method by
/// which the seats of the U.S. House are shared, 2 U.S.C. 2a), the first of equals. So nobody with a record is left out
/// while the picks last, and a greater `total` never takes a pick away.
pub(crate) fn equal_proportions(weights: &[f64], limits: &[usize], total: usize) -> Vec<usize> {
    let mut picks = vec![0_usize; weights.len()];
    let mut left = total;
    for (pick, &limit) in picks.iter_mut().zip(limits) {
        if left > 0 && limit > 0 {
            *pick = 1;
            left -= 1;
        }
    }
    while left > 0 {
        let mut best: Option<(f64, usize)> = None;
        for (party, &weight) in weights.iter().enumerate().filter(|&(party, _)| picks[party] < limits[party]) {
            let has = picks[party] as f64;
            let priority = weight / (has * (has + 1.0)).sqrt();
            if best.is_none_or(|(greatest, _)| priority > greatest) {
                best = Some((priority, party));
            }
        }
        let Some((_, party)) = best else { break };
        picks[party] += 1;
        left -= 1;
    }
    picks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand() {
        // Priorities 100/sqrt2 = 70.7, 100/sqrt6 = 40.8, 100/sqrt12 = 28.9; 50/sqrt2 = 35.4; 10/sqrt2 = 7.1.
        assert_eq!(equal_proportions(&[100.0, 50.0, 10.0], &[99; 3], 6), [3, 2, 1]);
        assert_eq!(equal_proportions(&[100.0, 50.0, 10.0], &[99; 3], 7), [4, 2, 1]);
    }

    #[test]
    fn too_few_for_all_go_to_the_first() {
        assert_eq!(equal_proportions(&[5.0, 4.0, 3.0], &[9; 3], 2), [1, 1, 0]);
    }

    #[test]
    fn limits_hold_and_what_nobody_can_take_is_left() {
        assert_eq!(equal_proportions(&[100.0, 1.0], &[2, 3], 4), [2, 2]);
        assert_eq!(equal_proportions(&[100.0, 1.0], &[2, 3], 50), [2, 3]);
        assert_eq!(equal_proportions(&[], &[], 5), [0; 0]);
    }

    #[test]
    fn a_greater_total_takes_nothing_away() {
        let (weights, limits) = ([104.0, 36.0, 26.0, 14.0, 3.0, 1.0], [90, 30, 20, 14, 3, 1]);
        let mut before = equal_proportions(&weights, &limits, 0);
        for total in 1..160 {
            let now = equal_proportions(&weights, &limits, total);
            assert!(now.iter().zip(&before).all(|(now, before)| now >= before));
            assert_eq!(now.iter().sum::<usize>(), total.min(158));
            before = now;
        }
    }
}
