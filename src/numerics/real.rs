//! Numbers in single or double precision, for methods that are written once and run in both.

use super::dense::Arithmetic;

/// A number in single or double precision.
pub trait Real: Copy + std::fmt::Debug + Default + PartialEq + std::ops::Neg<Output = Self> {
    /// Rounded from double precision.
    fn new(value: f64) -> Self;
    /// In double precision.
    fn double(self) -> f64;
    /// a · b + c.
    fn multiply_add(arithmetic: Arithmetic, a: Self, b: Self, c: Self) -> Self;
    /// Sum.
    fn plus(self, other: Self) -> Self;
    /// Product.
    fn times(self, other: Self) -> Self;
}

macro_rules! real {
    ($type:ident) => {
        impl Real for $type {
            #[inline(always)]
            fn new(value: f64) -> $type {
                value as $type
            }
            #[inline(always)]
            fn double(self) -> f64 {
                f64::from(self)
            }
            #[inline(always)]
            fn multiply_add(arithmetic: Arithmetic, a: $type, b: $type, c: $type) -> $type {
                if arithmetic.is_fused() {
                    a.mul_add(b, c)
                } else {
                    a * b + c
                }
            }
            #[inline(always)]
            fn plus(self, other: $type) -> $type {
                self + other
            }
            #[inline(always)]
            fn times(self, other: $type) -> $type {
                self * other
            }
        }
    };
}

real!(f32);
real!(f64);
