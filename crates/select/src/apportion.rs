//! Sharing picks out over templates by their weight: the method of equal proportions.

/// Who gets the next pick: the party with the greatest priority `w / sqrt(n (n + 1))`, where `n` is what it has, among
/// those below their limit; the first of equals. A party without a pick comes before all with one, in the order of
/// the list.
///
/// This is the method by which the seats of the U.S. House are shared (Huntington 1928; 2 U.S.C. 2a). Every party gets a
/// pick before one gets a second, and a greater total never takes a pick away.
pub(crate) fn next_by_equal_proportions(weights: &[f64], picks: &[usize], limits: &[usize]) -> Option<usize> {
    let mut best: Option<(f64, usize)> = None;
    for (party, &weight) in weights.iter().enumerate().filter(|&(party, _)| picks[party] < limits[party]) {
        let has = picks[party] as f64;
        let priority = if picks[party] == 0 { f64::INFINITY } else { weight / (has * (has + 1.0)).sqrt() };
        if best.is_none_or(|(greatest, _)| priority > greatest) {
            best = Some((priority, party));
        }
    }
    best.map(|(_, party)| party)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn share_out(weights: &[f64], limits: &[usize], total: usize) -> Vec<usize> {
        let mut picks = vec![0; weights.len()];
        for _ in 0..total {
            if let Some(party) = next_by_equal_proportions(weights, &picks, limits) {
                picks[party] += 1;
            }
        }
        picks
    }

    #[test]
    fn by_hand() {
        // Priorities 100/sqrt2 = 70.7, 100/sqrt6 = 40.8, 100/sqrt12 = 28.9; 50/sqrt2 = 35.4; 10/sqrt2 = 7.1.
        assert_eq!(share_out(&[100.0, 50.0, 10.0], &[99; 3], 6), [3, 2, 1]);
        assert_eq!(share_out(&[100.0, 50.0, 10.0], &[99; 3], 7), [4, 2, 1]);
    }

    #[test]
    fn too_few_for_all_go_to_the_first() {
        assert_eq!(share_out(&[5.0, 4.0, 3.0], &[9; 3], 2), [1, 1, 0]);
    }

    #[test]
    fn limits_hold_and_what_nobody_can_take_is_left() {
        assert_eq!(share_out(&[100.0, 1.0], &[2, 3], 4), [2, 2]);
        assert_eq!(share_out(&[100.0, 1.0], &[2, 3], 50), [2, 3]);
        assert_eq!(share_out(&[], &[], 5), [0; 0]);
    }
}
