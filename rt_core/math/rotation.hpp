// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/math/arc_tangent.hpp"
#include "rt_core/math/vec3.hpp"

#include <array>
#include <cmath>
#include <numbers>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// Deviation of R^T R from the identity, per entry, that exceeds all those caused by rounding.
inline constexpr double kOrthonormalRounding = 1e-9;

/// True if each entry of R^T R is within the tolerance of the identity's. 30 instructions.
[[nodiscard]] inline bool is_orthonormal(const Mat3& matrix, double tolerance) noexcept
{
    for (int i = 0; i < 3; ++i)
    {
        for (int k = 0; k <= i; ++k)
        {
            const double off = matrix.col(i).dot(matrix.col(k)) - (i == k ? 1.0 : 0.0);
            if (!(std::abs(off) <= tolerance)) // NaN fails.
            {
                return false;
            }
        }
    }
    return true;
}

/// True if the matrix is orthonormal as above and right-handed.
[[nodiscard]] inline bool is_rotation(const Mat3& matrix, double tolerance) noexcept
{
    return is_orthonormal(matrix, tolerance) && matrix.determinant() > 0.0;
}

/// The matrix made orthonormal to rounding; an axis that is so already keeps its bits. The first
/// two columns must not be zero (asserted for the first) nor parallel.
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

/// A rotation in the records of devices and servers: x, y, z, w.
using Quaternion = std::array<double, 4>;

/// True if the length is within the tolerance of 1; false for NaN.
[[nodiscard]] inline bool is_unit(const Quaternion& q, double tolerance) noexcept
{
    const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    return std::abs(std::sqrt(square) - 1.0) <= tolerance; // NaN fails.
}

/// The rotation of a quaternion of any length but zero, which is not checked.
[[nodiscard]] inline Mat3 to_rotation(const Quaternion& quaternion) noexcept
{
    const auto [x, y, z, w] = quaternion;
    const double s = 2.0 / (x * x + y * y + z * z + w * w);
    Mat3 rotation;
    rotation << 1.0 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w),
        s * (x * y + z * w), 1.0 - s * (x * x + z * z), s * (y * z - x * w), s * (x * z - y * w),
        s * (y * z + x * w), 1.0 - s * (x * x + y * y);
    return rotation;
}

/// The quaternion, of either sign, of a rotation that is orthonormal to rounding (asserted).
[[nodiscard]] inline Quaternion to_quaternion(const Mat3& rotation) noexcept
{
    TACTUS_ASSERT(is_orthonormal(rotation, kOrthonormalRounding));
    const Eigen::Quaterniond turn(rotation);
    return {turn.x(), turn.y(), turn.z(), turn.w()};
}

/// Axis times angle, 0 .. pi rad, of a rotation that is orthonormal to rounding (asserted).
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

/// `rotation` followed by a rotation about the axis of `turn`, in rad and in the frame that
/// `rotation` leads to. The angle is twice the arc tangent of half the length of `turn` (Cayley):
/// its length if small, never more. IEEE operations only. `rotation` must be orthonormal to
/// rounding (asserted).
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

/// turned_by() with the length of `turn` as the angle: the error is 8e-11 rad at a length of 0.1
/// and falls with its 7th power.
[[nodiscard]] inline Mat3 turned_exactly_by(const Vec3& turn, const Mat3& rotation) noexcept
{
    // turned_by() takes twice the tangent of half the angle: t + t^3/12 + t^5/120.
    const double square = turn.squaredNorm();
    return turned_by(turn * (1.0 + square / 12.0 + square * square / 120.0), rotation);
}

} // namespace tactus
