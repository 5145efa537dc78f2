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
/// running (preset rtsan). Other compilers read nothing.
#if defined(__has_cpp_attribute) && defined(__clang__)
#if __has_cpp_attribute(clang::nonblocking)
#define TACTUS_NONBLOCKING [[clang::nonblocking]] // NOLINT(cppcoreguidelines-macro-usage)
#endif
#endif
#ifndef TACTUS_NONBLOCKING
#define TACTUS_NONBLOCKING // NOLINT(cppcoreguidelines-macro-usage): nothing where it isn't known.
#endif
