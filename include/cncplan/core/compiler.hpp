// What the compiler must be asked for: C++20, and arithmetic as IEC 60559 has it.
#pragma once

#if (defined(_MSVC_LANG) ? _MSVC_LANG : __cplusplus) < 202002L
#error "cncplan needs C++20: compile with -std=c++20 (MSVC: /std:c++20)"
#endif

// Limits may be infinite, errors are found by comparing with NaN, and rounding is carried along in sums.
#if defined(__FAST_MATH__) || defined(_M_FP_FAST) || \
    (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ != 0)
#error "cncplan needs exact arithmetic: compile without -ffast-math and -ffinite-math-only (MSVC: /fp:fast)"
#endif
