// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/scene/scene_parts.hpp"

#include <algorithm>
#include <variant>

namespace tactus::hrtc
{

bool is_of_tool(std::span<const ToolSetup> tools, std::size_t model) noexcept
{
    return std::ranges::any_of(tools,
                               [model](const ToolSetup& tool)
                               {
                                   const auto* mesh = std::get_if<MeshCore>(&tool.spec.core);
                                   return mesh != nullptr && mesh->model.value == model;
                               });
}

} // namespace tactus::hrtc
