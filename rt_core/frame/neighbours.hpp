// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/frame/frame_parts.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/scene/broad_phase.hpp"

#include <array>
#include <cstdint>
#include <utility>

namespace tactus
{

/// Pairs each tool with its nearby objects until pairs run out. To all other objects the tool keeps
/// a proven clearance (ToolStatus::clear_m).
///
/// A pair lasts as long as its object is on the tool's list (BroadPhase) and among the nearest that
/// pairs are enough for. An object that was out of a tool's sight may have come round it: a pair
/// begins apart, without a force, unless both were proven apart in the last frame by more than the
/// two have moved since. Haptic thread.
class Neighbours
{
public:
    Neighbours(Arena& arena, const FrameSetup& setup) noexcept;

    /// Changes of the scene, before find(). The object has come or moved.
    void place(const FrameParts& parts, std::uint32_t object) noexcept TACTUS_NONBLOCKING;
    /// The object stood at `before`: tools without a pair of it may have been leapt by.
    void look_for_leap(FrameParts& parts, std::uint32_t object,
                       const ObjectPose& before) noexcept TACTUS_NONBLOCKING;
    /// The object goes: its pairs end.
    void remove(FrameParts& parts, std::uint32_t object) noexcept TACTUS_NONBLOCKING;
    /// The tool comes or goes: its pairs end, and nothing is known of what is near it.
    void forget(FrameParts& parts, std::uint32_t tool) noexcept TACTUS_NONBLOCKING;

    /// The pairs of this frame, and the clearances to all else; after the tools have begun.
    void find(FrameParts& parts, FrameAccount& account) noexcept TACTUS_NONBLOCKING;

private:
    /// Metres, then a number of the tool and the object.
    using Nearness = std::pair<double, std::uint32_t>;
    /// Farther than anything: there is room for all.
    static constexpr Nearness kNothing{kInfinity, 0xFFFF'FFFFU};

    void look(const FrameParts& parts) noexcept;
    [[nodiscard]] Nearness first_left_out(const FrameParts& parts) const noexcept;
    [[nodiscard]] Nearness nearness(const FrameParts& parts, std::uint32_t tool,
                                    std::uint32_t object) const noexcept;
    void pair_up(FrameParts& parts, const Nearness& first_out) const noexcept;
    void begin_pair(FrameParts& parts, std::uint32_t tool, std::uint32_t object) const noexcept;
    [[nodiscard]] bool begins_apart(const FrameParts& parts, std::uint32_t tool,
                                    std::uint32_t object) const noexcept;
    void find_clearances(FrameParts& parts, const Nearness& first_out,
                         FrameAccount& account) noexcept;

    BroadPhase broad_;
    std::uint32_t paired_lists_{0}; ///< BroadPhase::lists() that all are pairs of; 0: not all.
    /// By tool: the farthest way in this frame of an object that it has no pair of.
    std::array<double, kMaxTools> leap_m_{};
    bool has_guests_{false};
};

} // namespace tactus
