// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/geometry/placed_core.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/infinity.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tactus
{

/// Which objects of a scene are near its tools, and how far all others are at least. Objects are
/// balls that hold their models; world frame, metres. Both go by their numbers, below the
/// capacities.
///
/// A walk over all objects leaves a tool a list of those near it and its clearance to the rest.
/// That falls with every way of the tool, and with every object that comes nearer; only when it has
/// fallen below what the tool asks for is there another walk, the tools that wait longest first and
/// at most kBroadWalks a frame. So a tool at rest among objects at rest costs a comparison, however
/// many there are (Lipschitz: what a distance loses is no more than what its two ends move).
///
/// Objects are kept in groups of kGroup by their numbers, each with a box: numbers that are
/// neighbours in space let a walk leave out more of them. Haptic thread. A walk over 4,096 objects
/// looks at each once; 49 B an object.
class BroadPhase
{
public:
    BroadPhase() noexcept = default;
    BroadPhase(Arena& arena, std::uint32_t objects, std::uint32_t tools) noexcept;

    /// The object comes, or is somewhere else now.
    void place(std::uint32_t object, const Ball& ball) noexcept TACTUS_NONBLOCKING;
    void remove(std::uint32_t object) noexcept TACTUS_NONBLOCKING;

    /// A tool in this frame: everything is asked for that is within `near_m` >= 0 of its centre.
    void look(std::uint32_t tool, const Vec3& center_m, double near_m) noexcept TACTUS_NONBLOCKING;
    void forget(std::uint32_t tool) noexcept TACTUS_NONBLOCKING;
    /// Walks for tools whose clearance is used up; after each has looked.
    void walk() noexcept TACTUS_NONBLOCKING;

    /// Objects on the tool's list by their numbers, always the nearest of all at its last walk; at
    /// most kMaxNear.
    [[nodiscard]] std::span<const std::uint32_t> near(std::uint32_t tool) const noexcept
    {
        return tools_[tool].near.view();
    }
    /// Proven distance of the tool's centre to the ball of every object that is not on the list;
    /// infinite when there is none, below zero when nothing is known yet.
    [[nodiscard]] double clear_m(std::uint32_t tool) const noexcept { return tools_[tool].clear_m; }
    /// Proven distance of the tool's centre to the ball of one object.
    [[nodiscard]] double gap_m(std::uint32_t tool,
                               std::uint32_t object) const noexcept TACTUS_NONBLOCKING;

    /// Another number, above 0, whenever some tool's list has changed.
    [[nodiscard]] std::uint32_t lists() const noexcept { return lists_; }
    [[nodiscard]] std::uint32_t objects() const noexcept { return count_; }
    /// Since the last look(): walks made, and objects that they looked at.
    [[nodiscard]] std::uint32_t walks() const noexcept { return walks_; }
    [[nodiscard]] std::uint32_t looked_at() const noexcept { return looked_at_; }

private:
    static constexpr std::uint32_t kGroup = 64;

    struct Group
    {
        Vec3 low{kInfinity, kInfinity, kInfinity}; ///< Of the balls' box.
        Vec3 high{-kInfinity, -kInfinity, -kInfinity};
        bool is_stale{false}; ///< A ball has moved or gone.
    };
    struct ToolRange
    {
        bool is_here{false};
        bool was_full{false}; ///< The last walk found more than the list holds.
        std::uint32_t waited{0};
        Vec3 center_m{0.0, 0.0, 0.0};
        double near_m{0.0};
        double clear_m{-kInfinity};
        StaticVector<std::uint32_t, kMaxNear> near;
    };
    struct Candidate
    {
        double gap_m{0.0};
        std::uint32_t object{0};
    };
    /// What a walk has found so far.
    struct Findings
    {
        double wide_m{0.0};        ///< What is within this is listed.
        std::uint32_t listed{0};   ///< In scratch_.
        Candidate next{kInfinity}; ///< The nearest of the others,
        double after_m{kInfinity}; ///< and how far those are that are behind it.
    };

    [[nodiscard]] bool lacks_proof(const ToolRange& tool) const noexcept;
    [[nodiscard]] bool needs_walk(const ToolRange& tool) const noexcept;
    void walk(ToolRange& tool) noexcept;
    void search(const Group& group, std::uint32_t first, const ToolRange& tool,
                Findings& found) noexcept;
    void keep_nearest(ToolRange& tool, Findings& found) noexcept;
    void fit(Group& group, std::uint32_t first) noexcept;

    std::span<Ball> balls_; ///< Of a radius below zero: no object.
    std::span<Group> groups_;
    std::span<Candidate> scratch_; ///< One an object.
    std::array<ToolRange, kMaxTools> tools_{};
    std::uint32_t tool_count_{0};
    std::uint32_t count_{0};
    std::uint32_t lists_{1};
    std::uint32_t walks_{0};
    std::uint32_t looked_at_{0};
};

} // namespace tactus
