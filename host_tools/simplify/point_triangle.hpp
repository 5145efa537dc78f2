// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/simplify/distance_kernel.hpp"
#include "rt_core/math/vec3.hpp"

#include <cstddef>
#include <vector>

namespace tactus
{

/// Points as one array for each coordinate, for the distance kernel.
struct PointColumns
{
    std::vector<double> x;
    std::vector<double> y;
    std::vector<double> z;

    void clear() noexcept;
    void push_back(const Vec3& point);
    void truncate(std::size_t size);
    [[nodiscard]] std::size_t size() const noexcept { return x.size(); }
    [[nodiscard]] Vec3 operator[](std::size_t i) const noexcept { return {x[i], y[i], z[i]}; }
};

/// A triangle prepared for many point distances.
///
/// The distance is that to the plane if the point's projection lies strictly inside the triangle,
/// otherwise the least distance to a side (a clamped projection). With corners on an integer grid
/// of at most 24 bits the normal is exact: products of 25-bit differences have at most 51 bits. The
/// error therefore does not grow with the triangle's aspect ratio: a point within 2^25 quanta gets
/// its distance within 1e-7 quanta, on needles too, and a triangle without area is three segments.
class DistanceTriangle
{
public:
    DistanceTriangle() noexcept = default;
    DistanceTriangle(const Vec3& a, const Vec3& b, const Vec3& c) noexcept;

    /// Writes the squared distances of points[begin ...] to out[begin ...].
    void squared_distances(const PointColumns& points, std::size_t begin,
                           double* out) const noexcept;

    [[nodiscard]] Vec3 normal() const noexcept
    {
        return {triangle_.normal[0], triangle_.normal[1], triangle_.normal[2]};
    }

private:
    KernelTriangle triangle_{};
};

} // namespace tactus
