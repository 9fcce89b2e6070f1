//! Reading of the Common Data Representation in which ROS 2 writes messages: plain CDR (XCDR
//! version 1) of either byte order, after the encapsulation header of four bytes.

/// Length of the encapsulation header, bytes. Alignment counts from its end.
const HEADER: usize = 4;

/// Most bytes that may follow a message, which writers add to round its length up.
const MOST_PADDING: usize = 7;

/// First bytes of a message that rosbag2 compressed by itself.
const ZSTD: [u8; 4] = [0x28, 0xb5, 0x2f, 0xfd];

/// A reader of one message.
#[derive(Debug, Clone)]
pub(crate) struct Cdr<'a> {
    body: &'a [u8],
    position: usize,
    order: ByteOrder,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ByteOrder {
    Big,
    Little,
}

impl<'a> Cdr<'a> {
    /// Returns a reader of `message`, which starts with the encapsulation header.
    pub(crate) fn new(message: &'a [u8]) -> Result<Self, String> {
        if message.starts_with(&ZSTD) {
            return Err("it is compressed by itself (rosbag2's compression mode \"message\"); \
                        write the log again with ros2 bag convert and without that mode"
                .into());
        }
        let (header, body) = message
            .split_first_chunk::<HEADER>()
            .ok_or_else(|| format!("it has {} bytes, too few for CDR", message.len()))?;
        let order = match header[..2] {
            [0, 0] => ByteOrder::Big,
            [0, 1] => ByteOrder::Little,
            [first, second] => {
                return Err(format!(
                    "its encoding {first:#04x}{second:02x} is not plain CDR (0x0000 or 0x0001)"
                ));
            }
            _ => unreachable!("the slice has two bytes"),
        };
        Ok(Self { body, position: 0, order })
    }

    /// Moves to the next multiple of `size`, and returns the `length` bytes from there.
    fn take(&mut self, size: usize, length: usize) -> Result<&'a [u8], String> {
        let start = self.position.next_multiple_of(size);
        let end = start.checked_add(length).filter(|end| *end <= self.body.len());
        let end = end.ok_or_else(|| {
            format!(
                "it is cut short: a field of {length} bytes starts at byte {}, but the message \
                 has {}",
                HEADER + start,
                HEADER + self.body.len()
            )
        })?;
        self.position = end;
        Ok(&self.body[start..end])
    }

    pub(crate) fn byte(&mut self) -> Result<u8, String> {
        Ok(self.take(1, 1)?[0])
    }

    pub(crate) fn u32(&mut self) -> Result<u32, String> {
        let bytes = self.take(4, 4)?.try_into().expect("four bytes were taken");
        Ok(match self.order {
            ByteOrder::Big => u32::from_be_bytes(bytes),
            ByteOrder::Little => u32::from_le_bytes(bytes),
        })
    }

    pub(crate) fn i32(&mut self) -> Result<i32, String> {
        self.u32().map(u32::cast_signed)
    }

    /// Reads a string: its length with the final zero byte, then its bytes.
    pub(crate) fn string(&mut self) -> Result<&'a str, String> {
        let length = self.u32()? as usize;
        let at = HEADER + self.position;
        let bytes = self.take(1, length)?;
        // Some writers give an empty string without its final zero.
        let text = match bytes {
            [] => bytes,
            [text @ .., 0] => text,
            _ => return Err(format!("the string at byte {at} does not end with a zero")),
        };
        std::str::from_utf8(text).map_err(|_| format!("the string at byte {at} is not UTF-8"))
    }

    pub(crate) fn strings(&mut self) -> Result<Vec<&'a str>, String> {
        let count = self.u32()? as usize;
        let left = self.body.len() - self.position;
        // Each takes four bytes at least, which bounds the memory that a wrong count asks for.
        if count > left / 4 {
            return Err(format!(
                "it is cut short: {count} strings are announced, but {left} bytes are left"
            ));
        }
        (0..count).map(|_| self.string()).collect()
    }

    pub(crate) fn doubles(&mut self) -> Result<Doubles<'a>, String> {
        let count = self.u32()? as usize;
        // Writers do not align if no element follows.
        let size = if count == 0 { 1 } else { 8 };
        let bytes = self.take(size, count.saturating_mul(8))?;
        Ok(Doubles { bytes, order: self.order })
    }

    pub(crate) fn end(self) -> Result<(), String> {
        let left = self.body.len() - self.position;
        if left > MOST_PADDING {
            return Err(format!("{left} bytes follow its last field"));
        }
        Ok(())
    }
}

/// A sequence of f64 as a message holds it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Doubles<'a> {
    bytes: &'a [u8],
    order: ByteOrder,
}

impl Doubles<'_> {
    pub(crate) fn len(self) -> usize {
        self.bytes.len() / 8
    }

    pub(crate) fn get(self, index: usize) -> Option<f64> {
        let bytes = self.bytes.chunks_exact(8).nth(index)?.try_into().ok()?;
        Some(match self.order {
            ByteOrder::Big => f64::from_be_bytes(bytes),
            ByteOrder::Little => f64::from_le_bytes(bytes),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Cdr;

    #[test]
    fn both_byte_orders_are_aligned_from_the_end_of_the_header() {
        let little = [0, 1, 0, 0, 7, 0, 0, 0, 2, 0, 0, 0, b'a', 0];
        let big = [0, 0, 0, 0, 7, 0, 0, 0, 0, 0, 0, 2, b'a', 0];
        for message in [&little[..], &big[..]] {
            let mut cdr = Cdr::new(message).unwrap();
            assert_eq!((cdr.byte(), cdr.string()), (Ok(7), Ok("a")));
            assert_eq!(cdr.end(), Ok(()));
        }
        let mut doubles = vec![0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0];
        doubles.extend(f64::to_le_bytes(-0.1));
        let values = Cdr::new(&doubles).unwrap().doubles().unwrap();
        assert_eq!((values.len(), values.get(0), values.get(1)), (1, Some(-0.1), None));
    }

    #[test]
    fn counts_beyond_the_message_are_refused_before_memory_is_taken() {
        let message = [0, 1, 0, 0, 0xff, 0xff, 0xff, 0xff, 0, 0];
        let cdr = Cdr::new(&message).unwrap();
        let expected = "it is cut short: 4294967295 strings are announced, but 2 bytes are left";
        assert_eq!(cdr.clone().strings().unwrap_err(), expected);
        let expected = "it is cut short: a field of 34359738360 bytes starts at byte 12, but the \
                        message has 10";
        assert_eq!(cdr.clone().doubles().unwrap_err(), expected);
        assert!(cdr.clone().string().unwrap_err().contains("4294967295 bytes starts at byte 8"));
    }

    #[test]
    fn other_encodings_are_refused() {
        let refused = |message: &[u8]| Cdr::new(message).unwrap_err();
        assert_eq!(refused(&[0, 1, 0]), "it has 3 bytes, too few for CDR");
        let expected = "its encoding 0x0003 is not plain CDR (0x0000 or 0x0001)";
        assert_eq!(refused(&[0, 3, 0, 0]), expected);
        assert!(refused(&[0x28, 0xb5, 0x2f, 0xfd, 0]).contains("ros2 bag convert"));
        let mut cdr = Cdr::new(&[0, 1, 0, 0, 1, 0, 0, 0, b'a']).unwrap();
        assert_eq!(cdr.string().unwrap_err(), "the string at byte 8 does not end with a zero");
    }
}
