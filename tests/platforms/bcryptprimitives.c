/* For tests under a wine that lacks bcryptprimitives.dll: the one function that Rust's standard library takes from it.
 * Every Windows from 10 on has the DLL; this one is never shipped. tools/platforms.py compiles it. */

#include <windows.h>

/* RtlGenRandom of advapi32 by its exported name. */
BOOLEAN WINAPI SystemFunction036(PVOID buffer, ULONG length);

__declspec(dllexport) BOOL WINAPI ProcessPrng(PBYTE buffer, SIZE_T length) {
    return SystemFunction036(buffer, (ULONG)length);
}
