// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/records/local_surface.hpp"

#include <algorithm>
#include <utility>

namespace tactus
{

/// Fills a local surface with the nearest that it is given, as many as it has room for: a heap once
/// there are that many.
class NearestTriangles
{
public:
    /// Empties the surface, which outlives this.
    explicit NearestTriangles(LocalSurface& surface) noexcept : surface_(surface)
    {
        TACTUS_ASSERT(surface.triangles.size() == surface.distances_m.size());
        surface.count = 0;
        surface.truncated = false;
    }

    /// `distance_m` is a lower bound and not negative.
    void add(const LocalTriangle& triangle, double distance_m) noexcept
    {
        TACTUS_ASSERT(distance_m >= 0.0);
        if (surface_.count < surface_.triangles.size())
        {
            put(surface_.count++, triangle, distance_m);
            return;
        }
        if (!surface_.truncated)
        {
            surface_.truncated = true;
            for (std::uint32_t i = surface_.count / 2; i-- > 0;)
            {
                sift_down(i);
            }
        }
        const double farthest = surface_.count > 0 ? surface_.distances_m[0] : 0.0;
        dropped_m_ = std::min(dropped_m_, std::max(distance_m, farthest));
        if (distance_m < farthest)
        {
            put(0, triangle, distance_m);
            sift_down(0);
        }
    }

    /// Triangles that had no room are at least this far away.
    [[nodiscard]] double dropped_m() const noexcept { return dropped_m_; }

private:
    void put(std::uint32_t at, const LocalTriangle& triangle, double distance_m) const noexcept
    {
        surface_.distances_m[at] = distance_m;
        surface_.triangles[at] = triangle;
    }

    void sift_down(std::uint32_t at) const noexcept
    {
        for (;;)
        {
            std::uint32_t largest = at;
            for (const std::uint32_t child : {2 * at + 1, 2 * at + 2})
            {
                if (child < surface_.count &&
                    surface_.distances_m[child] > surface_.distances_m[largest])
                {
                    largest = child;
                }
            }
            if (largest == at)
            {
                return;
            }
            std::swap(surface_.distances_m[at], surface_.distances_m[largest]);
            std::swap(surface_.triangles[at], surface_.triangles[largest]);
            at = largest;
        }
    }

    LocalSurface& surface_;
    double dropped_m_{kInfinity};
};

} // namespace tactus
