// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/tool_port.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/pose.hpp"
#include "transport/served_model.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

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

/// Similarity of a server's pose. The quaternion must not be zero but may have any length; the
/// rotation is orthonormal to 2e-15.
[[nodiscard]] Similarity to_similarity(const Pose& pose);

/// Pose at `place` of an object of the model with this header and its revision.
[[nodiscard]] ObjectPose object_pose(const Similarity& place, const ModelHeader& header);

} // namespace tactus::hrtc
