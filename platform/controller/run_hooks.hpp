// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace tactus
{
class EditMailbox;
} // namespace tactus

namespace tactus::hrtc
{

/// Receives the number of finished frames and the number of all frames.
using FramesDone = std::function<void(std::uint64_t done, std::uint64_t all)>;

/// Callbacks of the program, called on the thread that calls the session. Each may be empty.
struct RunHooks
{
    std::function<bool()> is_stopped; ///< Returns true if the run should end.
    /// Begins the progress display of the run `what`. The result is destroyed after the loop's end.
    std::function<FramesDone(const std::string& what)> begin_progress;
    /// True if the run reports its state to a service manager (ServiceNotify).
    bool notifies_manager{false};

    [[nodiscard]] bool goes_on() const { return !is_stopped || !is_stopped(); }
};

class CutTap;

/// Edits of a program's own models. All must outlive the run.
struct ProgramEdits
{
    EditMailbox* mailbox{nullptr}; ///< Null if no model can be edited, or a server does it.
    CutTap* cuts{nullptr};         ///< Null if no tool carves.
};

} // namespace tactus::hrtc
