// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/math/arc_tangent.hpp"
#include "rt_core/math/vec3.hpp"

#include <cmath>
#include <numbers>

namespace tactus
{

/// More than roundings ever leave of the identity in R^T R.
inline constexpr double kOrthonormalRounding = 1e-9;

/// Whether each entry of R^T R is within the tolerance of the identity's. 30 instructions.
[[nodiscard]] inline bool is_orthonormal(const Mat3& matrix, double tolerance) noexcept
{
    for (int i = 0; i < 3; ++i)
    {
        for (int k = 0; k <= i; ++k)
        {
            const double off = matrix.col(i).dot(matrix.col(k)) - (i == k ? 1.0 : 0.0);
            if (!(std::abs(off) <= tolerance)) // So that NaN is not.
            {
                return false;
            }
        }
    }
    return true;
}

/// The same, and right-handed.
[[nodiscard]] inline bool is_rotation(const Mat3& matrix, double tolerance) noexcept
{
    return is_orthonormal(matrix, tolerance) && matrix.determinant() > 0.0;
}

/// Orthonormal to rounding; an axis that is so already keeps its bits.
[[nodiscard]] inline Mat3 orthonormalised(const Mat3& matrix) noexcept
{
    TACTUS_ASSERT(matrix.col(0).squaredNorm() > 0.0);
    Mat3 result;
    const Vec3 first = matrix.col(0).normalized();
    const Vec3 across = matrix.col(1) - first.dot(matrix.col(1)) * first;
    result.col(0) = first;
    result.col(1) = across.normalized();
    result.col(2) = first.cross(result.col(1));
    return result;
}

/// Axis times angle, 0 .. pi, of a rotation that is orthonormal to rounding.
[[nodiscard]] inline Vec3 rotation_vector(const Mat3& rotation) noexcept
{
    TACTUS_ASSERT(is_orthonormal(rotation, kOrthonormalRounding));
    const Eigen::Quaterniond turn(rotation);
    const Vec3 way = turn.w() < 0.0 ? Vec3(-turn.vec()) : Vec3(turn.vec());
    const double sine = way.norm();
    const double cosine = std::abs(turn.w());
    if (!(sine > 0.0))
    {
        return {0.0, 0.0, 0.0};
    }
    const double angle = cosine > 0.0 ? 2.0 * arc_tangent(sine / cosine) : std::numbers::pi;
    return way * (angle / sine);
}

/// Round the axis of `turn` by twice the arc tangent of half its length (Cayley): its length for
/// a small one, never more. By IEEE operations alone.
[[nodiscard]] inline Mat3 turned_by(const Vec3& turn, const Mat3& rotation) noexcept
{
    TACTUS_ASSERT(is_orthonormal(rotation, kOrthonormalRounding));
    const Vec3 half = 0.5 * turn;
    const double share = 2.0 / (1.0 + half.squaredNorm());
    Mat3 result;
    for (int axis = 0; axis < 3; ++axis)
    {
        const Vec3 column = rotation.col(axis);
        const Vec3 across = half.cross(column);
        result.col(axis) = column + share * (across + half.cross(across));
    }
    return orthonormalised(result);
}

} // namespace tactus
