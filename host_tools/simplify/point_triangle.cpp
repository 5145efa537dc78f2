// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/simplify/point_triangle.hpp"

#include <Eigen/Geometry>

namespace tactus
{

void PointColumns::clear() noexcept
{
    x.clear();
    y.clear();
    z.clear();
}

void PointColumns::push_back(const Vec3& point)
{
    x.push_back(point.x());
    y.push_back(point.y());
    z.push_back(point.z());
}

void PointColumns::truncate(std::size_t size)
{
    x.resize(size);
    y.resize(size);
    z.resize(size);
}

DistanceTriangle::DistanceTriangle(const Vec3& a, const Vec3& b, const Vec3& c) noexcept
    : normal_((b - a).cross(c - a))
{
    ab_ = side_of(a, b, normal_);
    bc_ = side_of(b, c, normal_);
    ca_ = side_of(c, a, normal_);
    const double squared = normal_.squaredNorm();
    inverse_squared_normal_ = squared > 0 ? 1 / squared : 0;
}

DistanceTriangle::Side DistanceTriangle::side_of(const Vec3& from, const Vec3& to,
                                                 const Vec3& normal) noexcept
{
    const Vec3 along = to - from;
    const double squared = along.squaredNorm();
    return {from, along, normal.cross(along), squared > 0 ? 1 / squared : 0};
}

namespace
{

/// Plain scalars, so that the loop over points vectorises.
struct SideDistance
{
    double squared;
    double inward;
};

} // namespace

void DistanceTriangle::squared_distances(const PointColumns& points, std::size_t begin,
                                         double* out) const noexcept
{
    const auto measure = [](const Side& side, double x, double y, double z) -> SideDistance
    {
        const double px = x - side.start.x();
        const double py = y - side.start.y();
        const double pz = z - side.start.z();
        const double dot = px * side.along.x() + py * side.along.y() + pz * side.along.z();
        double t = dot * side.inverse_squared_length;
        t = t > 0 ? t : 0;
        t = t < 1 ? t : 1;
        const double dx = px - t * side.along.x();
        const double dy = py - t * side.along.y();
        const double dz = pz - t * side.along.z();
        return {dx * dx + dy * dy + dz * dz,
                px * side.inward.x() + py * side.inward.y() + pz * side.inward.z()};
    };
    const double* xs = points.x.data();
    const double* ys = points.y.data();
    const double* zs = points.z.data();
    const std::size_t end = points.size();
    // Locals, because `out` could alias the members otherwise.
    const Side ab = ab_;
    const Side bc = bc_;
    const Side ca = ca_;
    const Vec3 normal = normal_;
    const double inverse_squared_normal = inverse_squared_normal_;
    for (std::size_t i = begin; i < end; ++i)
    {
        const double x = xs[i];
        const double y = ys[i];
        const double z = zs[i];
        const SideDistance at_ab = measure(ab, x, y, z);
        const SideDistance at_bc = measure(bc, x, y, z);
        const SideDistance at_ca = measure(ca, x, y, z);
        const double first = at_ab.squared < at_bc.squared ? at_ab.squared : at_bc.squared;
        const double sides = first < at_ca.squared ? first : at_ca.squared;
        const double height = (x - ab.start.x()) * normal.x() + (y - ab.start.y()) * normal.y() +
                              (z - ab.start.z()) * normal.z();
        const double plane = height * height * inverse_squared_normal;
        const double inner = at_ab.inward < at_bc.inward ? at_ab.inward : at_bc.inward;
        const double inside = inner < at_ca.inward ? inner : at_ca.inward;
        out[i] = inside > 0 ? plane : sides;
    }
}

} // namespace tactus
