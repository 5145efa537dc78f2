// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/frame/awake_pairs.hpp"
#include "rt_core/frame/frame_setup.hpp"
#include "rt_core/frame/tool.hpp"
#include "rt_core/limits.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tactus
{

/// A tool's part in a frame: what one stage finds of it and a later one needs.
struct ToolStatus
{
    bool is_here{true};
    double clear_m{0.0};    ///< ToolOutput::clear_m, or below zero where nothing is known yet.
    bool is_crowded{false}; ///< In this frame the tool asks for more than clear_m.
    bool rests{false};      ///< In this frame the tool answers as in the last one.
};

/// A frame's tools, which of them are here, and their outputs. Haptic thread.
class ToolSet
{
public:
    /// The tools of the set-up, whose headers parse; all are here.
    ToolSet(Arena& arena, const FrameSetup& setup) noexcept;

    [[nodiscard]] std::uint32_t size() const noexcept
    {
        return static_cast<std::uint32_t>(tools_.size());
    }
    [[nodiscard]] Tool& operator[](std::uint32_t tool) noexcept { return tools_[tool]; }
    [[nodiscard]] const Tool& operator[](std::uint32_t tool) const noexcept { return tools_[tool]; }
    [[nodiscard]] ToolStatus& status(std::uint32_t tool) noexcept { return status_[tool]; }
    [[nodiscard]] const ToolStatus& status(std::uint32_t tool) const noexcept
    {
        return status_[tool];
    }
    /// The last frame's, until the force stage replaces them.
    [[nodiscard]] std::span<ToolOutput> outputs() noexcept
    {
        return std::span(outputs_).first(tools_.size());
    }
    [[nodiscard]] std::span<const ToolOutput> outputs() const noexcept
    {
        return std::span(outputs_).first(tools_.size());
    }

    /// The tool comes or goes. Its pairs have ended, and it knows nothing of what was before.
    void renew(std::uint32_t tool, bool is_here) noexcept TACTUS_NONBLOCKING;

    /// The frame begins: each tool that is here takes its sample and goes where the objects that
    /// have moved carry it. `period_ns` > 0 is the loop's. Returns what is wrong with the samples.
    /// - `samples`: one for each tool (asserted).
    [[nodiscard]] FrameFault begin(std::span<const ToolState> samples, const AwakePairs& pairs,
                                   std::int64_t period_ns) noexcept TACTUS_NONBLOCKING;

private:
    std::span<Tool> tools_;
    RigidProxy::Planes* planes_{nullptr}; ///< Of all tools that are held as bodies.
    std::array<ToolStatus, kMaxTools> status_{};
    std::array<ToolOutput, kMaxTools> outputs_{};
};

} // namespace tactus
