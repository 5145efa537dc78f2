// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/tool_port.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/frame_input.hpp"
#include "transport/served_model.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::hrtc
{

/// Parts of the controller's scene at the start. The spans are borrowed.
struct SceneParts
{
    std::span<const ServedModel> models;
    std::span<const ObjectSpec> objects; ///< Object i has the number i.
    std::span<const ToolSetup> tools;
    /// Number of the first object of each model; the number of objects if there is none.
    std::vector<std::uint32_t> first_objects;
    std::size_t objects_max{0}; ///< Capacity for objects.
};

/// True if the model is the shape of a mesh tool.
[[nodiscard]] bool is_of_tool(std::span<const ToolSetup> tools, std::size_t model) noexcept;

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
