// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/frame/frame_parts.hpp"

namespace tactus
{

/// Leaves out what would only repeat the last frame: all of a frame, the answer of a tool, the care
/// for a model. Haptic thread.
class Resting
{
public:
    /// True if this frame would repeat the last one, so every stage can be skipped: its outputs
    /// stay, and so do its faults. After the tools have begun in a scene without changes.
    [[nodiscard]] bool try_rest(const FrameParts& parts,
                                FrameAccount& account) const noexcept TACTUS_NONBLOCKING;

    /// Before the queries: which tools answer as in the last frame (ToolStatus::rests).
    static void find_tools(FrameParts& parts, FrameAccount& account) noexcept TACTUS_NONBLOCKING;

    /// The frame ends: whether the next one may rest, and which models do.
    void end_frame(FrameParts& parts) noexcept TACTUS_NONBLOCKING;

private:
    bool may_rest_{false}; ///< Every tool rested in the last frame, and every model is complete.
};

} // namespace tactus
