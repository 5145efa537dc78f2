// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/limits.hpp"
#include "rt_core/math/vec3.hpp"
#include "transport/pose.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

// Any thread except the haptic one: values that allocate.
namespace tactus
{

enum class EditKind : std::uint8_t
{
    carve,    ///< Removes the material that the tool sweeps.
    fill,     ///< Adds material in the tool's sweep.
    displace, ///< Moves the surface in the radius round `from` along the z axis of the tool.
};
inline constexpr std::size_t kEditKinds = 3;

/// Change of a model's surface that a program or a controller asks for: a convex tool moves from
/// one place to another. The tool is all points within `radius_m` of its core.
struct EditRequest
{
    std::array<std::uint8_t, 16> controller{}; ///< GUID of the controller; zeros: the program.
    std::uint64_t server_epoch{0};
    std::uint32_t model{0}; ///< Number of the model on the server.
    std::uint64_t serial{0};
    EditKind kind{EditKind::carve};
    double radius_m{0.0};
    /// Half of a capsule's axis; zero: a sphere, or the hull.
    std::array<double, 3> half_axis_m{};
    std::vector<std::array<double, 3>> hull_m; ///< Vertices of a hull as the core; empty: none.
    /// Places of the tool's frame in the source mesh's frame.
    Pose from;
    Pose to;
    double amount_m{0.0}; ///< Displacement at the middle; 0 for the other kinds.

    bool operator==(const EditRequest&) const = default;
};

/// True if all values are finite and in their ranges: kind, lengths up to kPoseReachMax_m, a core
/// of one kind with a size, poses as in checked_pose(), an amount for a displacement alone.
[[nodiscard]] inline bool is_sound(const EditRequest& request)
{
    const auto is_length = [](double value)
    { return std::abs(value) <= kPoseReachMax_m; }; // False for NaN.
    const auto are_lengths = [&](const std::array<double, 3>& place)
    { return is_length(place[0]) && is_length(place[1]) && is_length(place[2]); };
    bool is_in_ranges = static_cast<std::size_t>(request.kind) < kEditKinds &&
                        is_length(request.radius_m) && request.radius_m >= 0.0 &&
                        are_lengths(request.half_axis_m) && is_length(request.amount_m) &&
                        request.hull_m.size() <= kMaxHullVertices;
    for (const auto& vertex : request.hull_m)
    {
        is_in_ranges = is_in_ranges && are_lengths(vertex);
    }
    const bool has_axis = request.half_axis_m != std::array<double, 3>{};
    const bool has_hull = !request.hull_m.empty();
    const bool has_size = request.radius_m > 0.0 || request.hull_m.size() >= 4;
    return is_in_ranges && !(has_axis && has_hull) && has_size &&
           (request.amount_m != 0.0) == (request.kind == EditKind::displace) &&
           checked_pose(request.from) && checked_pose(request.to);
}

} // namespace tactus
