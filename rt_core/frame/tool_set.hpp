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

/// State of a tool that one stage of a frame passes to later ones.
struct ToolStatus
{
    bool is_resident{true};
    /// ToolOutput::clear_m, or below zero if nothing is known yet.
    double clear_m{0.0};
    bool exceeds_capacity{false}; ///< The tool needs more than clear_m in this frame.
    /// The tool repeats its last answer in this frame.
    bool rests{false};
};

/// A frame's tools, which of them are present, and their outputs. Haptic thread.
class ToolSet
{
public:
    /// The tools of the set-up, whose headers must parse; all are present.
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
    /// Outputs of the last frame, until the force stage replaces them.
    [[nodiscard]] std::span<ToolOutput> outputs() noexcept
    {
        return std::span(outputs_).first(tools_.size());
    }
    [[nodiscard]] std::span<const ToolOutput> outputs() const noexcept
    {
        return std::span(outputs_).first(tools_.size());
    }

    /// Adds or removes a tool without pairs; it starts without history.
    void renew(std::uint32_t tool, bool is_resident) noexcept TACTUS_NONBLOCKING;

    /// Begins the frame: each present tool takes its sample and moves with the objects that carry
    /// it. `period_ns` > 0 is the loop's. Returns the samples' faults.
    /// - `samples`: one for each tool (asserted).
    [[nodiscard]] FrameFault begin(std::span<const ToolState> samples, const AwakePairs& pairs,
                                   std::int64_t period_ns) noexcept TACTUS_NONBLOCKING;

private:
    std::span<Tool> tools_;
    RigidProxy::Planes* planes_{nullptr}; ///< Shared by all rigid tools.
    std::array<ToolStatus, kMaxTools> status_{};
    std::array<ToolOutput, kMaxTools> outputs_{};
};

} // namespace tactus
