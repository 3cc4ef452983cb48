//! SIMD lanes: numbers side by side, in whatever form the processor supports.
//!
//! All of the crate's `unsafe` code is here. The instructions of a level may only run on processors that have them. Its
//! types are reached only through [`SimdLevel::run`], for levels that were detected at run time.
#![expect(unsafe_code, reason = "instructions that a processor may lack can only be called so")]

#[cfg(target_arch = "aarch64")]
use std::arch::aarch64::*;
#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::*;

/// Several single-precision numbers, one per lane.
pub(super) trait Lanes: Copy {
    /// The number of lanes.
    const COUNT: usize;
    /// The same number in all lanes.
    fn splat(number: f32) -> Self;
    /// Loads the first numbers of a slice, which must have enough.
    fn load(from: &[f32]) -> Self;
    /// Stores to the first places of a slice, which must have enough.
    fn store(self, to: &mut [f32]);
    fn plus(self, other: Self) -> Self;
    fn minus(self, other: Self) -> Self;
    fn times(self, other: Self) -> Self;
    /// The smaller number of each lane; either where one is NaN.
    fn least(self, other: Self) -> Self;
    /// The larger number of each lane; either where one is NaN.
    fn most(self, other: Self) -> Self;
    /// `self · by + more`, rounded once or twice.
    fn times_plus(self, by: Self, more: Self) -> Self;
    fn size(self) -> Self;
    /// −1 for numbers with the sign of −0, otherwise 1.
    fn sign(self) -> Self;
    /// A bit for each lane in which `self` is less, the first lane's lowest.
    fn less(self, other: Self) -> u32;
    /// `then` in lanes in which `self` is less, `otherwise` in the others.
    fn if_less(self, other: Self, then: Self, otherwise: Self) -> Self;
}

/// The types of a level: one with eight lanes for boxes and triangles, and one with the widest lanes for rays.
pub(super) trait Simd {
    type Eight: Lanes;
    type Many: Lanes;
}

/// A computation on lanes. `run` must always be inlined, so that its instructions are compiled for the level.
pub(super) trait LaneWork {
    type Output;
    fn run<S: Simd>(self) -> Self::Output;
}

/// The instructions for tracing rays. Results are the same on every level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[doc(hidden)]
pub enum SimdLevel {
    /// The instructions that every processor of the architecture has, as the compiler chooses them.
    Plain,
    /// AVX2 and FMA: eight lanes.
    #[cfg(target_arch = "x86_64")]
    Avx2,
    /// AVX-512: sixteen lanes for rays.
    #[cfg(target_arch = "x86_64")]
    Avx512,
    /// NEON: four lanes, used twice.
    #[cfg(target_arch = "aarch64")]
    Neon,
}

