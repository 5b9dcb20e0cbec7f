//! Laws as bytes: what comes back steps bit for bit as what was written, and no bytes at all do harm.

use gimbal_servo::image::ImageError;
use gimbal_servo::{Config, Digest, Fixed, Input, Law, Number, effects, estimator, monitor};
use host_tests::digests::all_effects;
use host_tests::random::Random;
use proptest::prelude::*;

const STEPS: u32 = 3_000;
const CASES: u32 = if cfg!(debug_assertions) { 100 } else { 2_000 };
/// Header and digest of an image.
const HEADER_LEN: usize = 12;
const DIGEST_LEN: usize = 8;

fn image<N: Number>(law: &Law<N>) -> Vec<u8> {
    let mut image = vec![0; Law::<N>::IMAGE_LEN];
    law.to_image(&mut image).unwrap();
    image
}

/// Writes the digest that the bytes before it have.
fn seal(image: &mut [u8]) {
    let (content, digest) = image.split_at_mut(image.len() - DIGEST_LEN);
    let mut proper = Digest::default();
    proper.add(content);
    digest.copy_from_slice(&proper.value().to_le_bytes());
}

/// Through every regime: torques that throw the gyro from stop to stop, and friction.
fn row(k: u32) -> Input<f64> {
    Input {
        accel_x_mps2: f64::from(k % 700) * 0.1,
        accel_y_mps2: 98.0,
        accel_z_mps2: 9.8,
        vehicle_rate_radps: (f64::from(k % 200) - 100.0) * 1e-3,
        torque_nm: [0.035, 0.0, -0.035, 0.0][(k / 300 % 4) as usize],
        spin_rate_radps: 0.2,
    }
}

fn digest<N: Number>(law: &Law<N>) -> u64 {
    let mut state = law.start();
    let mut digest = Digest::default();
    for k in 0..STEPS {
        digest.add_output(&law.step(&mut state, law.units().input(&row(k))));
    }
    digest.add(&law.save(&state));
    for sum in [law.velocity_error_mps(&state), law.position_error_m(&state)].as_flattened() {
        digest.add(&sum.to_bits().to_le_bytes());
    }
    digest.value()
}

/// Back from its image the law is the same to the last bit, in every field and in what it does.
fn comes_back<N: Number>() {
    for config in configs() {
        let law: Law<N> = config.build().unwrap();
        let back = Law::<N>::from_image(&image(&law)).unwrap();
        assert_eq!(back, law);
        assert_eq!(image(&back), image(&law));
        assert_eq!(digest(&back), digest(&law));
        // Saved states go from one to the other.
        assert_eq!(back.restore(&law.save(&law.start())).unwrap(), law.start());
    }
}

fn configs() -> [Config; 4] {
    let mut variant = Config::as_printed();
    variant.gyro.cross_coupling = true;
    variant.interpolation = gimbal_servo::Interpolation::Held;
    variant.period_s = 0.5e-3;
    [Config::consistent(), Config::as_printed(), Config::consistent().without_friction(), variant]
}

#[test]
fn closed_form_a_law_comes_back_from_its_image() {
    comes_back::<f32>();
    comes_back::<Fixed>();
}

fn corrected<N: Number>() -> effects::Law<N> {
    Config::consistent().build_with(&all_effects()).unwrap()
}

fn corrected_image<N: Number>(law: &effects::Law<N>) -> Vec<u8> {
    let mut image = vec![0; effects::Law::<N>::IMAGE_LEN];
    law.to_image(&mut image).unwrap();
    image
}

fn corrected_digest<N: Number>(law: &effects::Law<N>) -> u64 {
    let (mut state, mut digest) = (law.start(), Digest::default());
    for k in 0..STEPS {
        digest.add_output(&law.step(&mut state, law.axis().units().input(&row(k))));
    }
    digest.value()
}

