// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/believed_motion.hpp"

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

double carried_m(const Similarity& from, const Similarity& to, const Vec3& touch_m) noexcept
{
    return (to.to_there(from.to_here(touch_m)) - touch_m).norm();
}

} // namespace tactus
