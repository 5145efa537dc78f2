// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/limits.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace tactus::hrtc
{

/// Default capacity of a scene: objects take about 6 % of the pools, pairs about 8 %.
/// take_shown_scene() raises `objects` to the number at the start.
struct SceneRoom
{
    static constexpr std::size_t kPoolAnObject = std::size_t{4} << 10U;
    static constexpr std::size_t kPoolAPair = std::size_t{64} << 10U;
    static constexpr std::size_t kLeastObjects = 64;
    static constexpr std::size_t kLeastPairs = 16;

    std::uint32_t objects{0}; ///< Capacity for objects, 64 to kMaxObjects.
    std::uint32_t pairs{0};   ///< Capacity for pairs, 16 to kMaxPairs.

    /// Capacity for pools of this size in total.
    [[nodiscard]] static constexpr SceneRoom of(std::size_t pool_bytes) noexcept
    {
        return {static_cast<std::uint32_t>(std::clamp<std::size_t>(pool_bytes / kPoolAnObject,
                                                                   kLeastObjects, kMaxObjects)),
                static_cast<std::uint32_t>(
                    std::clamp<std::size_t>(pool_bytes / kPoolAPair, kLeastPairs, kMaxPairs))};
    }
};

} // namespace tactus::hrtc
