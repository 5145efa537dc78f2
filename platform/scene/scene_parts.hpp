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

} // namespace tactus::hrtc
