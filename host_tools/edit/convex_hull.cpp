// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/edit/exact_shapes.hpp"
#include "rt_core/math/orientation.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

namespace tactus
{

namespace
{

using HullFacet = std::array<std::uint32_t, 3>;

/// Hull that grows point by point, the farthest points first.
class GrowingHull
{
public:
    GrowingHull(std::span<const Vec3> points, double margin) : points_(points), margin_(margin) {}

    [[nodiscard]] Polyhedron grown()
    {
        if (!start())
        {
            return {};
        }
        for (const std::uint32_t point : farthest_first())
        {
            add(point);
        }
        return compact();
    }

private:
    struct Plane
    {
        HullFacet corners;
        Vec3 normal; ///< Unit length; zero if the facet has no area.
    };

    [[nodiscard]] Plane plane_of(const HullFacet& corners) const
    {
        const Vec3& a = points_[corners[0]];
        const Vec3 normal = (points_[corners[1]] - a).cross(points_[corners[2]] - a);
        const double length = normal.norm();
        return {corners, length > 0.0 ? Vec3(normal / length) : Vec3(0.0, 0.0, 0.0)};
    }

    template <typename Measure>
    [[nodiscard]] std::uint32_t largest(const Measure& measure) const
    {
        std::uint32_t best = 0;
        for (std::uint32_t i = 1; i < points_.size(); ++i)
        {
            best = measure(points_[i]) > measure(points_[best]) ? i : best;
        }
        return best;
    }

    /// A tetrahedron of points far apart; false if all points lie within the margin of a plane.
    [[nodiscard]] bool start()
    {
        if (points_.size() < 4)
        {
            return false;
        }
        const std::uint32_t a = largest([&](const Vec3& p) { return (p - points_[0]).norm(); });
        const std::uint32_t b = largest([&](const Vec3& p) { return (p - points_[a]).norm(); });
        const Vec3 axis = (points_[b] - points_[a]).normalized();
        const std::uint32_t c =
            largest([&](const Vec3& p) { return (p - points_[a]).cross(axis).norm(); });
        const Vec3 normal = axis.cross(points_[c] - points_[a]).normalized();
        const std::uint32_t d =
            largest([&](const Vec3& p) { return std::abs((p - points_[a]).dot(normal)); });
        if (!(std::abs((points_[d] - points_[a]).dot(normal)) > margin_))
        {
            return false;
        }
        const int side = side_of_plane(points_[a], points_[b], points_[c], points_[d]);
        if (side == 0)
        {
            return false;
        }
        const HullFacet base = side > 0 ? HullFacet{a, c, b} : HullFacet{a, b, c};
        facets_.push_back(plane_of(base));
        for (std::size_t i = 0; i < 3; ++i)
        {
            facets_.push_back(plane_of({base[(i + 1) % 3], base[i], d}));
        }
        first_ = {a, b, c, d};
        return true;
    }

    [[nodiscard]] std::vector<std::uint32_t> farthest_first() const
    {
        Vec3 middle(0.0, 0.0, 0.0);
        for (const Vec3& point : points_)
        {
            middle += point / static_cast<double>(points_.size());
        }
        std::vector<std::uint32_t> order;
        for (std::uint32_t i = 0; i < points_.size(); ++i)
        {
            if (std::find(first_.begin(), first_.end(), i) == first_.end())
            {
                order.push_back(i);
            }
        }
        std::stable_sort(order.begin(), order.end(),
                         [&](std::uint32_t i, std::uint32_t k)
                         { return (points_[i] - middle).norm() > (points_[k] - middle).norm(); });
        return order;
    }

    void add(std::uint32_t point)
    {
        const Vec3& at = points_[point];
        double height = 0.0;
        for (const Plane& facet : facets_)
        {
            height = std::max(height, facet.normal.dot(at - points_[facet.corners[0]]));
        }
        if (height <= margin_)
        {
            return;
        }
        std::vector<HullFacet> seen;
        std::erase_if(facets_,
                      [&](const Plane& facet)
                      {
                          const auto& [a, b, c] = facet.corners;
                          const bool is_seen =
                              side_of_plane(points_[a], points_[b], points_[c], at) > 0;
                          if (is_seen)
                          {
                              seen.push_back(facet.corners);
                          }
                          return is_seen;
                      });
        const auto has_edge = [&](std::uint32_t from, std::uint32_t to)
        {
            return std::any_of(seen.begin(), seen.end(),
                               [&](const HullFacet& facet)
                               {
                                   return (facet[0] == from && facet[1] == to) ||
                                          (facet[1] == from && facet[2] == to) ||
                                          (facet[2] == from && facet[0] == to);
                               });
        };
        for (const HullFacet& facet : seen)
        {
            for (std::size_t i = 0; i < 3; ++i)
            {
                const std::uint32_t from = facet[i];
                const std::uint32_t to = facet[(i + 1) % 3];
                if (!has_edge(to, from))
                {
                    facets_.push_back(plane_of({from, to, point}));
                }
            }
        }
    }

    [[nodiscard]] Polyhedron compact() const
    {
        Polyhedron hull;
        std::vector<std::optional<std::uint32_t>> places(points_.size());
        for (const Plane& facet : facets_)
        {
            HullFacet corners{};
            for (std::size_t i = 0; i < 3; ++i)
            {
                auto& place = places[facet.corners[i]];
                if (!place)
                {
                    place = static_cast<std::uint32_t>(hull.vertices.size());
                    hull.vertices.push_back(points_[facet.corners[i]]);
                }
                corners[i] = *place;
            }
            hull.facets.push_back(corners);
        }
        return hull;
    }

    std::span<const Vec3> points_;
    double margin_;
    std::vector<Plane> facets_;
    std::array<std::uint32_t, 4> first_{};
};

} // namespace

Polyhedron convex_hull(std::span<const Vec3> points, double margin)
{
    return GrowingHull(points, margin).grown();
}

} // namespace tactus
