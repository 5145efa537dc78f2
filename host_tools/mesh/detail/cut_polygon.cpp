// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/detail/readers.hpp"
#include "rt_core/math/vec3.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>

/// Ear cutting: a corner with its two neighbours is an ear when the diagonal between them runs
/// inside the polygon or along its edges. Cutting off an ear leaves a polygon with one corner less,
/// and every simple polygon has an ear. In an arrow, a and c are ears, cut by the diagonal from d
/// to b; d is not one, since its diagonal from c to a runs outside, and b is reflex.
///
///             d                 d
///            . .               .|.
///           .   .      =>     . | .
///          .  b  .           .  b  .
///         . .   . .         . .   . .
///         a       c         a       c
///
/// The result is correct if no triangle has the opposite orientation: the polygon is the boundary
/// of all triangles together, so the number of triangles around a point equals the polygon's
/// winding number.
///
/// Positions are in the plane across the polygon's normal, as parts of its extent. A position
/// within the tolerance of a line lies on it. The first attempt has a tolerance that prevents
/// slivers along straight sides, the second has none.
namespace tactus::detail
{

namespace
{

using Place = std::array<double, 2>;

/// Tolerances of doubled areas, as parts of the square of the extent: of the first attempt, and for
/// rounding errors.
constexpr double kStraight = 1e-7;
constexpr double kRounding = 1e-14;

/// Projection of the polygon onto its plane, counter-clockwise, scaled to an extent of 1; empty if
/// it has no area.
std::vector<Place> flatten(std::span<const std::array<double, 3>> corners)
{
    Eigen::AlignedBox3d box;
    for (const auto& corner : corners)
    {
        box.extend(Vec3(corner.data()));
    }
    const double extent = box.sizes().maxCoeff();
    std::vector<Vec3> scaled;
    for (const auto& corner : corners)
    {
        scaled.emplace_back((Vec3(corner.data()) - box.min()) / extent);
    }
    Vec3 normal(0.0, 0.0, 0.0); // Newell's normal: twice the areas of the projections.
    for (std::size_t i = 0; i < scaled.size(); ++i)
    {
        normal += scaled[i].cross(scaled[(i + 1) % scaled.size()]);
    }
    if (!(normal.norm() > kRounding)) // Also true for NaN, from an extent of 0.
    {
        return {};
    }
    normal.normalize();
    const Vec3 u = normal.unitOrthogonal();
    const Vec3 v = normal.cross(u);
    std::vector<Place> flat;
    for (const Vec3& corner : scaled)
    {
        flat.push_back({corner.dot(u), corner.dot(v)});
    }
    return flat;
}

/// Twice the area of the triangle; positive if it is counter-clockwise.
double area_of(const Place& a, const Place& b, const Place& c)
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

double dot_at(const Place& a, const Place& b, const Place& c)
{
    return (b[0] - a[0]) * (c[0] - a[0]) + (b[1] - a[1]) * (c[1] - a[1]);
}

bool fan_covers(const std::vector<Place>& flat, double tolerance)
{
    for (std::size_t i = 2; i < flat.size(); ++i)
    {
        if (!(area_of(flat[0], flat[i - 1], flat[i]) > tolerance))
        {
            return false;
        }
    }
    return true;
}

class EarCutter
{
public:
    EarCutter(const std::vector<Place>& flat, double tolerance)
        : flat_(flat), tolerance_(tolerance), next_(flat.size()), previous_(flat.size())
    {
        for (std::uint32_t i = 0; i < flat.size(); ++i)
        {
            next_[i] = (i + 1) % static_cast<std::uint32_t>(flat.size());
            previous_[next_[i]] = i;
        }
    }

    std::optional<std::vector<CornerTriangle>> cut()
    {
        std::vector<double> quality(flat_.size());
        for (std::uint32_t i = 0; i < flat_.size(); ++i)
        {
            quality[i] = quality_of(i);
        }
        std::vector<CornerTriangle> triangles;
        for (std::size_t left = flat_.size(); left > 3; --left)
        {
            const std::uint32_t ear = best_of(quality, left);
            if (quality[ear] < 0.0)
            {
                return std::nullopt;
            }
            triangles.push_back(triangle_at(ear));
            first_ = next_[ear];
            next_[previous_[ear]] = next_[ear];
            previous_[next_[ear]] = previous_[ear];
            quality[previous_[ear]] = quality_of(previous_[ear]);
            quality[next_[ear]] = quality_of(next_[ear]);
        }
        triangles.push_back(triangle_at(next_[first_]));
        const auto& [a, b, c] = triangles.back();
        return area_of(flat_[a], flat_[b], flat_[c]) < -kRounding
                   ? std::nullopt
                   : std::optional(std::move(triangles));
    }

private:
    /// Quality above that of every ear, for corners without area: they are cut first, since they
    /// block other ears.
    static constexpr double kNoArea = 4.0;
    static constexpr double kNoEar = -1.0;

