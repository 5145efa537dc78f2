// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

/// Marks a function that the haptic thread runs: it neither allocates nor locks, waits, throws,
/// logs or calls the system, and calls only what is marked, too. It stands behind the parameters
/// and noexcept, and is part of the function's type: a pointer to it must be marked as well.
///
///     void refit(Work& work) noexcept TACTUS_NONBLOCKING;
///
/// clang 20 and later hold it: -Wfunction-effects when compiling, and the realtime sanitizer when
/// running (preset rtsan). Other compilers read nothing. Only what other sources call needs the
/// mark: of functions whose body it sees, ours, the standard library's or Eigen's, clang finds out
/// by itself. It can't for calls through a pointer: hand algorithms a lambda, not a function.
///
/// TACTUS_TRUSTED_BEGIN and _END stand around a function that calls what has no mark but keeps its
/// promise, with the reason beside it. rt_core has one: libccd's answer on convex bodies.
// NOLINTBEGIN(cppcoreguidelines-macro-usage): attributes and pragmas, which functions can't be.
#if defined(__has_cpp_attribute) && defined(__clang__)
#if __has_cpp_attribute(clang::nonblocking)
#define TACTUS_NONBLOCKING [[clang::nonblocking]]
#define TACTUS_TRUSTED_BEGIN                                                                       \
    _Pragma("clang diagnostic push") _Pragma("clang diagnostic ignored \"-Wfunction-effects\"")
#define TACTUS_TRUSTED_END _Pragma("clang diagnostic pop")
#endif
#endif
#ifndef TACTUS_NONBLOCKING // Nothing where it isn't known.
#define TACTUS_NONBLOCKING
#define TACTUS_TRUSTED_BEGIN
#define TACTUS_TRUSTED_END
#endif
// NOLINTEND(cppcoreguidelines-macro-usage)
