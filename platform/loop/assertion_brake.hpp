// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/haptic_loop.hpp"

#include <string_view>

namespace tactus::hrtc
{

/// Installs the process's assertion handler; at start-up. While no AssertionBrake lives, a failed
/// assertion is printed and the process ends with kExitFailed.
void install_assertion_brake() noexcept;

/// While it lives, an assertion that fails on any thread brakes the devices of a loop before
/// anything else happens:
///
///     thread      first                           then      who ends the process
///     haptic      fades the forces, then brakes   prints    the main thread
///     main        brakes                          prints    the main thread
///     any other   brakes                          prints    the main thread
///
/// The main thread is the one that made this object; it finishes the recording before it calls
/// end_process(). The thread that failed never goes on. It ends the process itself when the main
/// thread has not done so within kMainPatience: that one may wait for a stderr that nobody reads.
///
/// The line is printed once the devices are braked, by the thread that failed. It is lost only when
/// stderr takes nothing for kPrintPatience.
class AssertionBrake
{
public:
    /// The main thread, before any other thread works for the loop.
    explicit AssertionBrake(HapticLoop& loop) noexcept;
    AssertionBrake(const AssertionBrake&) = delete;
    AssertionBrake& operator=(const AssertionBrake&) = delete;
    /// The loop may be destroyed afterwards. Ends the process when an assertion has failed.
    ~AssertionBrake();

    /// Any thread: whether an assertion has failed. The devices are braked or about to be.
    [[nodiscard]] static bool has_failed() noexcept;

    /// The main thread: waits until what failed is printed and the devices have had the time to
    /// obey, prints `advice` as a line if there is any, and ends the process with kExitFailed.
    [[noreturn]] static void end_process(std::string_view advice = {}) noexcept;
};

} // namespace tactus::hrtc