    [[nodiscard]] CornerTriangle triangle_at(std::uint32_t i) const
    {
        return {previous_[i], i, next_[i]};
    }

    /// Remaining corner of the highest quality; the first of equal ones.
    [[nodiscard]] std::uint32_t best_of(const std::vector<double>& quality, std::size_t left) const
    {
        std::uint32_t best = first_;
        std::uint32_t i = first_;
        for (std::size_t k = 0; k < left; ++k, i = next_[i])
        {
            const bool is_first = quality[i] == quality[best] && i < best;
            best = quality[i] > quality[best] || is_first ? i : best;
        }
        return best;
    }

    /// 1 if c is left of the line from a to b, -1 if right, 0 if c is on the line within the
    /// tolerance.
    [[nodiscard]] int side_of(std::uint32_t a, std::uint32_t b, std::uint32_t c) const
    {
        const double area = area_of(flat_[a], flat_[b], flat_[c]);
        return area > tolerance_ ? 1 : area < -tolerance_ ? -1 : 0;
    }

    /// Height of the ear divided by its longest side, or kNoArea or kNoEar.
    [[nodiscard]] double quality_of(std::uint32_t i) const
    {
        const auto [a, b, c] = triangle_at(i);
        const double area = area_of(flat_[a], flat_[b], flat_[c]);
        if (flat_[a] == flat_[b] || flat_[b] == flat_[c] || flat_[c] == flat_[a] ||
            (std::abs(area) <= kRounding && dot_at(flat_[b], flat_[a], flat_[c]) > 0.0))
        {
            return kNoArea; // A duplicate corner, or a spike.
        }
        if (side_of(a, b, c) <= 0 || !sees(a, c) || !sees(c, a) || is_blocked(a, c))
        {
            return kNoEar;
        }
        const double longest =
            std::max({dot_at(flat_[a], flat_[b], flat_[b]), dot_at(flat_[b], flat_[c], flat_[c]),
                      dot_at(flat_[c], flat_[a], flat_[a])});
        return area / longest;
    }

    /// True if the diagonal leaves `from` into the polygon, or along an edge.
    [[nodiscard]] bool sees(std::uint32_t from, std::uint32_t to) const
    {
        const std::uint32_t before = previous_[from];
        const std::uint32_t after = next_[from];
        const bool left_of_after = side_of(from, after, to) >= 0;
        const bool left_of_before = side_of(before, from, to) >= 0;
        return side_of(before, from, after) > 0 ? left_of_after && left_of_before
                                                : left_of_after || left_of_before;
    }

    /// True if an edge crosses the diagonal from a to c, or a corner lies on it.
    [[nodiscard]] bool is_blocked(std::uint32_t a, std::uint32_t c) const
    {
        for (std::uint32_t u = next_[c]; u != a; u = next_[u])
        {
            const int side = side_of(a, c, u);
            if (side == 0 && flat_[u] != flat_[a] && flat_[u] != flat_[c] &&
                dot_at(flat_[u], flat_[a], flat_[c]) < 0.0)
            {
                return true;
            }
            const std::uint32_t v = next_[u];
            if (v == a || side * side_of(a, c, v) >= 0)
            {
                continue;
            }
            // An end of the diagonal may touch the edge from inside the polygon, that is, from the
            // left.
            const auto [least, most] = std::minmax({side_of(u, v, a), side_of(u, v, c)});
            if (least < 0 && most >= 0)
            {
                return true;
            }
        }
        return false;
    }

    const std::vector<Place>& flat_;
    double tolerance_;
    std::vector<std::uint32_t> next_;     ///< Next remaining corner of each remaining corner.
    std::vector<std::uint32_t> previous_; ///< Previous remaining corner of each remaining corner.
    std::uint32_t first_{0};              ///< One remaining corner.
};

} // namespace

std::optional<std::vector<CornerTriangle>>
cut_polygon(std::span<const std::array<double, 3>> corners)
{
    const std::vector<Place> flat = flatten(corners);
    if (flat.empty())
    {
        return std::nullopt;
    }
    const auto fan = [&]
    {
        std::vector<CornerTriangle> triangles;
        for (std::uint32_t i = 2; i < flat.size(); ++i)
        {
            triangles.push_back({0, i - 1, i});
        }
        return triangles;
    };
    if (fan_covers(flat, kStraight))
    {
        return fan();
    }
    if (auto cut = EarCutter(flat, kStraight).cut())
    {
        return cut;
    }
    return fan_covers(flat, kRounding) ? fan() : EarCutter(flat, 0.0).cut();
}

} // namespace tactus::detail
