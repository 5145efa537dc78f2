// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/shapes/shapes.hpp"
#include "rt_core/math/infinity.hpp"
#include "tests/bench/peers/point_query.hpp"
#include "tests/shared/face_tree.hpp"
#include "tests/shared/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace tactus::bench
{

namespace
{

constexpr double kDiagonal_m = 0.17;
/// Larger than faces, which shows what spheres are off by.
constexpr double kRadius_m = 0.03 * kDiagonal_m;

std::vector<test::Face> small_sphere()
{
    const TriangleMesh mesh = make_shape(Shape::bumpy_sphere, 3'000).value();
    const auto corner = [&](std::uint32_t vertex)
    {
        const auto& [x, y, z] = mesh.positions[vertex];
        return Vec3f{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
    };
    std::vector<test::Face> faces;
    for (const auto& [a, b, c] : mesh.faces)
    {
        faces.push_back({corner(a), corner(b), corner(c)});
    }
    return faces;
}

/// A point within a probe's diameter of the sphere, of either side.
Vec3 point_near(test::Random& random)
{
    const Vec3 direction = random.in_cube(1.0).normalized();
    return (bumpy_radius_m(direction.x(), direction.y(), direction.z()) +
            random.between(-1.5, 1.5) * kRadius_m) *
           direction;
}

struct Error
{
    double distance_m{0.0};
    double point_m{0.0};
    int missed{0};
};

/// What is wrong with one answer, held against a plain tree in double.
void add_error(TouchQuery& query, const test::FaceTree& tree, const Vec3& point_m, double band_m,
               double tolerance_m, Error& error)
{
    const double truth_m = tree.nearest(point_m).distance_m;
    const double told_m = query.distance_m(point_m, band_m);
    error.missed += truth_m < kRadius_m - tolerance_m && !(told_m < kRadius_m) ? 1 : 0;
    if (std::isinf(told_m))
    {
        error.distance_m = std::max(error.distance_m, band_m - truth_m);
        return;
    }
    const Vec3 nearest_m = query.nearest_m();
    const double off_surface_m = tree.nearest(nearest_m).distance_m;
    error.distance_m = std::max(error.distance_m, std::abs(told_m - truth_m));
    error.point_m =
        std::max({error.point_m, off_surface_m, std::abs((nearest_m - point_m).norm() - truth_m)});
}

Error error_of(TouchQuery& query, const test::FaceTree& tree, double tolerance_m)
{
    test::Random random(810);
    Error error;
    for (int i = 0; i < 5'000; ++i)
    {
        add_error(query, tree, point_near(random), 2.0 * kRadius_m, tolerance_m, error);
        if (!query.needs_band())
        {
            add_error(query, tree, random.in_cube(kDiagonal_m), kInfinity, tolerance_m, error);
        }
    }
    return error;
}

/// Each peer of this build; none is built without TACTUS_BENCH_PEERS.
class PointPeers : public testing::TestWithParam<PointPeer>
{
};

TEST_P(PointPeers, are_off_by_as_much_as_they_are_known_to_be)
{
    const PointPeer& peer = GetParam();
    const std::vector<test::Face> faces = small_sphere();
    const test::FaceTree tree(faces);
    const auto query = peer.make(faces, kRadius_m);
    EXPECT_EQ(query->name(), peer.name);

    const double tolerance_m = peer.error_diag * kDiagonal_m;
    const Error error = error_of(*query, tree, tolerance_m);

    EXPECT_EQ(error.missed, 0);
    EXPECT_LE(error.distance_m, tolerance_m);
    EXPECT_LE(error.point_m, tolerance_m);
    if (peer.error_diag > 1e-4) // Else it would be right after all.
    {
        EXPECT_GT(error.distance_m, 1e-5 * kDiagonal_m);
    }
}

TEST_P(PointPeers, forget_what_they_were_asked)
{
    const std::vector<test::Face> faces = small_sphere();
    const auto query = GetParam().make(faces, kRadius_m);
    test::Random random(811);
    const Vec3 first_m = point_near(random);
    const double before_m = query->distance_m(first_m, 2.0 * kRadius_m);
    for (int i = 0; i < 50; ++i)
    {
        static_cast<void>(query->distance_m(point_near(random), 2.0 * kRadius_m));
    }
    query->forget();
    EXPECT_EQ(query->distance_m(first_m, 2.0 * kRadius_m), before_m);
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(PointPeers);
INSTANTIATE_TEST_SUITE_P(Built, PointPeers, testing::ValuesIn(point_peers()),
                         [](const auto& tested)
                         {
                             std::string name = tested.param.name;
                             std::erase_if(name, [](char c) { return c == ' ' || c == ','; });
                             return name;
                         });

TEST(GoalPeers, know_a_band)
{
    const std::vector<test::Face> faces = small_sphere();
    for (const auto& peer : make_peers(faces))
    {
        EXPECT_EQ(peer->distance_m(Vec3(1.0, 0.0, 0.0), kRadius_m), kInfinity) << peer->name();
    }
}

} // namespace

} // namespace tactus::bench
