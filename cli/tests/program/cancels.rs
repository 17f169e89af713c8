//! Ctrl-C at a moment that is known.

use std::io::{self, Write};

use hertzian::Cancel;

/// Cancels when a line with this text is written into it.
pub struct CancelsAt(pub Cancel, pub &'static str);

impl Write for CancelsAt {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if String::from_utf8_lossy(bytes).contains(self.1) {
            self.0.cancel();
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

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
