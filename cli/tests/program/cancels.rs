//! Ctrl-C at a moment that is known.

use std::io::{self, Write};

use hertzian::Cancel;

/// Cancels when something is written into it: as a line of progress is at the first point, row or block.
pub struct CancelsWhereWritten(pub Cancel);

impl Write for CancelsWhereWritten {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.cancel();
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