#[test]
fn closed_form_a_law_with_effects_comes_back_from_its_image() {
    fn comes_back<N: Number>() {
        let law = corrected::<N>();
        let bytes = corrected_image(&law);
        let back = effects::Law::<N>::from_image(&bytes).unwrap();
        assert_eq!(back, law);
        assert_eq!(corrected_digest(&back), corrected_digest(&law));
        assert_eq!(Law::<N>::from_image(&bytes).unwrap_err(), ImageError::OtherLaw);
    }
    comes_back::<f32>();
    comes_back::<Fixed>();
}

#[test]
fn closed_form_estimator_and_monitor_come_back_from_their_images() {
    fn come_back<N: Number>() {
        let axis = Config::consistent();
        let law = estimator::Config::default().build::<N>(&axis).unwrap();
        let mut bytes = vec![0; estimator::Law::<N>::IMAGE_LEN];
        law.to_image(&mut bytes).unwrap();
        assert_eq!(estimator::Law::from_image(&bytes).unwrap(), law);
        assert_eq!(monitor::Law::<N>::from_image(&bytes).unwrap_err(), ImageError::OtherLaw);

        let law = monitor::Config::default().build::<N>(&axis, law.gyro_exponent()).unwrap();
        let mut bytes = vec![0; monitor::Law::<N>::IMAGE_LEN];
        law.to_image(&mut bytes).unwrap();
        assert_eq!(monitor::Law::from_image(&bytes).unwrap(), law);
    }
    come_back::<f32>();
    come_back::<Fixed>();
}

/// Any change of one byte is refused, and each kind of damage by its name.
#[test]
fn closed_form_every_damaged_byte_is_found() {
    let law: Law<Fixed> = Config::consistent().build().unwrap();
    let mut bytes = image(&law);
    for place in 0..bytes.len() {
        for bit in [1, 0x80] {
            bytes[place] ^= bit;
            let error = Law::<Fixed>::from_image(&bytes).unwrap_err();
            bytes[place] ^= bit;
            let expected = match place {
                0..4 => ImageError::NotAnImage,
                4 => ImageError::OtherVersion(bytes[place] ^ bit),
                5 => ImageError::OtherLaw,
                6 => ImageError::OtherNumberSystem,
                _ => ImageError::Damaged,
            };
            assert_eq!(error, expected, "byte {place}");
        }
    }
}

#[test]
fn closed_form_each_wrong_image_has_an_error_of_its_own() {
    let law: Law<Fixed> = Config::consistent().build().unwrap();
    let bytes = image(&law);
    let needed = bytes.len();
    let refused = |bytes: &[u8]| Law::<Fixed>::from_image(bytes).unwrap_err();
    for given in [0, 3, 11, 12, 20, needed - 1] {
        assert_eq!(refused(&bytes[..given]), ImageError::WrongLength { needed, given });
    }
    let longer = [bytes.as_slice(), &[0]].concat();
    assert_eq!(refused(&longer), ImageError::WrongLength { needed, given: needed + 1 });
    assert_eq!(law.to_image(&mut [0; 100]).unwrap_err(), ImageError::WrongLength { needed, given: 100 });
    assert_eq!(Law::<f32>::from_image(&bytes).unwrap_err(), ImageError::OtherNumberSystem);
    assert_eq!(estimator::Law::<Fixed>::from_image(&bytes).unwrap_err(), ImageError::OtherLaw);
    let sealed = |place: usize, value: u8| {
        let mut bytes = bytes.clone();
        bytes[place] = value;
        seal(&mut bytes);
        Law::<Fixed>::from_image(&bytes)
    };
    // Reserved, the length, a flag: proper digests do not make them possible.
    for (place, value) in [(7, 1), (8, 0), (HEADER_LEN + 4 + 16, 2)] {
        assert_eq!(sealed(place, value), Err(ImageError::Impossible), "byte {place}");
    }
    // In place, too; and nothing is left of what was there.
    let mut place = law;
    assert_eq!(place.read_image(&bytes[..needed - 1]), Err(ImageError::WrongLength { needed, given: needed - 1 }));
    assert_eq!(place, Law::BLANK);
    place.read_image(&bytes).unwrap();
    assert_eq!(place, law);
    // Another identity is a law of other parameters, and states know it.
    let other = sealed(HEADER_LEN, !bytes[HEADER_LEN]).unwrap();
    assert_eq!(other.restore(&law.save(&law.start())), Err(gimbal_servo::RestoreError::OtherLaw));
    let messages = [
        ImageError::WrongLength { needed, given: 3 },
        ImageError::NotAnImage,
        ImageError::OtherVersion(9),
        ImageError::OtherLaw,
        ImageError::OtherNumberSystem,
        ImageError::Damaged,
        ImageError::Impossible,
    ]
    .map(|error| error.to_string());
    for (i, message) in messages.iter().enumerate() {
        assert!(!messages[..i].contains(message), "{message}");
    }
    assert!(messages[0].contains(&needed.to_string()) && messages[2].contains("layout 9"));
}

