//! Batches by the widest registers that the processor has, chosen when the program runs.
//!
//! A program that is built without `-C target-cpu` runs on every x86-64, and its lanes fill registers of 128 bits. Here it
//! takes AVX-512, or AVX2 with FMA, where it finds them, and otherwise what it was compiled for. On other processors that
//! is always so.
//!
//! States, inputs and rates are blocks: of each the numbers of eight runs in double precision ([`f64x8`]) or sixteen in
//! single precision ([`f32x16`]) lie side by side. The model is that of such lanes, so that its parameters may differ from
//! run to run too.
//!
//! ```
//! use mbg_runtime::batch::Instructions;
//! use mbg_runtime::lanes::{f64x8, pack, unpack};
//! use mbg_runtime::mbg;
//! use nalgebra::SVector;
//!
//! mbg! {
//!     /// A mass on a spring.
//!     model Oscillator {
//!         param stiffness: N/m = 2.0;
//!         1 junction {
//!             I body { inertia: 1.0 }
//!             C spring { stiffness: stiffness }
//!         }
//!     }
//! }
//!
//! let model = Oscillator::<f64x8>::new(OscillatorParameters::default()).unwrap();
//! let runs: Vec<_> = (0..40).map(|run| SVector::from([f64::from(run), 1.0])).collect();
//! let states: Vec<SVector<f64x8, 2>> = runs.chunks(8).map(pack).collect();
//! let mut rates = states.clone();
//! Instructions::widest().derivatives(&model, 0.0, &states, &[], &mut rates);
//! assert_eq!(unpack(&rates[4], 7), SVector::from([-2.0, 39.0]));
//! ```
//!
//! # Which models
//!
//! The whole derivative is inlined into one function that has the instructions. That is done where it is straight-line code
//! ([`Convertible::STRAIGHT`]) of at most [`LARGEST`] operations; other models take what the program was compiled for, and
//! [`Instructions::for_model`] says so.
//!
//! # Rounding
//!
//! AVX2 and AVX-512 round once where a model multiplies and adds, as [`Real::multiply_add`] does
//! in a program that is compiled for them ([`FUSED`](crate::FUSED)); so results may differ in their last digits from one
//! processor to another. With the feature `reproducible` they never do.

#[cfg(target_arch = "x86_64")]
mod registers;

use core::fmt;

#[cfg(target_arch = "x86_64")]
use fearless_simd::{
    Level,
    x86::{Avx2, Avx512},
};
use nalgebra::SVector;
#[cfg(target_arch = "x86_64")]
use registers::{Proven, Registers, vectorised};

use crate::lanes::{Lanes, f32x16, f64x8};
use crate::{Convertible, Real, System};

/// Operations of the largest derivative that instructions are chosen for. Each set of them is a function that holds the whole
/// derivative, and functions of more operations take long to compile.
pub const LARGEST: usize = 2000;

/// Lanes that fill the widest registers there are, 64 bytes.
pub trait Block: Lanes {
    /// What holds a part of them.
    #[cfg(target_arch = "x86_64")]
    #[doc(hidden)]
    type Part<S: Proven>: Registers<Self>;
}

#[cfg(target_arch = "x86_64")]
impl Block for f64x8 {
    type Part<S: Proven> = registers::Doubles<S>;
}

#[cfg(target_arch = "x86_64")]
impl Block for f32x16 {
    type Part<S: Proven> = registers::Singles<S>;
}

#[cfg(not(target_arch = "x86_64"))]
impl Block for f64x8 {}

#[cfg(not(target_arch = "x86_64"))]
impl Block for f32x16 {}

/// Instructions by which a batch is evaluated. The processor has them.
#[derive(Clone, Copy, Debug)]
pub struct Instructions(Set);

#[derive(Clone, Copy, Debug)]
enum Set {
    Compiled,
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
    #[cfg(target_arch = "x86_64")]
    Avx512(Avx512),
}

impl Instructions {
    /// Those that the program is compiled for.
    pub const COMPILED: Self = Self(Set::Compiled);

    /// Those with the widest registers. The processor is asked at the first call; keep them nonetheless.
    #[must_use]
    pub fn widest() -> Self {
        Self::available().last().unwrap_or(Self::COMPILED)
    }