impl SimdLevel {
    /// Returns all levels that this processor has, the best one last.
    pub fn all() -> Vec<SimdLevel> {
        let mut all = vec![SimdLevel::Plain];
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            all.push(SimdLevel::Avx2);
            if is_x86_feature_detected!("avx512f") {
                all.push(SimdLevel::Avx512);
            }
        }
        #[cfg(target_arch = "aarch64")]
        if std::arch::is_aarch64_feature_detected!("neon") {
            all.push(SimdLevel::Neon);
        }
        all
    }

    /// The best level.
    pub(super) fn best() -> SimdLevel {
        Self::all().pop().unwrap_or(SimdLevel::Plain)
    }

    #[inline(always)]
    pub(super) fn run<W: LaneWork>(self, work: W) -> W::Output {
        match self {
            SimdLevel::Plain => work.run::<PlainLevel>(),
            // SAFETY: levels other than the plain one only come from `all`, which found their instructions
            #[cfg(target_arch = "x86_64")]
            SimdLevel::Avx2 => unsafe { on_avx2(work) },
            // SAFETY: as before
            #[cfg(target_arch = "x86_64")]
            SimdLevel::Avx512 => unsafe { on_avx512(work) },
            // SAFETY: as before
            #[cfg(target_arch = "aarch64")]
            SimdLevel::Neon => unsafe { on_neon(work) },
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn on_avx2<W: LaneWork>(work: W) -> W::Output {
    work.run::<Avx2Level>()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma,avx512f")]
fn on_avx512<W: LaneWork>(work: W) -> W::Output {
    work.run::<Avx512Level>()
}

#[cfg(target_arch = "aarch64")]
#[target_feature(enable = "neon")]
fn on_neon<W: LaneWork>(work: W) -> W::Output {
    work.run::<NeonLevel>()
}

/// Loops over arrays, which the compiler vectorises with the architecture's baseline instructions.
struct PlainLevel;

impl Simd for PlainLevel {
    type Eight = PlainEight;
    type Many = PlainEight;
}

#[derive(Clone, Copy)]
struct PlainEight([f32; 8]);

impl PlainEight {
    #[inline(always)]
    fn with(self, other: Self, operation: impl Fn(f32, f32) -> f32) -> Self {
        PlainEight(std::array::from_fn(|lane| operation(self.0[lane], other.0[lane])))
    }
}

impl Lanes for PlainEight {
    const COUNT: usize = 8;
    #[inline(always)]
    fn splat(number: f32) -> Self {
        PlainEight([number; 8])
    }
    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        PlainEight(std::array::from_fn(|lane| from[lane]))
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        to[..8].copy_from_slice(&self.0);
    }
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        self.with(other, |one, other| one + other)
    }
    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        self.with(other, |one, other| one - other)
    }
    #[inline(always)]
    fn times(self, other: Self) -> Self {
        self.with(other, |one, other| one * other)
    }
    #[inline(always)]
    fn least(self, other: Self) -> Self {
        self.with(other, |one, other| if one < other { one } else { other })
    }
    #[inline(always)]
    fn most(self, other: Self) -> Self {
        self.with(other, |one, other| if one > other { one } else { other })
    }
    #[inline(always)]
    fn times_plus(self, by: Self, more: Self) -> Self {
        self.times(by).plus(more)
    }
    #[inline(always)]
    fn size(self) -> Self {
        PlainEight(self.0.map(f32::abs))
    }
    #[inline(always)]
    fn sign(self) -> Self {
        PlainEight(self.0.map(|number| 1.0f32.copysign(number)))
    }
    #[inline(always)]
    fn less(self, other: Self) -> u32 {
        (0..8).fold(0, |bits, lane| bits | u32::from(self.0[lane] < other.0[lane]) << lane)
    }
    #[inline(always)]
    fn if_less(self, other: Self, then: Self, otherwise: Self) -> Self {
        let chosen = |lane: usize| if self.0[lane] < other.0[lane] { then.0[lane] } else { otherwise.0[lane] };
        PlainEight(std::array::from_fn(chosen))
    }
}

/// Lane functions that are a single instruction.
#[cfg(target_arch = "x86_64")]
macro_rules! instructions {
    ($($name:ident($($other:ident),*) is $instruction:ident;)*) => {$(
        #[inline(always)]
        fn $name(self, $($other: Self),*) -> Self {
            // SAFETY: the type is only used inside `SimdLevel::run`, at a level that has the instruction
            unsafe { Self($instruction(self.0, $($other.0),*)) }
        }
    )*};
}

#[cfg(target_arch = "x86_64")]
struct Avx2Level;

#[cfg(target_arch = "x86_64")]
impl Simd for Avx2Level {
    type Eight = AvxEight;
    type Many = AvxEight;
}

#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy)]
struct AvxEight(__m256);

