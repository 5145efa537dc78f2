// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/math/triangle.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <ccd/ccd.h>
#include <ccd/quat.h>
#include <gtest/gtest.h>

#include <cmath>

namespace tactus::test
{

namespace
{

struct Sphere
{
    Vec3 center;
    double radius;
};

void put(ccd_vec3_t* out, const Vec3& v)
{
    ccdVec3Set(out, static_cast<ccd_real_t>(v.x()), static_cast<ccd_real_t>(v.y()),
               static_cast<ccd_real_t>(v.z()));
}

Vec3 from(const ccd_vec3_t* v)
{
    return {static_cast<double>(ccdVec3X(v)), static_cast<double>(ccdVec3Y(v)),
            static_cast<double>(ccdVec3Z(v))};
}

void support_sphere(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* out)
{
    const auto& sphere = *static_cast<const Sphere*>(object);
    put(out, sphere.center + sphere.radius * from(direction).normalized());
}

void support_triangle(const void* object, const ccd_vec3_t* direction, ccd_vec3_t* out)
{
    const auto& triangle = *static_cast<const Triangle*>(object);
    const Vec3 along = from(direction);
    const Vec3* farthest = &triangle[0];
    for (const Vec3& corner : triangle)
    {
        farthest = corner.dot(along) > farthest->dot(along) ? &corner : farthest;
    }
    put(out, *farthest);
}

void center_of_sphere(const void* object, ccd_vec3_t* out)
{
    put(out, static_cast<const Sphere*>(object)->center);
}

void center_of_triangle(const void* object, ccd_vec3_t* out)
{
    const auto& triangle = *static_cast<const Triangle*>(object);
    put(out, (triangle[0] + triangle[1] + triangle[2]) / 3.0);
}

ccd_t settings()
{
    ccd_t ccd;
    CCD_INIT(&ccd);
    ccd.support1 = support_sphere;
    ccd.support2 = support_triangle;
    ccd.center1 = center_of_sphere;
    ccd.center2 = center_of_triangle;
    ccd.max_iterations = 200;
    return ccd;
}

/// Between clearly apart and clearly touching, libccd's own tolerance decides.
constexpr double kBand = 1e-3;

template <typename Intersect>
void expect_agreement(Intersect intersect, std::uint64_t own_seed)
{
    Random random(own_seed);
    const ccd_t ccd = settings();
    int touching = 0;
    int apart = 0;
    for (int i = 0; i < 20'000; ++i)
    {
        const Triangle triangle{random.in_cube(1.0), random.in_cube(1.0), random.in_cube(1.0)};
        const Sphere sphere{random.in_cube(1.5), random.between(0.2, 1.0)};
        const double gap =
            std::sqrt(closest_point_on_triangle(sphere.center, triangle).distance_sq) -
            sphere.radius;
        if (std::abs(gap) < kBand)
        {
            continue;
        }
        const bool touches = intersect(&sphere, &triangle, &ccd) != 0;
        ASSERT_EQ(touches, gap < 0.0) << "case " << i << " gap " << gap;
        ++(touches ? touching : apart);
    }
    EXPECT_GT(touching, 1'000);
    EXPECT_GT(apart, 1'000);
}

} // namespace

TEST(SecondOpinion, libccd_portal_refinement_agrees_on_sphere_and_triangle)
{
    expect_agreement(ccdMPRIntersect, 17);
}

TEST(SecondOpinion, libccd_gjk_agrees_on_sphere_and_triangle)
{
    expect_agreement(ccdGJKIntersect, 18);
}

} // namespace tactus::test
