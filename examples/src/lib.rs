//! Programs a user of hertzian would run and copy.
