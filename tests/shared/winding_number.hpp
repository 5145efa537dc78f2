// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace tactus::test
{

/// Winding number of a closed mesh about a point that is not on it: the sum of its faces' solid
/// angles (van Oosterom and Strackee 1983).
[[nodiscard]] inline long double winding_number(const std::vector<std::array<Vec3f, 3>>& mesh,
                                                const Vec3& point)
{
    long double sum = 0;
    for (const auto& face : mesh)
    {
        std::array<Eigen::Matrix<long double, 3, 1>, 3> r;
        for (std::size_t i = 0; i < 3; ++i)
        {
            r[i] = to_vec3(face[i]).cast<long double>() - point.cast<long double>();
        }
        const long double a = r[0].norm();
        const long double b = r[1].norm();
        const long double c = r[2].norm();
        const Eigen::Matrix<long double, 3, 1> across = r[1].cross(r[2]);
        const long double volume = r[0].dot(across);
        const long double below =
            a * b * c + r[0].dot(r[1]) * c + r[1].dot(r[2]) * a + r[2].dot(r[0]) * b;
        sum += 2 * std::atan2(volume, below);
    }
    return sum / (4 * std::numbers::pi_v<long double>);
}

} // namespace tactus::test
