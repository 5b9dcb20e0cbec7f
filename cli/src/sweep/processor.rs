//! The widest vectors of the processor at hand, for batches.

use gimbal_servo::batch::{Baseline, Processor};

/// What wants to know the processor.
pub(crate) trait Work {
    /// What it comes to.
    type Output;
    /// Does it.
    fn on(self, processor: impl Processor) -> Self::Output;
}

/// Does some work with all that this processor can do.
pub(crate) fn on_this<W: Work>(work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    {
        if let Some(processor) = x86_64::Avx512::detect() {
            return work.on(processor);
        }
        if let Some(processor) = x86_64::Avx2::detect() {
            return work.on(processor);
        }
    }
    work.on(Baseline)
}

#[cfg(target_arch = "x86_64")]
#[allow(unsafe_code, reason = "a function for a processor's features may be called where they have been detected")]
pub(crate) mod x86_64 {
    use gimbal_servo::batch::Processor;

    /// Vectors of 512 bits; exists only where they do.
    #[derive(Debug, Clone, Copy)]
    pub(crate) struct Avx512(());

    /// Vectors of 256 bits; exists only where they do.
    #[derive(Debug, Clone, Copy)]
    pub(crate) struct Avx2(());

    impl Avx512 {
        pub(crate) fn detect() -> Option<Self> {
            let here = is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512vl");
            here.then_some(Self(()))
        }
    }

    impl Avx2 {
        pub(crate) fn detect() -> Option<Self> {
            is_x86_feature_detected!("avx2").then_some(Self(()))
        }
    }

    impl Processor for Avx512 {
        fn run<R>(self, work: impl FnOnce() -> R) -> R {
            // SAFETY: `detect` alone makes a value of this type, where the processor has the features.
            unsafe { avx512(work) }
        }
    }

    impl Processor for Avx2 {
        fn run<R>(self, work: impl FnOnce() -> R) -> R {
            // SAFETY: `detect` alone makes a value of this type, where the processor has the feature.
            unsafe { avx2(work) }
        }
    }

    #[inline(never)]
    #[target_feature(enable = "avx512f,avx512dq,avx512vl")]
    fn avx512<R>(work: impl FnOnce() -> R) -> R {
        work()
    }

    #[inline(never)]
    #[target_feature(enable = "avx2")]
    fn avx2<R>(work: impl FnOnce() -> R) -> R {
        work()
    }
}
