//! A law as bytes: built on one machine, used on another that computes with no doubles.
//!
//! | bytes | content |
//! |---|---|
//! | 4 | `GSLW` |
//! | 1 | version of this layout: 3 |
//! | 1 | which law: `a` an axis, `c` an axis with effects, `e` an estimator, `m` a monitor |
//! | 1 | number system: `f` f32, `q` fixed point |
//! | 1 | 0 |
//! | 4 | length of the image in bytes |
//! | ... | the law's fields, for an axis its identity (4 bytes) first |
//! | 8 | digest of all before, 64-bit FNV-1a: a change of any one byte is found |
//!
//! ```
//! use gimbal_servo::{Config, Fixed, Law};
//!
//! let law = Config::consistent().build::<Fixed>()?;
//! let mut image = [0; Law::<Fixed>::IMAGE_LEN];
//! law.to_image(&mut image)?; // on the host
//! assert_eq!(Law::from_image(&image)?, law); // on the target
//! # Ok::<(), Box<dyn core::error::Error>>(())
//! ```
//!
//! Little-endian. Signals, coefficients, limits, shifts and exponents are 4 bytes; sums of products 4 in f32 and 8 in fixed
//! point; doubles, which only results in SI use, 8; flags 1. The order of the fields is that of the lists `stored!` in
//! the sources; a changed list, or a change of what a field means, is a new version.

use core::fmt;

use crate::digest::Digest;
use crate::law::Law;
use crate::number::Number;
use crate::stored::{Reader, Stored, Writer};
use crate::{effects, estimator, monitor};

const MAGIC: [u8; 4] = *b"GSLW";
const VERSION: u8 = 3;
const HEADER_LEN: usize = 12;
const DIGEST_LEN: usize = 8;

/// Why bytes are not the image of a law, or a buffer cannot take one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum ImageError {
    /// Too few or too many bytes.
    WrongLength {
        /// Length of an image of this law.
        needed: usize,
        /// Length of what was given.
        given: usize,
    },
    /// The bytes do not begin as an image does.
    NotAnImage,
    /// The image has another layout.
    OtherVersion(u8),
    /// The image is of another kind of law.
    OtherLaw,
    /// The law was built for another number system.
    OtherNumberSystem,
    /// The digest does not fit the bytes.
    Damaged,
    /// A value is not finite, or none that a law can have.
    Impossible,
}

impl fmt::Display for ImageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::WrongLength { needed, given } => {
                write!(f, "an image of this law has {needed} bytes, these are {given}")
            }
            Self::NotAnImage => f.write_str("these bytes are not the image of a law: they do not begin with `GSLW`"),
            Self::OtherVersion(version) => {
                write!(f, "the image has layout {version}, this library reads {VERSION}: build the image anew")
            }
            Self::OtherLaw => f.write_str("the image is of another kind of law"),
            Self::OtherNumberSystem => f.write_str("the image was built for the other number system"),
            Self::Damaged => f.write_str("the image is damaged: its digest does not fit"),
            Self::Impossible => f.write_str("the image holds a value that no law has"),
        }
    }
}

impl core::error::Error for ImageError {}

/// Makes a law one that images hold.
macro_rules! has_image {
    ($law:ty, $kind:literal) => {
        impl<N: Number> $law {
            /// Length of an image of this law in bytes.
            pub const IMAGE_LEN: usize = length::<Self>();

            /// Writes the law as an image of `IMAGE_LEN` bytes; `docs/porting.md` shows how a target gets it.
            ///
            /// # Errors
            /// The length of `image` is another.
            pub fn to_image(&self, image: &mut [u8]) -> Result<(), ImageError> {
                write($kind, N::TAG, self, image)
            }

            /// No law: zeros, the place for an image to be read into. It starts nothing and moves nothing.
            pub const BLANK: Self = <Self as Stored>::BLANK;

            /// The law of an image. It steps as the one that the image was made of, bit for bit; nothing here computes
            /// with doubles.
            ///
            /// # Errors
            /// What is wrong with the image, from its length to its last field.
            pub fn from_image(image: &[u8]) -> Result<Self, ImageError> {
                let mut law = Self::BLANK;
                law.read_image(image)?;
                Ok(law)
            }

            /// Likewise in place, in static memory: the law never passes over the stack, which holds it twice in
            /// [`Self::from_image`]. After an error the law is [`Self::BLANK`].
            ///
            /// # Errors
            /// As those of [`Self::from_image`].
            pub fn read_image(&mut self, image: &[u8]) -> Result<(), ImageError> {
                read($kind, N::TAG, image, self)
            }
        }
    };
}

has_image!(Law<N>, b'a');
has_image!(effects::Law<N>, b'c');
has_image!(estimator::Law<N>, b'e');
has_image!(monitor::Law<N>, b'm');

/// Length of an image.
const fn length<T: Stored>() -> usize {
    HEADER_LEN + T::LEN + DIGEST_LEN
}

fn write<T: Stored>(kind: u8, number: u8, law: &T, image: &mut [u8]) -> Result<(), ImageError> {
    check_length::<T>(image)?;
    let [a, b, c, d, ..] = length::<T>().to_le_bytes();
    let mut writer = Writer { rest: image };
    writer.put(&MAGIC);
    writer.put(&[VERSION, kind, number, 0, a, b, c, d]);
    law.store(&mut writer);
    if let Some((content, digest)) = image.split_last_chunk_mut() {
        *digest = digest_of(content);
    }
    Ok(())
}

fn read<T: Stored>(kind: u8, number: u8, image: &[u8], law: &mut T) -> Result<(), ImageError> {
    let read = match content::<T>(kind, number, image) {
        Ok(content) => {
            let mut reader = Reader { rest: content, impossible: false };
            law.load(&mut reader);
            if reader.impossible { Err(ImageError::Impossible) } else { Ok(()) }
        }
        Err(error) => Err(error),
    };
    if read.is_err() {
        *law = T::BLANK;
    }
    read
}

/// What stands between header and digest.
fn content<T: Stored>(kind: u8, number: u8, image: &[u8]) -> Result<&[u8], ImageError> {
    let wrong_length = ImageError::WrongLength { needed: length::<T>(), given: image.len() };
    let ([magic @ .., version, found_kind, found_number, zero, a, b, c, d], _) =
        image.split_first_chunk::<HEADER_LEN>().ok_or(wrong_length)?;
    if *magic != MAGIC {
        return Err(ImageError::NotAnImage);
    }
    if *version != VERSION {
        return Err(ImageError::OtherVersion(*version));
    }
    if *found_kind != kind {
        return Err(ImageError::OtherLaw);
    }
    if *found_number != number {
        return Err(ImageError::OtherNumberSystem);
    }
    check_length::<T>(image)?;
    let (content, digest) = image.split_last_chunk().ok_or(wrong_length)?;
    if *digest != digest_of(content) {
        return Err(ImageError::Damaged);
    }
    if *zero != 0 || u32::from_le_bytes([*a, *b, *c, *d]) as usize != image.len() {
        return Err(ImageError::Impossible);
    }
    Ok(content.get(HEADER_LEN..).unwrap_or_default())
}

fn check_length<T: Stored>(image: &[u8]) -> Result<(), ImageError> {
    let (needed, given) = (length::<T>(), image.len());
    if needed == given { Ok(()) } else { Err(ImageError::WrongLength { needed, given }) }
}

fn digest_of(content: &[u8]) -> [u8; DIGEST_LEN] {
    let mut digest = Digest::default();
    digest.add(content);
    digest.value().to_le_bytes()
}
