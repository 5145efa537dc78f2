// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

/// Assertions for bugs: on in every build, through a handler that the program may replace.
/// The haptic thread's handler latches the fault, brakes the device and ends the loop; the default
/// handler stops the process. Input from outside is never checked this way, see base/result.hpp.

namespace tactus
{

/// Called with the failed condition's text and place, on the thread where it failed, the haptic one
/// too. Must not return to the caller's bug silently: when it does return, the assertion traps.
using AssertHandler = void (*)(const char* condition, const char* file, int line) noexcept;

/// Replaces the handler for the whole process; returns the one before. Null is the default one,
/// which only traps. Call it at start-up only.
AssertHandler set_assert_handler(AssertHandler handler) noexcept;

/// What TACTUS_ASSERT calls: the handler, then a trap. Any thread.
[[noreturn]] void assertion_failed(const char* condition, const char* file, int line) noexcept;

} // namespace tactus

// NOLINTNEXTLINE(cppcoreguidelines-macro-usage): it needs the condition's text and place.
#define TACTUS_ASSERT(condition)                                                                   \
    (static_cast<bool>(condition) ? static_cast<void>(0)                                           \
                                  : ::tactus::assertion_failed(#condition, __FILE__, __LINE__))
