// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

/// Assertions for bugs: on in every build, through a handler that the program may replace.
/// The haptic thread's handler latches the fault, brakes the device and ends the loop; the default
/// handler stops the process. Input from outside is never checked this way, see base/result.hpp.

namespace tactus
{

/// Handler of a failed assertion. It runs on the thread that failed, maybe the haptic one, and gets
/// the condition's text and source place. If it returns, the assertion traps.
using AssertHandler = void (*)(const char* condition, const char* file, int line) noexcept;

/// Replaces the handler of the whole process and returns the previous one. Null is the default
/// handler, which only traps. Call it at start-up only.
AssertHandler set_assert_handler(AssertHandler handler) noexcept;

/// Calls the handler, then traps; used by TACTUS_ASSERT. Any thread.
[[noreturn]] void assertion_failed(const char* condition, const char* file, int line) noexcept;

} // namespace tactus

// NOLINTNEXTLINE(cppcoreguidelines-macro-usage): it needs the condition's text and place.
#define TACTUS_ASSERT(condition)                                                                   \
    (static_cast<bool>(condition) ? static_cast<void>(0)                                           \
                                  : ::tactus::assertion_failed(#condition, __FILE__, __LINE__))
