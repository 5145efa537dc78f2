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

/// Finds the objects of a scene near its tools, and a lower bound on the distance of all others.
/// Objects are spheres that hold their models; world frame, metres. Tools and objects are given by
/// their numbers, below the capacities.
///
/// A walk over all objects gives a tool a list of near objects and its clearance to the others.
/// Motion of the tool, and objects that approach, reduce the clearance. If it falls below the
/// tool's `near_m`, another walk follows; tools that wait longest come first, at most kBroadWalks a
/// frame. So a tool at rest among objects at rest costs one comparison, for any number of objects
/// (Lipschitz: a distance shrinks by no more than its two ends move).
///
/// Objects are kept in groups of kGroup by their numbers, each with a box: if consecutive numbers
/// are neighbours in space, a walk skips more of them. Haptic thread. A walk over 4,096 objects
/// checks each once; 49 B per object.
class BroadPhase
{
public:
    BroadPhase() noexcept = default;
    BroadPhase(Arena& arena, std::uint32_t objects, std::uint32_t tools) noexcept;

    /// Adds or moves an object.
    void place(std::uint32_t object, const Sphere& sphere) noexcept TACTUS_NONBLOCKING;
    void remove(std::uint32_t object) noexcept TACTUS_NONBLOCKING;

    /// Sets a tool's centre in this frame, and the distance `near_m` >= 0 within which its list
    /// should hold all objects.
    void move_tool(std::uint32_t tool, const Vec3& center_m,
                   double near_m) noexcept TACTUS_NONBLOCKING;
    void forget(std::uint32_t tool) noexcept TACTUS_NONBLOCKING;
    /// Walks for tools whose clearance is used up; called after move_tool() for each tool.
    void walk() noexcept TACTUS_NONBLOCKING;

    /// Objects on the tool's list, by their numbers, always including the nearest of its last walk;
    /// at most kMaxNear.
    [[nodiscard]] std::span<const std::uint32_t> near(std::uint32_t tool) const noexcept
    {
        return tools_[tool].near.view();
    }
    /// Proven distance of the tool's centre from the sphere of every object that is not listed;
    /// infinite if there is none, below zero if nothing is known yet.
    [[nodiscard]] double clear_m(std::uint32_t tool) const noexcept { return tools_[tool].clear_m; }
    /// Proven distance of the tool's centre from the sphere of one object.
    [[nodiscard]] double gap_m(std::uint32_t tool,
                               std::uint32_t object) const noexcept TACTUS_NONBLOCKING;

    /// Number, above 0, that changes with every change of a list.
    [[nodiscard]] std::uint32_t lists() const noexcept { return lists_; }
    [[nodiscard]] std::uint32_t objects() const noexcept { return count_; }
    /// Walks since the last move_tool(); below, objects that they checked.
    [[nodiscard]] std::uint32_t walks() const noexcept { return walks_; }
    [[nodiscard]] std::uint32_t looked_at() const noexcept { return looked_at_; }

private:
    static constexpr std::uint32_t kGroup = 64;

    struct Group
    {
        Vec3 low{kInfinity, kInfinity, kInfinity}; ///< Box of the spheres.
        Vec3 high{-kInfinity, -kInfinity, -kInfinity};
        bool is_stale{false}; ///< True if a sphere changed since the box was fitted.
    };
    struct ToolRange
    {
        bool is_resident{false};
        bool was_full{false}; ///< The last walk found more than kMaxNear.
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
    /// Intermediate result of a walk.
    struct Findings
    {
        double wide_m{0.0};        ///< Distance up to which objects are listed.
        std::uint32_t listed{0};   ///< Number of listed objects, in scratch_.
        Candidate next{kInfinity}; ///< Nearest unlisted object.
        double after_m{kInfinity}; ///< Lower bound on the gaps of further objects.
    };

    [[nodiscard]] bool lacks_proof(const ToolRange& tool) const noexcept;
    [[nodiscard]] bool needs_walk(const ToolRange& tool) const noexcept;
    void walk(ToolRange& tool) noexcept;
    void search(const Group& group, std::uint32_t first, const ToolRange& tool,
                Findings& found) noexcept;
    void keep_nearest(ToolRange& tool, Findings& found) noexcept;
    void fit(Group& group, std::uint32_t first) noexcept;

    std::span<Sphere> spheres_; ///< Radius below zero: no object.
    std::span<Group> groups_;
    std::span<Candidate> scratch_; ///< One per object.
    std::array<ToolRange, kMaxTools> tools_{};
    std::uint32_t tool_count_{0};
    std::uint32_t count_{0};
    std::uint32_t lists_{1};
    std::uint32_t walks_{0};
    std::uint32_t looked_at_{0};
};

} // namespace tactus