    /// All that this processor has, the widest last.
    pub fn available() -> impl Iterator<Item = Self> {
        #[cfg(target_arch = "x86_64")]
        let chosen = {
            let level = Level::new();
            let avx2 = level.as_avx2().map(Set::Avx2);
            [avx2, level.as_avx512().map(Set::Avx512)]
        };
        #[cfg(not(target_arch = "x86_64"))]
        let chosen: [Option<Set>; 0] = [];
        let sets = chosen.into_iter().flatten();
        core::iter::once(Set::Compiled).chain(sets).map(Self)
    }

    /// What [`derivatives`](Self::derivatives) takes for a model: these, or those that the program is compiled for.
    #[must_use]
    pub fn for_model<L, S, const N: usize, const M: usize, const P: usize>(self, _model: &S) -> Self
    where
        L: Block,
        S: Convertible<L, N, M, P>,
    {
        if const { S::STRAIGHT && S::META.operations.derivative <= LARGEST } {
            self
        } else {
            Self::COMPILED
        }
    }

    /// Writes the rates of a batch at one time, block by block. Where there are fewer inputs than states, the last is that
    /// of the rest; without any all are zero. States without a place for their rates are left out.
    pub fn derivatives<L, S, const N: usize, const M: usize, const P: usize>(
        self,
        model: &S,
        t: L::Lane,
        states: &[SVector<L, N>],
        inputs: &[SVector<L, M>],
        rates: &mut [SVector<L, N>],
    ) where
        L: Block,
        S: Convertible<L, N, M, P, Memory = ()>,
    {
        let t = L::from_lanes(|_| t);
        if const { S::STRAIGHT && S::META.operations.derivative <= LARGEST } {
            match self.0 {
                Set::Compiled => {}
                #[cfg(target_arch = "x86_64")]
                Set::Avx2(set) => {
                    return chosen(set, model, t, states, inputs, rates);
                }
                #[cfg(target_arch = "x86_64")]
                Set::Avx512(set) => {
                    return chosen(set, model, t, states, inputs, rates);
                }
            }
        }
        for (number, (x, rates)) in states.iter().zip(rates).enumerate() {
            let zero = SVector::from_element(L::from_f64(0.0));
            let u = inputs.get(number).or(inputs.last()).unwrap_or(&zero);
            model.derivative_into(t, x, u, &mut (), rates);
        }
    }
}

impl fmt::Display for Instructions {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self.0 {
            Set::Compiled => "compiled",
            #[cfg(target_arch = "x86_64")]
            Set::Avx2(_) => "AVX2",
            #[cfg(target_arch = "x86_64")]
            Set::Avx512(_) => "AVX-512",
        })
    }
}

/// Blocks whose first parts are evaluated before their second ones, so that they are still in the cache.
#[cfg(target_arch = "x86_64")]
const TOGETHER: usize = 8;

/// A batch by instructions chosen when the program runs.
#[cfg(target_arch = "x86_64")]
fn chosen<L, S, X, const N: usize, const M: usize, const P: usize>(
    set: X,
    model: &S,
    t: L,
    states: &[SVector<L, N>],
    inputs: &[SVector<L, M>],
    rates: &mut [SVector<L, N>],
) where
    L: Block,
    S: Convertible<L, N, M, P>,
    X: Proven,
{
    // The attribute is what takes the closure, and with it the derivative, into the function that has the instructions.
    vectorised(
        set,
        #[inline(always)]
        || {
            let together = states.chunks(TOGETHER).zip(rates.chunks_mut(TOGETHER));
            for (chunk, (states, rates)) in together.enumerate() {
                for part in 0..L::Part::<X>::PARTS {
                    let model = model.converted(|number| L::Part::<X>::part(&number, part));
                    let t = L::Part::<X>::part(&t, part);
                    for (place, (x, rates)) in states.iter().zip(&mut *rates).enumerate() {
                        let input = inputs.get(chunk * TOGETHER + place).or(inputs.last());
                        let x = SVector::from_fn(|row, _| L::Part::<X>::part(&x[row], part));
                        let u = SVector::from_fn(|row, _| match input {
                            Some(input) => L::Part::<X>::part(&input[row], part),
                            None => L::Part::<X>::from_f64(0.0),
                        });
                        let mut found = SVector::from_element(L::Part::<X>::from_f64(0.0));
                        model.derivative_into(t, &x, &u, &mut Default::default(), &mut found);
                        for (rate, found) in rates.iter_mut().zip(&found) {
                            found.put(rate, part);
                        }
                    }
                }
            }
        },
    );
}
