// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/surface_points.hpp"

#include <Eigen/Geometry>

#include <algorithm>

namespace tactus::test
{

SurfacePoints::SurfacePoints(const std::vector<Face>& faces, std::uint64_t seed)
    : faces_(faces), random_(seed)
{
    double sum = 0.0;
    for (const Face& face : faces)
    {
        const Vec3 a = to_vec3(face[0]);
        sum += 0.5 * (to_vec3(face[1]) - a).cross(to_vec3(face[2]) - a).norm();
        area_up_to_.push_back(sum);
    }
}

std::vector<Vec3> SurfacePoints::draw(std::size_t count)
{
    std::vector<Vec3> points;
    points.reserve(count);
    while (points.size() < count)
    {
        switch (points.size() % 3)
        {
        case 0:
            points.push_back(draw_corner());
            break;
        case 1:
            points.push_back(draw_by_face());
            break;
        default:
            points.push_back(draw_by_area());
            break;
        }
    }
    return points;
}

Vec3 SurfacePoints::draw_by_area()
{
    std::uniform_real_distribution<double> draw(0.0, area_up_to_.back());
    const auto at = std::lower_bound(area_up_to_.begin(), area_up_to_.end(), draw(random_));
    const auto last = static_cast<std::ptrdiff_t>(faces_.size()) - 1;
    return point_of(static_cast<std::size_t>(std::min(at - area_up_to_.begin(), last)));
}

Vec3 SurfacePoints::draw_corner()
{
    return to_vec3(faces_[random_() % faces_.size()][random_() % 3]);
}

Vec3 SurfacePoints::draw_by_face()
{
    return point_of(random_() % faces_.size());
}

Vec3 SurfacePoints::point_of(std::size_t face)
{
    std::uniform_real_distribution<double> draw(0.0, 1.0);
    double s = draw(random_);
    double t = draw(random_);
    if (s + t > 1.0)
    {
        s = 1.0 - s;
        t = 1.0 - t;
    }
    const Vec3 a = to_vec3(faces_[face][0]);
    return a + s * (to_vec3(faces_[face][1]) - a) + t * (to_vec3(faces_[face][2]) - a);
}

} // namespace tactus::test
