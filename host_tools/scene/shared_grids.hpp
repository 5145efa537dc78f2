// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"
#include "transport/pose.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

// Any thread, except the haptic one: it allocates, and works on its own data alone.
namespace tactus
{

/// Finds models of a scene with common vertices in the poses of their objects: tiles of one ground,
/// parts of one assembly. With separate grids, the two sides of such a border would be rounded
/// differently.
class SharedGrids
{
    struct Corner
    {
        std::uint64_t place{0}; ///< Hash of the place in the world, the rotation and the scale.
        std::uint32_t model{0};
        /// Places are rounded to steps of 2^step_log2 metres; places with the same rounding are
        /// equal.
        std::int32_t step_log2{0};

        friend auto operator<=>(const Corner&, const Corner&) = default;
    };

public:
    /// Maximum number of corners. Above it, those with the lowest hashes are kept; a hash does not
    /// depend on the model.
    static constexpr std::size_t kCornersMax = std::size_t{1} << 23U;
    static constexpr std::size_t kCornerBytes = sizeof(Corner);

    explicit SharedGrids(std::size_t models, std::size_t corners_max = kCornersMax);

    /// Adds an object that shows the model; `mesh` is the mesh of that model. Linear in its
    /// vertices.
    void add(std::size_t model, const Pose& pose, const TriangleMesh& mesh);

    /// First model of each model's group, by model: the models that it meets directly or through
    /// others, and itself. Two models meet if at least two of their vertices coincide and their
    /// objects have the same rotation and scale; otherwise no grid fits both.
    [[nodiscard]] std::vector<std::size_t> first_of_each();

private:
    void sort_corners();
    void thin_out();

    std::size_t models_;
    std::size_t corners_max_;
    std::vector<Corner> corners_;
    std::uint64_t kept_{~std::uint64_t{0}}; ///< Greatest hash of corners that are kept.
};

/// Place of the world's origin in an object's frame: grids through it are one grid in the world for
/// all objects with the same rotation and scale.
[[nodiscard]] std::array<double, 3> world_origin_in(const Pose& pose);

} // namespace tactus
