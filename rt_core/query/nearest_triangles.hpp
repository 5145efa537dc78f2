// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/records/local_surface.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>

namespace tactus
{

/// Fills a local surface with the nearest of the given triangles. Their order is kept, so that
/// triangles of one block stay together. If the surface is full, its farthest eighth is dropped.
class NearestTriangles
{
public:
    /// Empties the surface, which must outlive this object.
    explicit NearestTriangles(LocalSurface& surface) noexcept : surface_(surface)
    {
        TACTUS_ASSERT(surface.triangles.size() == surface.distances_m.size());
        TACTUS_ASSERT(surface.triangles.size() <= kMaxLocalTriangles);
        surface.count = 0;
        surface.truncated = false;
    }

    /// Adds a triangle, which the caller writes to the returned place, if it is near enough;
    /// otherwise returns null. `distance_m` >= 0 (asserted) is a lower bound on its distance. Takes
    /// a few nanoseconds, or a pass over the list each time that the surface is full.
    [[nodiscard]] LocalTriangle* add(double distance_m) noexcept
    {
        TACTUS_ASSERT(distance_m >= 0.0);
        if (surface_.count == surface_.triangles.size() && distance_m < dropped_m_)
        {
            drop_farthest();
        }
        if (surface_.count == surface_.triangles.size() || distance_m >= dropped_m_)
        {
            surface_.truncated = true;
            dropped_m_ = std::min(dropped_m_, distance_m);
            return nullptr;
        }
        surface_.distances_m[surface_.count] = distance_m;
        return &surface_.triangles[surface_.count++];
    }

    /// Lower bound on the distance of dropped triangles; infinite if none was dropped.
    [[nodiscard]] double dropped_m() const noexcept { return dropped_m_; }

private:
    /// Drops the farthest eighth of the triangles. Among equally far triangles the first ones stay.
    void drop_farthest() noexcept
    {
        if (surface_.count == 0)
        {
            return;
        }
        const std::uint32_t kept = surface_.count - std::max(surface_.count / 8, 1U);
        const auto listed = surface_.distances_m.first(surface_.count);
        std::array<std::uint16_t, kMaxLocalTriangles> order; // NOLINT(*-member-init): set below.
        const auto nearest_first = std::span(order).first(surface_.count);
        std::iota(nearest_first.begin(), nearest_first.end(), std::uint16_t{0});
        std::ranges::nth_element(nearest_first, nearest_first.begin() + kept,
                                 [listed](std::uint16_t a, std::uint16_t b)
                                 { return listed[a] < listed[b]; });
        const double first_out = listed[nearest_first[kept]];
        auto equals = static_cast<std::uint32_t>(
            kept - std::ranges::count_if(listed, [first_out](double distance_m)
                                         { return distance_m < first_out; }));
        surface_.count = 0;
        for (std::size_t i = 0; i < listed.size(); ++i)
        {
            const bool is_equal = listed[i] == first_out && equals > 0;
            if (listed[i] < first_out || is_equal)
            {
                equals -= is_equal ? 1U : 0U;
                surface_.distances_m[surface_.count] = listed[i];
                surface_.triangles[surface_.count] = surface_.triangles[i];
                ++surface_.count;
            }
        }
        surface_.truncated = true;
        dropped_m_ = std::min(dropped_m_, first_out);
    }

    LocalSurface& surface_;
    double dropped_m_{kInfinity};
};

} // namespace tactus
