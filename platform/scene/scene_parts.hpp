// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/tool_port.hpp"
#include "rt_core/records/frame_input.hpp"
#include "transport/served_model.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::hrtc
{

/// What a controller has of a scene, as it stands at the start. The spans are lent.
struct SceneParts
{
    std::span<const ServedModel> models;
    std::span<const ObjectSpec> objects; ///< Object i has the number i.
    std::span<const ToolSetup> tools;
    /// For each model the number of the first object that shows it; that of no object where none
    /// does.
    std::vector<std::uint32_t> first_objects;
    std::size_t objects_max{0}; ///< Places for objects.
};

/// Whether a tool has the model's shape.
[[nodiscard]] bool is_of_tool(std::span<const ToolSetup> tools, std::size_t model) noexcept;

} // namespace tactus::hrtc
