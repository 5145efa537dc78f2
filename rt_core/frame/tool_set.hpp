// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/frame/tool.hpp"
#include "rt_core/limits.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tactus
{

class AwakePairs;
struct FrameSetup;

/// Data of a tool that stages of a frame pass to later stages.
struct ToolStatus
{
    bool is_resident{true};
    /// Value for ToolOutput::clear_m; below zero if nothing is known yet.
    double clear_m{0.0};
    /// True if the tool's reach is larger than clear_m in this frame.
    bool exceeds_capacity{false};
    /// True if the tool repeats its last answer in this frame.
    bool rests{false};
};

/// Tools of a frame, their status and outputs. Haptic thread. Cost: linear in the tools and their
/// pairs.
class ToolSet
{
public:
    /// Makes the tools of the set-up, whose models' headers must parse; all are present.
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

    /// Adds a tool, or removes it, with `is_resident` false. It must have no pairs, and starts
    /// without history.
    void renew(std::uint32_t tool, bool is_resident) noexcept TACTUS_NONBLOCKING;

    /// Begins the frame: each present tool takes its sample and moves with objects that carry it.
    /// `period_ns` > 0 is the loop's period. Returns the samples' faults.
    /// - `samples`: one for each tool (asserted).
    [[nodiscard]] FrameFault begin(std::span<const ToolState> samples, const AwakePairs& pairs,
                                   std::int64_t period_ns) noexcept TACTUS_NONBLOCKING;

private:
    std::span<Tool> tools_;
    RigidProxy::Planes* planes_{nullptr}; ///< Scratch memory that all rigid tools share.
    std::array<ToolStatus, kMaxTools> status_{};
    std::array<ToolOutput, kMaxTools> outputs_{};
};

} // namespace tactus
