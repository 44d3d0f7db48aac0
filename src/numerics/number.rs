//! Arithmetic for formulas that are written once and run on a number, or on all numbers of a vector register at a time.

use pulp::Simd;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number, or numbers side by side that are treated alike.
pub trait Number:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// Answer to a question, for each number.
    type Answer: Copy;

    /// A constant, side by side as often as this number.
    fn constant(self, value: f64) -> Self;
    /// The square root.
    fn root(self) -> Self;
    /// Whether it is less than the other.
    fn is_less(self, other: Self) -> Self::Answer;
    /// Whether it is at most as large as the other.
    fn is_at_most(self, other: Self) -> Self::Answer;
    /// Whether both hold.
    fn both(one: Self::Answer, other: Self::Answer) -> Self::Answer;
    /// Takes the first where the answer is yes, otherwise the second.
    fn choose(answer: Self::Answer, yes: Self, no: Self) -> Self;
}

impl Number for f64 {
    type Answer = bool;

    #[inline(always)]
    fn constant(self, value: f64) -> f64 {
        value
    }
    #[inline(always)]
    fn root(self) -> f64 {
        self.sqrt()
    }
    #[inline(always)]
    fn is_less(self, other: f64) -> bool {
        self < other
    }
    #[inline(always)]
    fn is_at_most(self, other: f64) -> bool {
        self <= other
    }
    #[inline(always)]
    fn both(one: bool, other: bool) -> bool {
        one && other
    }
    #[inline(always)]
    fn choose(answer: bool, yes: f64, no: f64) -> f64 {
        if answer { yes } else { no }
    }
}

/// The numbers of a vector register.
#[derive(Clone, Copy)]
pub struct Register<S: Simd> {
    simd: S,
    /// The numbers.
    pub values: S::f64s,
}

impl<S: Simd> Register<S> {
    /// Register that holds these numbers.
    #[inline(always)]
    pub fn new(simd: S, values: S::f64s) -> Register<S> {
        Register { simd, values }
    }
}

macro_rules! operation {
    ($trait:ident, $function:ident, $instruction:ident) => {
        impl<S: Simd> $trait for Register<S> {
            type Output = Register<S>;

            #[inline(always)]
            fn $function(self, other: Register<S>) -> Register<S> {
                Register::new(self.simd, self.simd.$instruction(self.values, other.values))
            }
        }
    };
}

operation!(Add, add, add_f64s);
operation!(Sub, sub, sub_f64s);
operation!(Mul, mul, mul_f64s);
operation!(Div, div, div_f64s);

impl<S: Simd> Neg for Register<S> {
    type Output = Register<S>;

    #[inline(always)]
    fn neg(self) -> Register<S> {
        Register::new(self.simd, self.simd.neg_f64s(self.values))
    }
}

/// The answers for the numbers of a register.
#[derive(Clone, Copy)]
pub struct Answers<S: Simd> {
    simd: S,
    mask: S::m64s,
}

impl<S: Simd> Number for Register<S> {
    type Answer = Answers<S>;

    #[inline(always)]
    fn constant(self, value: f64) -> Register<S> {
        Register::new(self.simd, self.simd.splat_f64s(value))
    }
    #[inline(always)]
    fn root(self) -> Register<S> {
        Register::new(self.simd, self.simd.sqrt_f64s(self.values))
    }
    #[inline(always)]
    fn is_less(self, other: Register<S>) -> Answers<S> {
        let simd = self.simd;
        Answers {
            simd,
            mask: simd.less_than_f64s(self.values, other.values),
        }
    }
    #[inline(always)]
    fn is_at_most(self, other: Register<S>) -> Answers<S> {
        let simd = self.simd;
        Answers {
            simd,
            mask: simd.less_than_or_equal_f64s(self.values, other.values),
        }
    }
    #[inline(always)]
    fn both(one: Answers<S>, other: Answers<S>) -> Answers<S> {
        let simd = one.simd;
        Answers {
            simd,
            mask: simd.and_m64s(one.mask, other.mask),
        }
    }
    #[inline(always)]
    fn choose(answer: Answers<S>, yes: Register<S>, no: Register<S>) -> Register<S> {
        let simd = answer.simd;
        Register::new(simd, simd.select_f64s(answer.mask, yes.values, no.values))
    }
}
