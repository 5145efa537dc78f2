// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <string_view>

namespace tactus::hrtc
{

class HapticLoop;

/// Installs the process's assertion handler; called once at start-up. While no AssertionBrake
/// exists, a failed assertion is printed and ends the process with kExitFailed.
void install_assertion_brake() noexcept;

/// During its life, an assertion that fails on any thread first brakes the devices of a loop:
///
///     thread      first                           then      who ends the process
///     haptic      fades the forces, then brakes   prints    the main thread
///     main        brakes                          prints    the main thread
///     any other   brakes                          prints    the main thread
///
/// The main thread is the one that made this object; it finishes the recording before it calls
/// end_process(). The failed thread never continues. It ends the process itself if the main thread
/// has not done so within kMainPatience, for instance because its stderr is not read.
///
/// The failed thread prints the line once the devices are braked. The line is lost only if stderr
/// accepts nothing for kPrintPatience.
class AssertionBrake
{
public:
    /// Call it on the main thread, before any other thread uses `loop`.
    explicit AssertionBrake(HapticLoop& loop) noexcept;
    AssertionBrake(const AssertionBrake&) = delete;
    AssertionBrake& operator=(const AssertionBrake&) = delete;
    /// After this, the loop may be destroyed. Ends the process if an assertion has failed.
    ~AssertionBrake();

    /// Any thread: true if an assertion has failed. The devices are braked or about to be.
    [[nodiscard]] static bool has_failed() noexcept;

    /// Main thread: waits until the failure is printed and the devices had time to brake, then ends
    /// the process with kExitFailed. Prints `advice` as one line before; empty: no line.
    [[noreturn]] static void end_process(std::string_view advice = {}) noexcept;
};

} // namespace tactus::hrtc
