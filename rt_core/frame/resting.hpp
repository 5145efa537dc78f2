// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/frame/frame_parts.hpp"

namespace tactus
{

/// Skips work that would only repeat the last frame: a whole frame, the answer of a tool, the
/// update of a model. Haptic thread.
class Resting
{
public:
    /// True if this frame would repeat the last one, so every stage can be skipped: its outputs and
    /// faults stay. Called after the tools have begun, in a scene without changes.
    [[nodiscard]] bool try_rest(const FrameParts& parts,
                                FrameAccount& account) const noexcept TACTUS_NONBLOCKING;

    /// Finds, before the queries, the tools that answer as in the last frame (ToolStatus::rests).
    static void find_tools(FrameParts& parts, FrameAccount& account) noexcept TACTUS_NONBLOCKING;

    /// Ends the frame: finds whether the next one may rest, and which models do.
    void end_frame(FrameParts& parts) noexcept TACTUS_NONBLOCKING;

private:
    bool may_rest_{false}; ///< Every tool rested in the last frame, and every model is complete.
};

} // namespace tactus
