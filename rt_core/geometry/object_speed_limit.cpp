// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/object_speed_limit.hpp"

#include <cmath>

namespace tactus
{

Similarity between(const Similarity& from, const Similarity& to, double share) noexcept
{
    Similarity place;
    place.translation_m = from.translation_m + share * (to.translation_m - from.translation_m);
    place.scale = from.scale + share * (to.scale - from.scale);
    const Eigen::Quaterniond first(from.rotation);
    const Eigen::Quaterniond last(to.rotation);
    const double side = first.dot(last) < 0.0 ? -1.0 : 1.0;
    const Eigen::Quaterniond turned((1.0 - share) * first.coeffs() + share * side * last.coeffs());
    place.rotation = turned.normalized().toRotationMatrix();
    return place;
}

/// Sum of three displacements: of the centre, by the growth of the scale, and by the rotation, as
/// the chord of its angle. The chord is the norm of the rotations' difference over sqrt(2).
double way_in_sphere_m(const Similarity& from, const Similarity& to, const Vec3& center_m,
                       double radius_m) noexcept
{
    const double way_m = (to.local_to_world(from.world_to_local(center_m)) - center_m).norm();
    const double grown = std::abs(to.scale / from.scale - 1.0);
    const double turned =
        from.rotation == to.rotation ? 0.0 : (to.rotation - from.rotation).norm() * std::sqrt(0.5);
    return way_m + radius_m * (grown + turned);
}

} // namespace tactus
