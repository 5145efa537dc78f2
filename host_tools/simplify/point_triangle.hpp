// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"

#include <cstddef>
#include <vector>

namespace tactus
{

/// Points in columns, for the distance kernel.
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

/// A triangle made ready for many point distances.
///
/// The distance is the least of the three sides' (each a clamped projection), and the plane's where
/// the projection lies strictly inside. With corners on the integer grid of at most 24 bits the
/// normal is exact (products of 25-bit differences, 51 bits in all), so unlike in general the error
/// does not grow with the triangle's aspect: a point within 2^25 quanta gets its distance within
/// 1e-7 quanta, on needles too, and a triangle without area is three segments.
class DistanceTriangle
{
public:
    DistanceTriangle() noexcept = default;
    DistanceTriangle(const Vec3& a, const Vec3& b, const Vec3& c) noexcept;

    /// Writes the squared distances of points[begin ...] to out[begin ...].
    void squared_distances(const PointColumns& points, std::size_t begin,
                           double* out) const noexcept;

    [[nodiscard]] const Vec3& normal() const noexcept { return normal_; }

private:
    struct Side
    {
        Vec3 start;
        Vec3 along;
        Vec3 inward; ///< In the plane, pointing to the third corner; zero without area.
        double inverse_squared_length{0};
    };

    [[nodiscard]] static Side side_of(const Vec3& from, const Vec3& to,
                                      const Vec3& normal) noexcept;

    Side ab_;
    Side bc_;
    Side ca_;
    Vec3 normal_{0, 0, 0};
    double inverse_squared_normal_{0};
};

} // namespace tactus
