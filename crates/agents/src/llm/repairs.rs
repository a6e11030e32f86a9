//! How many answers went back to a model, and how many more may.

use std::cell::Cell;

/// Answers that went back, in one role for one scenario. Those of a wrong form are counted by themselves: what is wrong with a form
/// is told all at once, and says nothing about whether the model has understood.
#[derive(Debug, Default)]
pub struct Repairs {
    form: Cell<usize>,
    meaning: Cell<usize>,
}

impl Repairs {
    /// All of them.
    pub fn all(&self) -> usize {
        self.form.get() + self.meaning.get()
    }

    /// Counts an answer of a wrong form; whether it may go back.
    pub(super) fn form(&self, most: usize) -> bool {
        counted(&self.form, most)
    }

    /// How many answers that say what cannot be may still go back.
    pub(super) fn left(&self, most: usize) -> usize {
        most - self.meaning.get().min(most)
    }

    /// Counts an answer that says what cannot be; whether it may go back.
    pub(super) fn meaning(&self, most: usize) -> bool {
        counted(&self.meaning, most)
    }
}

fn counted(counter: &Cell<usize>, most: usize) -> bool {
    let goes_back = counter.get() < most;
    counter.set(counter.get() + usize::from(goes_back));
    goes_back
}