#[cfg(target_arch = "x86_64")]
impl Lanes for AvxEight {
    const COUNT: usize = 8;
    #[inline(always)]
    fn splat(number: f32) -> Self {
        // SAFETY: the type is only used inside `SimdLevel::run`, at a level that has the instruction
        unsafe { AvxEight(_mm256_set1_ps(number)) }
    }
    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        let from = &from[..8];
        // SAFETY: the level has the instruction, and the slice has eight numbers
        unsafe { AvxEight(_mm256_loadu_ps(from.as_ptr())) }
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        let to = &mut to[..8];
        // SAFETY: the level has the instruction, and the slice has room for eight numbers
        unsafe { _mm256_storeu_ps(to.as_mut_ptr(), self.0) }
    }
    instructions! {
        plus(other) is _mm256_add_ps;
        minus(other) is _mm256_sub_ps;
        times(other) is _mm256_mul_ps;
        least(other) is _mm256_min_ps;
        most(other) is _mm256_max_ps;
        times_plus(by, more) is _mm256_fmadd_ps;
    }
    #[inline(always)]
    fn size(self) -> Self {
        // SAFETY: the level has the instruction
        unsafe { AvxEight(_mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0)) }
    }
    #[inline(always)]
    fn sign(self) -> Self {
        // SAFETY: the level has the instruction
        unsafe { AvxEight(_mm256_or_ps(_mm256_and_ps(_mm256_set1_ps(-0.0), self.0), _mm256_set1_ps(1.0))) }
    }
    #[inline(always)]
    fn less(self, other: Self) -> u32 {
        // SAFETY: the level has the instruction
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0)) as u32 }
    }
    #[inline(always)]
    fn if_less(self, other: Self, then: Self, otherwise: Self) -> Self {
        // SAFETY: the level has the instruction
        unsafe { AvxEight(_mm256_blendv_ps(otherwise.0, then.0, _mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0))) }
    }
}

#[cfg(target_arch = "x86_64")]
struct Avx512Level;

#[cfg(target_arch = "x86_64")]
impl Simd for Avx512Level {
    type Eight = AvxEight;
    type Many = AvxSixteen;
}

#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy)]
struct AvxSixteen(__m512);

#[cfg(target_arch = "x86_64")]
impl Lanes for AvxSixteen {
    const COUNT: usize = 16;
    #[inline(always)]
    fn splat(number: f32) -> Self {
        // SAFETY: the type is only used inside `SimdLevel::run`, at a level that has the instruction
        unsafe { AvxSixteen(_mm512_set1_ps(number)) }
    }
    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        let from = &from[..16];
        // SAFETY: the level has the instruction, and the slice has sixteen numbers
        unsafe { AvxSixteen(_mm512_loadu_ps(from.as_ptr())) }
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        let to = &mut to[..16];
        // SAFETY: the level has the instruction, and the slice has room for sixteen numbers
        unsafe { _mm512_storeu_ps(to.as_mut_ptr(), self.0) }
    }
    instructions! {
        plus(other) is _mm512_add_ps;
        minus(other) is _mm512_sub_ps;
        times(other) is _mm512_mul_ps;
        least(other) is _mm512_min_ps;
        most(other) is _mm512_max_ps;
        times_plus(by, more) is _mm512_fmadd_ps;
        size() is _mm512_abs_ps;
    }
    #[inline(always)]
    fn sign(self) -> Self {
        // SAFETY: the level has the instruction
        unsafe {
            let sign = _mm512_and_si512(_mm512_castps_si512(self.0), _mm512_set1_epi32(i32::MIN));
            AvxSixteen(_mm512_castsi512_ps(_mm512_or_si512(sign, _mm512_castps_si512(_mm512_set1_ps(1.0)))))
        }
    }
    #[inline(always)]
    fn less(self, other: Self) -> u32 {
        // SAFETY: the level has the instruction
        unsafe { _mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, other.0).into() }
    }
    #[inline(always)]
    fn if_less(self, other: Self, then: Self, otherwise: Self) -> Self {
        // SAFETY: the level has the instruction
        unsafe {
            let less = _mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, other.0);
            AvxSixteen(_mm512_mask_blend_ps(less, otherwise.0, then.0))
        }
    }
}

