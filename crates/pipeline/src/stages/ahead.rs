//! What the points of a search need, made before they are asked for.

use recrash_search::Next;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// What is made of points: of the one that is asked for, and meanwhile, on threads that have nothing else to do, of those that may come next.
/// It is the same whenever it is made.
pub(super) struct Ahead<T, M> {
    make: M,
    made: Mutex<Vec<(Vec<f64>, T)>>,
}

impl<T: Clone + Send, M: Fn(&[f64]) -> T + Sync> Ahead<T, M> {
    pub(super) fn new(make: M) -> Self {
        Self { make, made: Mutex::default() }
    }

    /// What is made of a point.
    pub(super) fn of(&self, point: &[f64]) -> T {
        self.known(point).unwrap_or_else(|| (self.make)(point))
    }

    /// Makes it of a point, and what there is time for of the next ones.
    pub(super) fn prepare(&self, point: &[f64], next: Next<'_>) {
        if self.known(point).is_some() {
            return;
        }
        let next = next(rayon::current_num_threads() - 1);
        let waits = AtomicBool::new(true);
        self.made.lock().unwrap_or_else(PoisonError::into_inner).clear();
        rayon::scope(|scope| {
            for point in &next {
                // None is begun for which the search would have to wait.
                scope.spawn(|_| {
                    if waits.load(Ordering::Relaxed) {
                        self.keep(point);
                    }
                });
            }
            self.keep(point);
            waits.store(false, Ordering::Relaxed);
        });
    }

    fn known(&self, point: &[f64]) -> Option<T> {
        let made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        made.iter().find(|(values, _)| values == point).map(|(_, made)| made.clone())
    }

    fn keep(&self, point: &[f64]) {
        let made = (self.make)(point);
        self.made.lock().unwrap_or_else(PoisonError::into_inner).push((point.to_vec(), made));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::AtomicUsize;

    #[test]
    fn what_is_made_ahead_is_not_made_again() {
        let count = AtomicUsize::new(0);
        let ahead = Ahead::new(|point: &[f64]| {
            count.fetch_add(1, Ordering::Relaxed);
            2.0 * point[0]
        });
        let pool = rayon::ThreadPoolBuilder::new().num_threads(4).build().unwrap();
        pool.install(|| ahead.prepare(&[1.0], &|count| (2..).take(count).map(|n| vec![f64::from(n)]).collect()));
        let made = count.load(Ordering::Relaxed);
        assert!((1..=4).contains(&made), "{made}");
        let known = [1.0, 2.0, 3.0, 4.0].iter().filter(|value| ahead.known(&[**value]).is_some()).count();
        assert_eq!(known, made);
        assert_eq!((ahead.of(&[1.0]), count.load(Ordering::Relaxed)), (2.0, made));
        assert_eq!([2.0, 3.0, 4.0, 9.0].map(|value| ahead.of(&[value])), [4.0, 6.0, 8.0, 18.0]);
    }

    #[test]
    fn on_one_thread_nothing_is_made_ahead() {
        let ahead = Ahead::new(|point: &[f64]| point[0]);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        pool.install(|| ahead.prepare(&[1.0], &|count| vec![vec![2.0]; count]));
        assert_eq!((ahead.known(&[1.0]), ahead.known(&[2.0])), (Some(1.0), None));
    }
}
