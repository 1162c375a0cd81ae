//! What a reader of the images must know of how they were made.

use protocols::RefinementDriver;

/// What follows for the images if these channels drive the refinement; nothing, if A does so alone.
pub(crate) fn of_driver(driver: RefinementDriver) -> Option<&'static str> {
    match driver {
        RefinementDriver::A => None,
        RefinementDriver::All => Some(
            "All three channels drive the refinement: a channel that stops changes the tree of the others, \
             so that an image traced alone differs from the same image of a set.",
        ),
    }
}
