// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/scene/common_places.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tactus
{

namespace
{

/// Distance, in steps along each axis, below which vertices of different files count as the same
/// vertex.
constexpr double kApart = 0.5;

std::uint64_t cell_of(const Vec3& steps)
{
    std::uint64_t cell = 0;
    for (const double x : steps)
    {
        cell ^= std::bit_cast<std::uint64_t>(std::floor(x) + 0.0); // -0 becomes 0.
        cell *= 0x9E37'79B9'7F4A'7C15U;
        cell ^= cell >> 29U;
    }
    return cell;
}

Vec3 rounded(const Vec3& steps)
{
    return (steps.array() + 0.5).floor().matrix();
}

} // namespace

/// Index of the first vertex less than kApart from `steps`, or the number of vertices if there is
/// none.
std::size_t CommonPlaces::first_near(const Vec3& steps) const
{
    std::size_t first = vertices_.size();
    const Vec3 low = (steps.array() - kApart).floor().matrix();
    const Vec3 high = (steps.array() + kApart).floor().matrix();
    for (double x = low.x(); x <= high.x(); x += 1.0)
    {
        for (double y = low.y(); y <= high.y(); y += 1.0)
        {
            for (double z = low.z(); z <= high.z(); z += 1.0)
            {
                const auto [begin, end] = of_cell_.equal_range(cell_of(Vec3(x, y, z)));
                for (auto at = begin; at != end; ++at)
                {
                    if ((vertices_[at->second] - steps).cwiseAbs().maxCoeff() < kApart)
                    {
                        first = std::min(first, std::size_t{at->second});
                    }
                }
            }
        }
    }
    return first;
}

double CommonPlaces::settle(TriangleMesh& mesh, const Vec3& grid_place_m,
                            std::span<const Eigen::AlignedBox3d> boxes)
{
    double farthest = 0.0;
    for (auto& position : mesh.positions)
    {
        const Vec3 at_m(position.data());
        if (std::ranges::none_of(boxes, [&](const auto& box) { return box.contains(at_m); }))
        {
            continue;
        }
        const Vec3 steps = (at_m - grid_place_m) / step_m_;
        const std::size_t first = first_near(steps);
        if (first == vertices_.size())
        {
            of_cell_.emplace(cell_of(steps), static_cast<std::uint32_t>(first));
            vertices_.push_back(steps);
            continue;
        }
        const Vec3 place = rounded(vertices_[first]);
        if (place != rounded(steps))
        {
            farthest = std::max(farthest, (place - steps).norm());
            Eigen::Map<Vec3>(position.data()) = grid_place_m + step_m_ * place;
        }
    }
    return farthest * step_m_;
}

} // namespace tactus
