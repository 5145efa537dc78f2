// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

/// Marks a function that the haptic thread runs: it neither allocates nor locks, waits, throws,
/// logs or calls the system, and calls only marked functions. The mark follows the parameters and
/// noexcept and is part of the function's type: a pointer to it must be marked as well.
///
///     void refit(Work& work) noexcept TACTUS_NONBLOCKING;
///
/// clang 20 and later check the mark: -Wfunction-effects when compiling, the realtime sanitizer
/// when running (preset rtsan). Other compilers ignore it. Only functions that other sources call
/// need the mark: clang infers it for functions whose body it sees. It can't for calls through a
/// pointer, so algorithms take lambdas, not functions.
///
/// TACTUS_TRUSTED_BEGIN and _END enclose a function that calls unmarked code but keeps its promise;
/// the reason is beside it. rt_core has one: libccd's answer on convex bodies.
// NOLINTBEGIN(cppcoreguidelines-macro-usage): attributes and pragmas, which functions can't be.
#if defined(__has_cpp_attribute) && defined(__clang__)
#if __has_cpp_attribute(clang::nonblocking)
#define TACTUS_NONBLOCKING [[clang::nonblocking]]
#define TACTUS_TRUSTED_BEGIN                                                                       \
    _Pragma("clang diagnostic push") _Pragma("clang diagnostic ignored \"-Wfunction-effects\"")
#define TACTUS_TRUSTED_END _Pragma("clang diagnostic pop")
#endif
#endif
#ifndef TACTUS_NONBLOCKING // Empty for other compilers.
#define TACTUS_NONBLOCKING
#define TACTUS_TRUSTED_BEGIN
#define TACTUS_TRUSTED_END
#endif
// NOLINTEND(cppcoreguidelines-macro-usage)
