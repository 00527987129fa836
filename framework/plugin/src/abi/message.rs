//! The caller's buffer for the text of an error.

/// Bytes that a host lends for the text of one error.
const CAPACITY: usize = 1024;

/// Where the called side writes why it failed, UTF-8 without a final zero.
#[repr(C)]
#[derive(Debug)]
pub struct Message {
    /// The buffer.
    pub data: *mut u8,
    /// Its size in bytes.
    pub capacity: usize,
    /// Bytes written, set by the called side.
    pub length: usize,
}

impl Message {
    /// Writes `text`, cut to what fits at the end of a character.
    ///
    /// # Safety
    /// `data` must be null or lead to `capacity` writable bytes.
    pub(super) unsafe fn write(&mut self, text: &str) {
        if self.data.is_null() {
            self.length = 0;
            return;
        }
        self.length = text.floor_char_boundary(self.capacity);
        // SAFETY: the caller promises `capacity` bytes, and `length` is no more; a fresh
        // string does not overlap the caller's buffer.
        unsafe { std::ptr::copy_nonoverlapping(text.as_ptr(), self.data, self.length) };
    }
}

/// Calls `function` with room for a message and returns its answer with what was written.
pub(super) fn with_message<R>(function: impl FnOnce(*mut Message) -> R) -> (R, String) {
    let mut buffer = [0u8; CAPACITY];
    let mut message = Message { data: buffer.as_mut_ptr(), capacity: CAPACITY, length: 0 };
    let answer = function(&mut message);
    let written = message.length.min(CAPACITY);
    (answer, String::from_utf8_lossy(&buffer[..written]).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_cut_between_characters() {
        let long = "ö".repeat(600);
        let ((), text) = with_message(|message| {
            // SAFETY: `with_message` lends a valid message.
            unsafe { (*message).write(&long) }
        });
        assert_eq!(text, "ö".repeat(512));
        let mut small = [0u8; 3];
        let mut message = Message { data: small.as_mut_ptr(), capacity: 3, length: 9 };
        // SAFETY: three bytes of capacity, three bytes of buffer.
        unsafe { message.write("aöö") };
        assert_eq!((message.length, &small), (3, "aö".as_bytes().try_into().expect("three")));
    }

    #[test]
    fn a_missing_buffer_takes_nothing() {
        let mut message = Message { data: std::ptr::null_mut(), capacity: 8, length: 5 };
        // SAFETY: null is allowed.
        unsafe { message.write("text") };
        assert_eq!(message.length, 0);
    }
}
