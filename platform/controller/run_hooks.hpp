// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace tactus::hrtc
{

/// Gets how many of how many frames are done.
using FramesDone = std::function<void(std::uint64_t done, std::uint64_t all)>;

/// What a session asks of its program and tells it, on the thread that calls the session. Each may
/// be empty.
struct RunHooks
{
    std::function<bool()> is_stopped; ///< Asked for an end.
    /// What gets the progress of a run of this name; it is gone when the loop has ended.
    std::function<FramesDone(const std::string& what)> begin_progress;

    [[nodiscard]] bool goes_on() const { return !is_stopped || !is_stopped(); }
};

} // namespace tactus::hrtc
