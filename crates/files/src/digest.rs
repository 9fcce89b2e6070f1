/// Writes bytes as lower-case hexadecimal digits, two per byte, as SHA-256 digests are printed.
#[must_use]
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
