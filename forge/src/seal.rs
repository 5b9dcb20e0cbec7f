//! Answers that cannot be read before the diagnosis is committed: `age` with an x25519 key, and SHA-256.

use std::io::{Read, Write};

use age::secrecy::ExposeSecret;
use age::x25519::{Identity, Recipient};
use sha2::{Digest, Sha256};

/// What is wrong with a key or with sealed answers.
#[derive(Debug, thiserror::Error)]
pub enum SealError {
    /// The key file holds no key.
    #[error("no `AGE-SECRET-KEY-1...` line in the key")]
    NoKey,
    /// The recipient is none.
    #[error("not an age recipient: {0}")]
    Recipient(String),
    /// Nothing could be sealed.
    #[error("cannot be sealed: {0}")]
    Seal(String),
    /// The answers do not open with this key.
    #[error("the key does not open the answers: {0}")]
    Open(String),
}

/// A fresh key: the text of the key file, and the recipient that answers are sealed for.
#[must_use]
pub fn fresh_key() -> (String, String) {
    let identity = Identity::generate();
    let recipient = identity.to_public().to_string();
    (format!("# opens the answers sealed for {recipient}\n{}\n", identity.to_string().expose_secret()), recipient)
}

/// Seals bytes for a recipient.
///
/// # Errors
/// No recipient.
pub fn seal(plain: &[u8], recipient: &str) -> Result<Vec<u8>, SealError> {
    let recipient: Recipient = recipient.parse().map_err(|why: &str| SealError::Recipient(why.to_owned()))?;
    let failed = |why: String| SealError::Seal(why);
    let encryptor = age::Encryptor::with_recipients(std::iter::once(&recipient as &dyn age::Recipient))
        .map_err(|why| failed(why.to_string()))?;
    let mut sealed = Vec::new();
    let mut writer = encryptor.wrap_output(&mut sealed).map_err(|why| failed(why.to_string()))?;
    writer.write_all(plain).map_err(|why| failed(why.to_string()))?;
    writer.finish().map_err(|why| failed(why.to_string()))?;
    Ok(sealed)
}

/// Opens sealed bytes with the text of a key file.
///
/// # Errors
/// No key in the text, or the wrong one, or damaged bytes.
pub fn open(sealed: &[u8], key: &str) -> Result<Vec<u8>, SealError> {
    let identity: Identity = key
        .lines()
        .find(|line| line.starts_with("AGE-SECRET-KEY-1"))
        .and_then(|line| line.trim().parse().ok())
        .ok_or(SealError::NoKey)?;
    let failed = |why: String| SealError::Open(why);
    let decryptor = age::Decryptor::new(sealed).map_err(|why| failed(why.to_string()))?;
    let mut reader =
        decryptor.decrypt(std::iter::once(&identity as &dyn age::Identity)).map_err(|why| failed(why.to_string()))?;
    let mut plain = Vec::new();
    reader.read_to_end(&mut plain).map_err(|why| failed(why.to_string()))?;
    Ok(plain)
}

/// SHA-256 as 64 hexadecimal digits.
#[must_use]
pub fn sha256(bytes: &[u8]) -> String {
    hexadecimal(&Sha256::digest(bytes))
}

/// SHA-256 as bytes.
#[must_use]
pub fn sha256_bytes(bytes: &[u8]) -> [u8; 32] {
    Sha256::digest(bytes).into()
}

/// Bytes as hexadecimal digits.
#[must_use]
pub fn hexadecimal(bytes: &[u8]) -> String {
    use std::fmt::Write;
    bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

/// 32 bytes that nobody knows beforehand.
#[must_use]
pub fn fresh_bytes() -> [u8; 32] {
    sha256_bytes(fresh_key().0.as_bytes())
}

/// The seed of a development set: never one that a scoring corpus can have.
#[must_use]
pub fn development_seed(number: u64) -> crate::draw::Seed {
    Sha256::digest(format!("development set {number}")).into()
}
