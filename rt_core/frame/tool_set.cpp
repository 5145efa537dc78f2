// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/tool_set.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/frame/awake_pairs.hpp"
#include "rt_core/frame/frame_setup.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

/// Returns the tool's specification; for a mesh with origin and extent from its model's header.
[[nodiscard]] ToolSpec described(const ToolSpec& tool, const FrameSetup& setup) noexcept
{
    ToolSpec spec = tool;
    if (auto* mesh = std::get_if<MeshCore>(&spec.core); mesh != nullptr)
    {
        const ModelHeader header =
            ModelHeader::parse(setup.models[mesh->model.value].header).value();
        const auto& extent = header.fields().extent_quanta;
        const auto quantum_m = static_cast<double>(header.quantum_m());
        mesh->origin_m = header.origin_m();
        mesh->extent_m = quantum_m * Vec3(extent[0], extent[1], extent[2]);
    }
    return spec;
}

} // namespace

ToolSet::ToolSet(Arena& arena, const FrameSetup& setup) noexcept
    : tools_(arena.take<Tool>(setup.tools.size()))
    , planes_(arena
                  .take<RigidProxy::Planes>(
                      std::ranges::any_of(setup.tools, &Tool::is_held_as_rigid) ? 1 : 0)
                  .data())
{
    for (std::size_t i = 0; i < setup.tools.size() && !arena.is_measuring(); ++i)
    {
        tools_[i] = Tool(described(setup.tools[i], setup), planes_);
    }
}

void ToolSet::renew(std::uint32_t tool, bool is_resident) noexcept
{
    TACTUS_ASSERT(tool < tools_.size());
    status_[tool] = {is_resident};
    tools_[tool] = Tool(tools_[tool].spec(), planes_);
}

FrameFault ToolSet::begin(std::span<const ToolState> samples, const AwakePairs& pairs,
                          std::int64_t period_ns) noexcept
{
    TACTUS_ASSERT(samples.size() == tools_.size());
    const double period_s = static_cast<double>(period_ns) * 1e-9;
    FrameFault faults = FrameFault::none;
    for (std::uint32_t i = 0; i < samples.size(); ++i)
    {
        if (!status_[i].is_resident)
        {
            continue;
        }
        StaticVector<NearObject, kMaxNear> near;
        for (Pair* pair : pairs.of(i))
        {
            if (!pair->has_moved())
            {
                pair->clear_velocities();
            }
            else if (pair->is_joined())
            {
                near.push_back(pair->near());
            }
        }
        // Objects at rest are added, as moved objects may carry the tool past them.
        if (!near.empty())
        {
            for (Pair* pair : pairs.of(i))
            {
                if (!pair->has_moved() && pair->is_joined())
                {
                    near.push_back(pair->near());
                }
            }
        }
        faults |= tools_[i].begin(samples[i], period_s, near.view());
    }
    return faults;
}

} // namespace tactus