#[cfg(target_arch = "aarch64")]
struct NeonLevel;

#[cfg(target_arch = "aarch64")]
impl Simd for NeonLevel {
    type Eight = NeonEight;
    type Many = NeonEight;
}

#[cfg(target_arch = "aarch64")]
#[derive(Clone, Copy)]
struct NeonEight(float32x4_t, float32x4_t);

/// Lane functions that are one instruction for each half.
#[cfg(target_arch = "aarch64")]
macro_rules! halves {
    ($($name:ident($($other:ident),*) is $instruction:ident;)*) => {$(
        #[inline(always)]
        fn $name(self, $($other: Self),*) -> Self {
            // SAFETY: the type is only used inside `SimdLevel::run`, at a level that has the instruction
            unsafe { Self($instruction(self.0, $($other.0),*), $instruction(self.1, $($other.1),*)) }
        }
    )*};
}

#[cfg(target_arch = "aarch64")]
impl Lanes for NeonEight {
    const COUNT: usize = 8;
    #[inline(always)]
    fn splat(number: f32) -> Self {
        // SAFETY: the type is only used inside `SimdLevel::run`, at a level that has the instruction
        unsafe { NeonEight(vdupq_n_f32(number), vdupq_n_f32(number)) }
    }
    #[inline(always)]
    fn load(from: &[f32]) -> Self {
        let from = &from[..8];
        // SAFETY: the level has the instruction, and the slice has eight numbers
        unsafe { NeonEight(vld1q_f32(from.as_ptr()), vld1q_f32(from[4..].as_ptr())) }
    }
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        let (one, other) = to[..8].split_at_mut(4);
        // SAFETY: the level has the instruction, and each half has room for four numbers
        unsafe {
            vst1q_f32(one.as_mut_ptr(), self.0);
            vst1q_f32(other.as_mut_ptr(), self.1);
        }
    }
    halves! {
        plus(other) is vaddq_f32;
        minus(other) is vsubq_f32;
        times(other) is vmulq_f32;
        least(other) is vminq_f32;
        most(other) is vmaxq_f32;
        size() is vabsq_f32;
    }
    #[inline(always)]
    fn times_plus(self, by: Self, more: Self) -> Self {
        // SAFETY: the level has the instruction
        unsafe { NeonEight(vfmaq_f32(more.0, self.0, by.0), vfmaq_f32(more.1, self.1, by.1)) }
    }
    #[inline(always)]
    fn sign(self) -> Self {
        // SAFETY: the level has the instruction
        unsafe {
            let (bit, one) = (vdupq_n_u32(1 << 31), vdupq_n_f32(1.0));
            NeonEight(vbslq_f32(bit, self.0, one), vbslq_f32(bit, self.1, one))
        }
    }
    #[inline(always)]
    fn less(self, other: Self) -> u32 {
        const BITS: [u32; 8] = [1, 2, 4, 8, 16, 32, 64, 128];
        // SAFETY: the level has the instruction, and there are four bits from each place that is loaded
        unsafe {
            let one = vandq_u32(vcltq_f32(self.0, other.0), vld1q_u32(BITS.as_ptr()));
            let two = vandq_u32(vcltq_f32(self.1, other.1), vld1q_u32(BITS[4..].as_ptr()));
            vaddvq_u32(vorrq_u32(one, two))
        }
    }
    #[inline(always)]
    fn if_less(self, other: Self, then: Self, otherwise: Self) -> Self {
        // SAFETY: the level has the instruction
        unsafe {
            NeonEight(
                vbslq_f32(vcltq_f32(self.0, other.0), then.0, otherwise.0),
                vbslq_f32(vcltq_f32(self.1, other.1), then.1, otherwise.1),
            )
        }
    }
}
