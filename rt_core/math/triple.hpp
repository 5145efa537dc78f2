// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/double_double.hpp"
#include "rt_core/math/vec3.hpp"

namespace tactus
{

/// A vector for algorithms that run in double and in double-double alike.
template <typename Real>
struct Triple
{
    Real x;
    Real y;
    Real z;
};

template <typename Real>
[[nodiscard]] constexpr Triple<Real> operator+(const Triple<Real>& a,
                                               const Triple<Real>& b) noexcept
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

template <typename Real>
[[nodiscard]] constexpr Triple<Real> operator-(const Triple<Real>& a,
                                               const Triple<Real>& b) noexcept
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <typename Real>
[[nodiscard]] constexpr Triple<Real> operator-(const Triple<Real>& a) noexcept
{
    return {-a.x, -a.y, -a.z};
}

template <typename Real>
[[nodiscard]] constexpr Triple<Real> operator*(const Real& factor, const Triple<Real>& a) noexcept
{
    return {factor * a.x, factor * a.y, factor * a.z};
}

template <typename Real>
[[nodiscard]] constexpr Real dot(const Triple<Real>& a, const Triple<Real>& b) noexcept
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <typename Real>
[[nodiscard]] constexpr Triple<Real> cross(const Triple<Real>& a, const Triple<Real>& b) noexcept
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <typename Real>
[[nodiscard]] Triple<Real> to_triple(const Vec3& v) noexcept
{
    return {Real{v.x()}, Real{v.y()}, Real{v.z()}};
}

/// a - b, rounded once if Real is double, exact if it is double-double.
template <typename Real>
[[nodiscard]] Triple<Real> difference(const Vec3& a, const Vec3& b) noexcept
{
    return to_triple<Real>(a) - to_triple<Real>(b);
}

template <typename Real>
[[nodiscard]] Vec3 to_vec3(const Triple<Real>& a) noexcept
{
    return {to_double(a.x), to_double(a.y), to_double(a.z)};
}

} // namespace tactus
