// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/telemetry_tap.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/base/static_vector.hpp"

#include <algorithm>
#include <cstddef>

namespace tactus::hrtc
{

namespace
{

/// Largest gap between tool and touched object. A gap arises because pairs are measured at the
/// proxy's place before the frame, and forces at its new place.
constexpr double kTouchSlack_m = 1e-3;
/// Largest number of touched objects; others get no push. At most three planes hold a proxy, so
/// only corners touch more objects.
constexpr std::size_t kMaxTouched = 8;
constexpr int kRounds = 32;

struct Touched
{
    std::size_t pair{0};
    Vec3 inward{0.0, 0.0, 0.0}; ///< Direction from the tool into the object, of length 1.
    double push_n{0.0};
};

using TouchedList = StaticVector<Touched, kMaxTouched>;

/// Unit normal into the object at the nearest point; the push's direction if tool and surface
/// coincide.
Vec3 inward_of(const PairOutput& pair, const Vec3& push_n) noexcept
{
    const Vec3 way_m = pair.nearest_point_m - pair.point_m;
    const double length_m = way_m.norm();
    return length_m > kTouchSlack_m * 1e-3 ? Vec3(way_m / length_m) : Vec3(push_n.normalized());
}

/// Sets the pushes so that their sum is nearest to `push_n`: least squares without negative pushes,
/// one push at a time (Gauss and Seidel).
void fit(TouchedList& touched, const Vec3& push_n) noexcept
{
    Vec3 left_n = push_n;
    for (int round = 0; round < kRounds; ++round)
    {
        for (Touched& each : touched)
        {
            const double better_n = std::max(each.push_n + each.inward.dot(left_n), 0.0);
            left_n -= (better_n - each.push_n) * each.inward;
            each.push_n = better_n;
        }
    }
}

} // namespace

void share_push(std::span<const PairOutput> pairs, double radius_m, const Vec3& push_n,
                std::span<Vec3> pushes_n) noexcept
{
    TACTUS_ASSERT(pushes_n.size() == pairs.size());
    std::ranges::fill(pushes_n, Vec3(0.0, 0.0, 0.0));
    if (pairs.empty() || push_n == Vec3(0.0, 0.0, 0.0))
    {
        return;
    }
    TouchedList touched;
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i)
    {
        nearest = pairs[i].upper_m < pairs[nearest].upper_m ? i : nearest;
        const Vec3 inward = inward_of(pairs[i], push_n);
        if (pairs[i].upper_m <= radius_m + kTouchSlack_m && inward.dot(push_n) > 0.0)
        {
            static_cast<void>(touched.try_push_back({i, inward}));
        }
    }
    fit(touched, push_n);
    double sum_n = 0.0;
    Vec3 explained_n(0.0, 0.0, 0.0);
    for (const Touched& each : touched)
    {
        sum_n += each.push_n;
        explained_n += each.push_n * each.inward;
    }
    if (!(sum_n > 0.0))
    {
        pushes_n[nearest] = push_n;
        return;
    }
    const Vec3 left_n = push_n - explained_n;
    for (const Touched& each : touched)
    {
        pushes_n[each.pair] = each.push_n * each.inward + (each.push_n / sum_n) * left_n;
    }
}

} // namespace tactus::hrtc
