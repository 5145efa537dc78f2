// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"

#include <algorithm>
#include <functional>

/// Stand-in for the controller's force: analytic shapes and a god-object, to test device and hand
/// before and apart from all code for meshes.
namespace tactus::test
{

/// Signed distance, negative inside.
using Shape = std::function<double(const Vec3&)>;

inline Shape sphere(double radius_m)
{
    return [=](const Vec3& p) { return p.norm() - radius_m; };
}

inline Shape box(const Vec3& centre, const Vec3& half)
{
    return [=](const Vec3& p)
    {
        const Vec3 q = (p - centre).cwiseAbs() - half;
        return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
    };
}

/// Union of shapes. The outside distance stays exact, which suffices for a god-object outside.
inline Shape join(Shape a, Shape b)
{
    return [=](const Vec3& p) { return std::min(a(p), b(p)); };
}

/// Sphere on a spring that follows the device, but never into the shape.
struct FakeWall
{
    FakeWall(Shape shape, double stiffness_n_per_m, double tool_radius_m, const Vec3& start)
        : shape_(std::move(shape))
        , stiffness_(stiffness_n_per_m)
        , radius_m_(tool_radius_m)
        , proxy_(start)
    {
    }

    Vec3 respond(const Vec3& device)
    {
        follow(device);
        const Vec3 pull = proxy_ - device;
        return pull.norm() > 1e-9 ? Vec3(pull * stiffness_) : Vec3(Vec3::Zero());
    }

private:
    /// Moves in steps no longer than the free distance, at the surface only along it.
    void follow(const Vec3& device)
    {
        for (int step = 0; step < 64; ++step)
        {
            Vec3 left = device - proxy_;
            const double gap = shape_(proxy_) - radius_m_;
            if (gap < 1e-7)
            {
                const Vec3 normal = gradient(proxy_);
                left -= normal * std::min(0.0, left.dot(normal));
            }
            if (left.norm() < 1e-10)
            {
                return;
            }
            const double longest = std::max(gap, 0.1 * radius_m_);
            proxy_ += left * std::min(1.0, longest / left.norm());
            push_out();
        }
    }

    void push_out()
    {
        for (int step = 0; step < 4; ++step)
        {
            const double depth = radius_m_ - shape_(proxy_);
            if (depth <= 0.0)
            {
                return;
            }
            proxy_ += gradient(proxy_) * depth;
        }
    }

    [[nodiscard]] Vec3 gradient(const Vec3& p) const
    {
        const double h = 1e-3 * radius_m_;
        Vec3 g;
        for (int axis = 0; axis < 3; ++axis)
        {
            const Vec3 step = Vec3::Unit(axis) * h;
            g[axis] = shape_(p + step) - shape_(p - step);
        }
        return g.normalized();
    }

    Shape shape_;
    double stiffness_;
    double radius_m_;
    Vec3 proxy_;
};

} // namespace tactus::test
