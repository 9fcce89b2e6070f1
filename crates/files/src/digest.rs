/// Returns bytes as lower-case hexadecimal digits, two per byte, the usual form of a SHA-256
/// digest.
///
/// # Examples
///
/// ```
/// assert_eq!(reachtube_files::hex(&[0, 171]), "00ab");
/// ```
#[must_use]
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
