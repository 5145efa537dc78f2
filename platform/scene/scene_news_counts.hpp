// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>

namespace tactus::hrtc
{

/// Counts of the scene's changes since the start.
struct SceneNewsCounts
{
    std::uint64_t came{0};  ///< Objects added to the frame.
    std::uint64_t went{0};  ///< Objects removed from the frame.
    std::uint64_t feels{0}; ///< Materials changed in the frame.
    /// Times that the material of an object was limited (limited()).
    std::uint64_t limited{0};
    std::uint64_t passed_over{0};     ///< Objects that can't be touched: no such model, or no room.
    std::uint64_t motion_regained{0}; ///< dds::SceneReader::motion_regained().
};

} // namespace tactus::hrtc
