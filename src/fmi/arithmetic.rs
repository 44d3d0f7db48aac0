//! The floating-point environment of a call. A host may have unmasked exceptions (`feenableexcept`, Fortran's `-ffpe-trap`),
//! chosen another rounding, or set subnormal numbers to zero. A call computes in the environment that the language takes for
//! granted, and leaves the host's as it was, the flags of past exceptions included.

#![allow(unsafe_code)]

/// The environment of the host, which comes back when this is dropped.
pub struct HostEnvironment(hardware::Control);

impl HostEnvironment {
    /// Puts the host's environment aside: no traps, rounding to nearest, subnormal numbers as they are.
    pub fn put_aside() -> HostEnvironment {
        HostEnvironment(hardware::put_aside())
    }
}

impl Drop for HostEnvironment {
    fn drop(&mut self) {
        hardware::restore(&self.0);
    }
}

/// MXCSR, which the arithmetic of the compiler uses, and the registers of the x87, which the mathematical functions of some C
/// libraries use (on Windows).
#[cfg(target_arch = "x86_64")]
mod hardware {
    use std::arch::asm;

    /// All exceptions masked, rounding to nearest, no flag set.
    static DEFAULT_MXCSR: u32 = 0x1f80;
    /// Default control word of the x87, with 64 bits of significand.
    static DEFAULT_X87: u16 = 0x037f;

    /// Floating-point environment that the host had.
    pub struct Control {
        mxcsr: u32,
        /// Only where the host's control word is not the default one: it takes as long as a small call.
        x87: Option<[u32; 7]>,
    }

    pub fn put_aside() -> Control {
        let (mut mxcsr, mut word) = (0_u32, 0_u16);
        // SAFETY: stores to and loads from variables of the right size.
        unsafe {
            asm!(
                "stmxcsr [{mxcsr}]", "fnstcw [{word}]", "ldmxcsr [{default}]",
                mxcsr = in(reg) &raw mut mxcsr, word = in(reg) &raw mut word, default = in(reg) &raw const DEFAULT_MXCSR,
                options(nostack, preserves_flags),
            );
        }
        let x87 = (word != DEFAULT_X87).then(|| {
            let mut environment = [0_u32; 7];
            // SAFETY: `fnstenv` stores 28 bytes and masks all exceptions, so that none is raised by loading the word.
            unsafe {
                asm!(
                    "fnstenv [{environment}]", "fldcw [{default}]",
                    environment = in(reg) &raw mut environment, default = in(reg) &raw const DEFAULT_X87,
                    options(nostack, preserves_flags),
                );
            }
            environment
        });
        Control { mxcsr, x87 }
    }

    pub fn restore(control: &Control) {
        // SAFETY: what `put_aside` has stored.
        unsafe {
            if let Some(environment) = &control.x87 {
                asm!("fldenv [{environment}]", environment = in(reg) environment, options(nostack, preserves_flags));
            }
            asm!("ldmxcsr [{mxcsr}]", mxcsr = in(reg) &raw const control.mxcsr, options(nostack, preserves_flags));
        }
    }
}

/// FPCR (traps, rounding, flushing) and FPSR (flags).
#[cfg(target_arch = "aarch64")]
mod hardware {
    use std::arch::asm;

    /// Floating-point environment that the host had.
    pub struct Control {
        control: u64,
        status: u64,
    }

    pub fn put_aside() -> Control {
        let (control, status): (u64, u64);
        // SAFETY: moves between registers.
        unsafe {
            asm!(
                "mrs {control}, fpcr", "mrs {status}, fpsr", "msr fpcr, xzr",
                control = out(reg) control, status = out(reg) status,
                options(nomem, nostack, preserves_flags),
            );
        }
        Control { control, status }
    }

    pub fn restore(control: &Control) {
        // SAFETY: what `put_aside` has read.
        unsafe {
            asm!(
                "msr fpsr, {status}", "msr fpcr, {control}",
                control = in(reg) control.control, status = in(reg) control.status,
                options(nomem, nostack, preserves_flags),
            );
        }
    }
}

/// Control of other processors, whose environment is taken as it is.
#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
mod hardware {
    pub struct Control;

    pub fn put_aside() -> Control {
        Control
    }

    pub fn restore(_: &Control) {}
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::*;
    use std::arch::asm;

    fn mxcsr() -> u32 {
        let mut value = 0_u32;
        // SAFETY: a variable of the right size.
        unsafe { asm!("stmxcsr [{}]", in(reg) &raw mut value, options(nostack)) };
        value
    }

    fn x87() -> (u16, u16) {
        let (mut word, mut status) = (0_u16, 0_u16);
        // SAFETY: variables of the right size.
        unsafe { asm!("fnstcw [{}]", "fnstsw [{}]", in(reg) &raw mut word, in(reg) &raw mut status, options(nostack)) };
        (word, status)
    }

    fn set(mxcsr: u32, word: u16) {
        // SAFETY: variables of the right size.
        unsafe {
            asm!("ldmxcsr [{}]", "fldcw [{}]", in(reg) &raw const mxcsr, in(reg) &raw const word, options(nostack))
        };
    }

    #[test]
    fn a_call_has_the_default_environment_and_the_host_gets_its_own_back() {
        let before = (mxcsr(), x87());
        // Divisions by zero, overflow and invalid operations unmasked, in both; rounding upward, subnormal numbers to zero,
        // the flag of an inexact result; 53 bits of significand.
        let host = (0x1f80 & !0x0680 | 0x4000 | 0x8040 | 0x20, 0x027f & !0x000d | 0x0800);
        set(host.0, host.1);
        let seen = {
            let _environment = HostEnvironment::put_aside();
            let seen = (mxcsr(), x87().0);
            // SAFETY: registers of the x87, left as they were; sets its flag of a division by zero.
            unsafe { asm!("fldz", "fld1", "fdivrp st(1), st", "fstp st(0)", options(nostack)) };
            std::hint::black_box(1.0 / std::hint::black_box(0.0));
            seen
        };
        let after = (mxcsr(), x87());
        set(before.0, before.1.0);
        assert_eq!(seen, (0x1f80, 0x037f));
        assert_eq!((after.0, after.1.0), host);
        assert_eq!(after.1.1, before.1.1, "flags of the x87");
    }
}
