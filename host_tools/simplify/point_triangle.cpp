// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/simplify/point_triangle.hpp"

#include <Eigen/Geometry>

#include <array>

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

namespace
{

KernelSide side_of(const Vec3& from, const Vec3& to, const Vec3& normal) noexcept
{
    const Vec3 along = to - from;
    const Vec3 inward = normal.cross(along);
    const double squared = along.squaredNorm();
    return {{from.x(), from.y(), from.z()},
            {along.x(), along.y(), along.z()},
            {inward.x(), inward.y(), inward.z()},
            squared > 0 ? 1 / squared : 0};
}

} // namespace

std::span<const SquaredDistances> available_distance_kernels() noexcept
{
#if defined(TACTUS_HAS_X86_KERNELS)
    static const std::array all{kPortableSquaredDistances, kAvx2SquaredDistances};
    const bool has_avx2 = static_cast<bool>(__builtin_cpu_supports("avx2")); // GCC returns int.
    return std::span(all).first(has_avx2 ? 2 : 1);
#else
    return {&kPortableSquaredDistances, 1};
#endif
}

DistanceTriangle::DistanceTriangle(const Vec3& a, const Vec3& b, const Vec3& c) noexcept
{
    const Vec3 normal = (b - a).cross(c - a);
    const double squared = normal.squaredNorm();
    triangle_ = {{side_of(a, b, normal), side_of(b, c, normal), side_of(c, a, normal)},
                 {normal.x(), normal.y(), normal.z()},
                 squared > 0 ? 1 / squared : 0};
}

void DistanceTriangle::squared_distances(const PointColumns& points, std::size_t begin,
                                         double* out) const noexcept
{
    static const SquaredDistances kernel = available_distance_kernels().back();
    kernel(triangle_, points.x.data(), points.y.data(), points.z.data(), begin, points.size(), out);
}

} // namespace tactus
