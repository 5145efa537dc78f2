// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/scene/broad_phase.hpp"

#include <array>
#include <cstdint>
#include <utility>

namespace tactus
{

struct FrameAccount;
struct FrameParts;
struct FrameSetup;
struct ObjectPose;

/// Pairs each tool with the objects near it, nearest first, while pairs are free. The tool keeps a
/// proven clearance from all other objects (ToolStatus::clear_m).
///
/// A pair lasts while its object is on the tool's list (BroadPhase) and among the nearest that free
/// pairs suffice for. An object off the list may have passed through the tool. So a new pair begins
/// apart, without a force, unless the last frame proved a distance larger than the motion of both
/// since. Haptic thread. Cost: linear in the listed objects of all tools; a walk over all objects
/// is more, and a frame has at most kBroadWalks of them.
class Neighbours
{
public:
    Neighbours(Arena& arena, const FrameSetup& setup) noexcept;

    /// Takes over the pose of an added or moved object, before find().
    void place(const FrameParts& parts, std::uint32_t object) noexcept TACTUS_NONBLOCKING;
    /// Handles an object's motion from `before` to its present pose: it may have passed over tools
    /// that have no pair with it.
    void look_for_leap(FrameParts& parts, std::uint32_t object,
                       const ObjectPose& before) noexcept TACTUS_NONBLOCKING;
    /// Removes an object and ends its pairs.
    void remove(FrameParts& parts, std::uint32_t object) noexcept TACTUS_NONBLOCKING;
    /// Ends the pairs of an added or removed tool, and clears its list of near objects.
    void forget(FrameParts& parts, std::uint32_t tool) noexcept TACTUS_NONBLOCKING;

    /// Finds the pairs of this frame and the clearances to all other objects; the tools must have
    /// begun.
    void find(FrameParts& parts, FrameAccount& account) noexcept TACTUS_NONBLOCKING;

private:
    /// Distance in metres, then a unique number of tool and object that orders equal distances.
    using Nearness = std::pair<double, std::uint32_t>;
    /// Nearness farther than any: all pairs fit.
    static constexpr Nearness kNothing{kInfinity, 0xFFFF'FFFFU};

    void update_tools(const FrameParts& parts) noexcept;
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
    /// BroadPhase::lists() at the last frame in which every listed object had a pair; 0: some have
    /// none.
    std::uint32_t paired_lists_{0};
    /// Farthest way, for each tool, of an object without a pair with the tool, within the tool's
    /// reach since the last frame, in m. It bounds how much nearer such an object may be.
    std::array<double, kMaxTools> leap_m_{};
    bool has_streamed_models_{false};
};

} // namespace tactus