/// The layout is part of the version: other lengths are another one.
#[test]
fn regress_lengths_of_images() {
    let lengths = [
        Law::<f32>::IMAGE_LEN,
        Law::<Fixed>::IMAGE_LEN,
        effects::Law::<f32>::IMAGE_LEN,
        effects::Law::<Fixed>::IMAGE_LEN,
        estimator::Law::<f32>::IMAGE_LEN,
        estimator::Law::<Fixed>::IMAGE_LEN,
        monitor::Law::<f32>::IMAGE_LEN,
        monitor::Law::<Fixed>::IMAGE_LEN,
    ];
    assert_eq!(lengths, [4251, 4259, 4424, 4432, 597, 597, 80, 80], "raise the version in src/image.rs");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: CASES, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn closed_form_any_bytes_are_taken_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..6_000)) {
        prop_assert!(Law::<Fixed>::from_image(&bytes).is_err());
        prop_assert!(Law::<f32>::from_image(&bytes).is_err());
    }

    /// Words of a proper image replaced by anything, with a digest that fits: refused, or a law that steps.
    #[test]
    fn closed_form_absurd_laws_step_without_harm(seed in any::<u64>(), words in 1_usize..40) {
        absurd::<Fixed>(seed, words)?;
        absurd::<f32>(seed, words)?;
    }
}

/// A carry near the largest number that there is.
#[test]
fn regress_a_carry_that_overflows() -> Result<(), TestCaseError> {
    absurd::<Fixed>(1_415_099_632_336_493_640, 19)
}

fn absurd<N: Number>(seed: u64, words: usize) -> Result<(), TestCaseError> {
    let bytes = spoilt(image(&Config::consistent().build::<N>().unwrap()), HEADER_LEN, seed, words);
    match Law::<N>::from_image(&bytes) {
        Ok(law) => {
            prop_assert_eq!(image(&law), bytes);
            digest(&law);
        }
        Err(error) => prop_assert_eq!(error, ImageError::Impossible),
    }
    // Of a law with effects, which begins with that of its axis, what comes behind.
    let from = Law::<N>::IMAGE_LEN - DIGEST_LEN;
    let bytes = spoilt(corrected_image(&corrected::<N>()), from, seed, words);
    match effects::Law::<N>::from_image(&bytes) {
        Ok(law) => {
            prop_assert_eq!(corrected_image(&law), bytes);
            corrected_digest(&law);
        }
        Err(error) => prop_assert_eq!(error, ImageError::Impossible),
    }
    Ok(())
}

/// An image whose words from a place on are replaced by anything, sealed.
fn spoilt(mut bytes: Vec<u8>, from: usize, seed: u64, words: usize) -> Vec<u8> {
    let mut random = Random::new(seed);
    let last = bytes.len() - DIGEST_LEN - 4;
    let span = u64::try_from(last - from).unwrap();
    for _ in 0..words {
        let place = from + usize::try_from(random.bits() % span).unwrap();
        let word = random.bits().to_le_bytes();
        bytes[place..place + 4].copy_from_slice(&word[..4]);
    }
    seal(&mut bytes);
    bytes
}
