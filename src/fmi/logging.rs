//! Messages to the importer: what is told, and when.

use super::failures::{Blame, Failure};
use std::ffi::{CStr, CString};

/// The declared log categories.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Category {
    /// Reasons why a call failed.
    StatusError,
    /// Reasons why a call did less than it was asked for, with the instance going on.
    StatusWarning,
    /// Iterations and residuals.
    Solver,
    /// Events in the life of an instance.
    Events,
}

impl Category {
    /// All categories, in the order in which they are declared.
    pub const ALL: [Category; 4] = [
        Category::StatusError,
        Category::StatusWarning,
        Category::Solver,
        Category::Events,
    ];

    /// The declared name.
    pub fn name(self) -> &'static CStr {
        match self {
            Category::StatusError => c"logStatusError",
            Category::StatusWarning => c"logStatusWarning",
            Category::Solver => c"logSolver",
            Category::Events => c"logEvents",
        }
    }

    /// The category of this name.
    ///
    /// # Errors
    /// [`Failure::UnknownCategory`].
    pub fn named(name: &CStr) -> Result<Category, Failure> {
        Category::ALL
            .into_iter()
            .find(|category| category.name() == name)
            .ok_or_else(|| Failure::UnknownCategory {
                name: name.to_string_lossy().into_owned(),
            })
    }

    /// The category of the message on a failed call.
    fn of(blame: Blame) -> Category {
        match blame {
            Blame::Remark | Blame::Value | Blame::PartOfStep => Category::StatusWarning,
            Blame::Call | Blame::Library => Category::StatusError,
        }
    }

    fn bit(self) -> u8 {
        1 << self as u8
    }
}

/// A message to the importer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message {
    /// Party to blame; `None` where nothing is wrong.
    pub blame: Option<Blame>,
    /// The category.
    pub category: Category,
    /// The text.
    pub text: String,
}

/// A message as the standards want it: `#` starts a variable's name and is written twice, nothing ends it but a zero.
pub fn escaped(text: &str) -> CString {
    let text = text.replace('#', "##").replace('\0', " ");
    CString::new(text.trim_end()).unwrap_or_default()
}

/// Log categories that a standard wants on.
#[derive(Debug, Clone, Copy)]
pub struct Rules {
    /// Categories on at first, where the importer has not asked for all.
    pub at_first: &'static [Category],
    /// Categories always on, even where the importer has switched them off.
    pub always: &'static [Category],
    /// Whether those that are switched on come on top of those that are on already.
    pub adds: bool,
}

/// The messages of a call, which wait for its end: the importer's logger may call back into the instance. And the categories
/// that are on.
pub struct Journal {
    /// Whether anybody listens; if not, no text is put together.
    heard: bool,
    rules: Rules,
    enabled: u8,
    messages: Vec<Message>,
}

fn bits(categories: &[Category]) -> u8 {
    categories.iter().fold(0, |bits, category| bits | category.bit())
}

impl Journal {
    /// A journal with all categories on, or only those that the rules name.
    pub fn new(heard: bool, all: bool, rules: Rules) -> Journal {
        Journal {
            heard,
            rules,
            enabled: bits(if all { &Category::ALL } else { rules.at_first }),
            messages: Vec::new(),
        }
    }

    /// Switches categories on, as the rules say, or off. An empty list stands for all.
    pub fn switch(&mut self, on: bool, categories: &[Category]) {
        let categories = if categories.is_empty() {
            &Category::ALL[..]
        } else {
            categories
        };
        let kept = if on && !self.rules.adds { 0 } else { self.enabled };
        self.enabled = if on {
            kept | bits(categories)
        } else {
            kept & !bits(categories)
        };
    }

    /// Whether a message of this category would be written; if not, its text need not be put together.
    pub fn hears(&self, category: Category) -> bool {
        self.heard && (self.enabled | bits(self.rules.always)) & category.bit() != 0
    }

    /// Tells why a call failed, where the category is on.
    pub fn failure(&mut self, blame: Blame, text: impl FnOnce() -> String) {
        let category = Category::of(blame);
        if self.hears(category) {
            self.messages.push(Message {
                blame: Some(blame),
                category,
                text: text(),
            });
        }
    }

    /// Tells something else, where the category is on.
    pub fn inform(&mut self, category: Category, text: String) {
        if self.hears(category) {
            self.messages.push(Message {
                blame: None,
                category,
                text,
            });
        }
    }

    /// The messages that wait.
    pub fn take(&mut self) -> Vec<Message> {
        std::mem::take(&mut self.messages)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn categories(journal: &mut Journal) -> Vec<Category> {
        for blame in [Blame::Call, Blame::Value] {
            journal.failure(blame, String::new);
        }
        for category in [Category::Solver, Category::Events] {
            journal.inform(category, String::new());
        }
        journal.take().into_iter().map(|message| message.category).collect()
    }

    const EXACT: Rules = Rules {
        at_first: &[Category::StatusError, Category::StatusWarning],
        always: &[],
        adds: false,
    };

    #[test]
    fn only_what_is_on_and_heard_is_written() {
        assert_eq!(categories(&mut Journal::new(true, false, EXACT)), EXACT.at_first);
        assert_eq!(categories(&mut Journal::new(true, true, EXACT)), Category::ALL);
        assert_eq!(categories(&mut Journal::new(false, true, EXACT)), []);
        let mut journal = Journal::new(true, false, EXACT);
        journal.switch(true, &[Category::Solver]);
        assert_eq!(categories(&mut journal), [Category::Solver]);
        journal.switch(true, &[]);
        journal.switch(false, &[Category::Solver]);
        assert_eq!(
            categories(&mut journal),
            [Category::StatusError, Category::StatusWarning, Category::Events]
        );
        journal.switch(false, &[]);
        assert_eq!(categories(&mut journal), []);
    }

    #[test]
    fn categories_may_add_up_and_errors_may_always_be_told() {
        let rules = Rules {
            at_first: &[],
            always: &[Category::StatusError],
            adds: true,
        };
        let mut journal = Journal::new(true, false, rules);
        assert_eq!(categories(&mut journal), [Category::StatusError]);
        journal.switch(true, &[Category::Solver]);
        journal.switch(true, &[Category::Events]);
        assert_eq!(
            categories(&mut journal),
            [Category::StatusError, Category::Solver, Category::Events]
        );
        journal.switch(false, &[]);
        assert_eq!(categories(&mut journal), [Category::StatusError]);
    }
}
