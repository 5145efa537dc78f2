// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"
#include "transport/pose.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

// Any thread, but not the haptic one: it allocates, and works on its own data alone.
namespace tactus
{

/// Which models of a scene have vertices in common where their objects stand: tiles of one ground,
/// parts of one assembly. On grids of their own the two sides of such a border are rounded apart.
class SharedGrids
{
    struct Corner
    {
        std::uint64_t place{0}; ///< A hash of the place in the world, the rotation and the scale.
        std::uint32_t model{0};
        std::int32_t step_log2{0}; ///< Places within 2 to this power metres count as one.

        friend auto operator<=>(const Corner&, const Corner&) = default;
    };

public:
    /// Where there are more corners, those with lower hashes are kept, of all models alike.
    static constexpr std::size_t kCornersMax = std::size_t{1} << 23U;
    static constexpr std::size_t kCornerBytes = sizeof(Corner);

    explicit SharedGrids(std::size_t models, std::size_t corners_max = kCornersMax);

    /// An object shows the model, whose mesh this is. Linear in its vertices.
    void add(std::size_t model, const Pose& pose, const TriangleMesh& mesh);

    /// For each model the first of those that it meets, directly or by way of others; itself where
    /// it meets none. Two models meet when two of their vertices or more are in the same places and
    /// their objects are turned and scaled alike: else no grid fits both.
    [[nodiscard]] std::vector<std::size_t> first_of_each();

private:
    void sort_corners();
    void thin_out();

    std::size_t models_;
    std::size_t corners_max_;
    std::vector<Corner> corners_;
    std::uint64_t kept_{~std::uint64_t{0}}; ///< Corners with hashes up to this one.
};

/// The place in an object's frame where the world's origin lies: grids through it are one grid in
/// the world for all objects that are turned and scaled alike.
[[nodiscard]] std::array<double, 3> world_origin_in(const Pose& pose);

} // namespace tactus
