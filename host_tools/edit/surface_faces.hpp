// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/quantised_mesh.hpp"
#include "rt_core/math/triangle.hpp"
#include "rt_core/math/vec3.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

// One thread at a time.
namespace tactus
{

using GridTriangle = std::array<GridPoint, 3>;

/// Hash of a grid point for tables of points.
struct GridPointHash
{
    std::size_t operator()(const GridPoint& point) const noexcept
    {
        std::uint64_t hash = 0;
        for (const std::int32_t value : point)
        {
            hash = (hash ^ static_cast<std::uint32_t>(value)) * 0x9E37'79B9'7F4A'7C15ULL;
            hash ^= hash >> 32U;
        }
        return static_cast<std::size_t>(hash);
    }
};

[[nodiscard]] inline Vec3 to_vec3(const GridPoint& point) noexcept
{
    return {static_cast<double>(point[0]), static_cast<double>(point[1]),
            static_cast<double>(point[2])};
}

/// A box of grid points, with its borders.
struct GridBox
{
    GridPoint low{INT32_MAX, INT32_MAX, INT32_MAX};
    GridPoint high{INT32_MIN, INT32_MIN, INT32_MIN};

    void add(const GridPoint& point) noexcept
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            low[axis] = std::min(low[axis], point[axis]);
            high[axis] = std::max(high[axis], point[axis]);
        }
    }
    [[nodiscard]] bool meets(const GridBox& other) const noexcept
    {
        return low[0] <= other.high[0] && other.low[0] <= high[0] && low[1] <= other.high[1] &&
               other.low[1] <= high[1] && low[2] <= other.high[2] && other.low[2] <= high[2];
    }
};

[[nodiscard]] inline GridBox box_of(const GridTriangle& face) noexcept
{
    GridBox box;
    for (const GridPoint& corner : face)
    {
        box.add(corner);
    }
    return box;
}

/// Largest number of removed points that a face keeps; more let merging drift between them, and
/// take time.
inline constexpr std::size_t kMaxMarks = 12;

/// A face of the present surface.
struct SurfaceFace
{
    GridTriangle corners{};
    std::uint32_t bucket{0}; ///< Meaning as AddedFace::bucket.
    /// Points that merging removed here, in quanta; none of a source face.
    std::vector<Vec3> marks{};
};

/// The faces of a surface by id, found by region in a hierarchical grid: each face is listed in
/// one cell, that of its box's least corner, on the level whose cells are as large as the box.
/// 68 B an id and 4 to 8 B a face that was there at the start.
class SurfaceFaces
{
public:
    /// Room for ids below `ids`, none of them present. `typical_size` is the usual size of a face's
    /// box in quanta, `typical_count` the usual number of faces; both affect speed only.
    SurfaceFaces(std::uint32_t ids, std::uint32_t typical_size, std::uint32_t typical_count);

    [[nodiscard]] std::uint32_t ids() const noexcept
    {
        return static_cast<std::uint32_t>(faces_.size());
    }
    /// Number of faces that are present.
    [[nodiscard]] std::uint32_t count() const noexcept { return count_; }
    [[nodiscard]] bool has(std::uint32_t id) const noexcept { return next_[id] != kAbsent; }
    /// A face that is present.
    [[nodiscard]] const SurfaceFace& operator[](std::uint32_t id) const noexcept
    {
        return faces_[id];
    }
    /// Adds a face that is absent.
    void add(std::uint32_t id, const SurfaceFace& face);
    /// Removes a face that is present.
    void remove(std::uint32_t id);

    /// Ids of the faces whose boxes meet the box, ascending.
    [[nodiscard]] std::vector<std::uint32_t> in_box(const GridBox& box) const;

private:
    static constexpr std::uint32_t kAbsent = 0xFFFF'FFFFU;
    static constexpr std::uint32_t kEnd = 0xFFFF'FFFEU; ///< End of a list.

    struct Cell
    {
        std::uint32_t level{0};
        GridPoint at{};
        bool operator==(const Cell&) const noexcept = default;
    };

    [[nodiscard]] Cell cell_of(const SurfaceFace& face) const noexcept;
    [[nodiscard]] std::size_t list_of(const Cell& cell) const noexcept;

    std::vector<SurfaceFace> faces_;
    std::vector<std::uint32_t> next_; ///< Next face of the same list; kEnd, or kAbsent.
    std::vector<std::uint32_t> lists_;
    std::array<std::uint32_t, 32> level_counts_{};
    std::uint32_t least_level_;
    std::uint32_t count_{0};
};

/// The nearest of several triangles to a point, and its squared distance.
[[nodiscard]] std::pair<std::size_t, double> nearest_of(std::span<const Triangle> faces,
                                                        const Vec3& point);

/// Removes vertices of a part of a surface. A vertex is removed by moving it to a neighbour, so all
/// edges that cancelled before still do, and all vertices stay on the grid. Vertices of `fixed`
/// stay, and those where `faces` don't form one closed fan.
///
/// Tolerance. Errors of successive merges don't add up. Each removed point becomes a mark of the
/// nearest face that replaces it: vertices, and crossings of old with new edges where these are far
/// apart. A removal is allowed if the old and the new faces are at most `slack_quanta` apart, and
/// all marks of the old faces lie within `slack_quanta` of the new ones. So every mark stays within
/// the slack of the surface; points between marks were found up to 1.1 slacks away. A face keeps
/// kMaxMarks marks: the farthest from its plane, and of the others those far from each other.
void merge_pieces(std::vector<SurfaceFace>& faces, std::span<const GridPoint> fixed,
                  double slack_quanta);

} // namespace tactus
