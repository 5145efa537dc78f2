// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"

namespace tactus
{

struct FrameAccount;
struct FrameParts;

/// Skips work that would only repeat the last frame's: a whole frame, a tool's answer, or the
/// update of a model. Haptic thread. Cost: linear in the tools, their pairs and the busy models.
class Resting
{
public:
    /// True if this frame would repeat the last one: every stage is skipped, and outputs and faults
    /// stay. Called after the tools have begun, in a scene without changes.
    [[nodiscard]] bool try_rest(const FrameParts& parts,
                                FrameAccount& account) const noexcept TACTUS_NONBLOCKING;

    /// Finds the tools that repeat their last answer (ToolStatus::rests), before the queries.
    static void find_tools(FrameParts& parts, FrameAccount& account) noexcept TACTUS_NONBLOCKING;

    /// Ends the frame: finds whether the next frame may rest, and which models are no longer busy.
    void end_frame(FrameParts& parts) noexcept TACTUS_NONBLOCKING;

private:
    /// True if every tool rested in the last frame, and every busy model was complete.
    bool may_rest_{false};
};

} // namespace tactus
