// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/shapes/shapes.hpp"
#include "tests/shared/mesh_pair_oracle.hpp"
#include "tests/stability/mesh_motion.hpp"

#include <gtest/gtest.h>

namespace tactus::test
{

namespace
{

const TestModel& small_shape(Shape shape)
{
    const std::string name(shape_names()[static_cast<std::size_t>(shape)]);
    return test_model("oracle-" + name, make_shape(shape, 260).value(), 100);
}

Mat3 random_rotation(Random& random)
{
    return Eigen::Quaterniond(random.between(0.1, 1.0), random.between(-1.0, 1.0),
                              random.between(-1.0, 1.0), random.between(-1.0, 1.0))
        .normalized()
        .toRotationMatrix();
}

TEST(MeshPairOracle, finds_what_all_pairs_one_by_one_give)
{
    const TestModel& tool = small_shape(Shape::gear);
    const TestModel& object = small_shape(Shape::torus);
    const ToolBall ball = ball_round(tool);
    MeshPairOracle sut(tool, object);
    Random random(620);
    ObjectPose pose;
    pose.scale = 2.0;
    int meetings = 0;
    for (int i = 0; i < 6; ++i)
    {
        pose.rotation = random_rotation(random);
        pose.translation_m = random.in_cube(1.0);
        ToolState state;
        state.rotation = random_rotation(random);
        const Vec3f& corner = object.faces[random.below(object.faces.size())][0];
        state.position_m = to_world(pose, to_vec3(corner)) - state.rotation * ball.middle_m;
        state.position_m.x() += i % 2 == 0 ? 0.0 : 0.6; // Through the surface; beyond the object.
        sut.place(pose, state);
        const long double distance_m = sut.nearest().distance_m;
        EXPECT_EQ(distance_m, sut.brute_distance()) << "place " << i;
        EXPECT_EQ(sut.meeting(), sut.brute_meeting()) << "place " << i;
        EXPECT_EQ(sut.meeting().empty(), distance_m > 0) << "place " << i;
        meetings += sut.meeting().empty() ? 0 : 1;
    }
    EXPECT_EQ(meetings, 3);
}

TEST(MeshPairOracle, knows_the_distance_of_two_spheres_in_the_world)
{
    const TestModel& tool = test_model("oracle-ball", make_shape(Shape::sphere, 2'000).value());
    const TestModel& object = test_model("oracle-globe", make_shape(Shape::sphere, 2'000).value());
    MeshPairOracle sut(tool, object);
    ObjectPose pose;
    pose.scale = 3.0;
    pose.translation_m = Vec3(1.0, 2.0, 3.0);
    // The model's frame starts at the corner of the mesh's box.
    const Vec3 middle_m =
        pose.translation_m - 3.0 * Vec3(object.origin_m[0], object.origin_m[1], object.origin_m[2]);
    ToolState state;
    state.rotation = Eigen::AngleAxisd(1.0, Vec3(0.6, 0.0, 0.8)).toRotationMatrix();
    const Vec3 direction = Vec3(1.0, 2.0, 2.0) / 3.0;

    state.position_m = middle_m + 0.27 * direction;
    sut.place(pose, state);
    EXPECT_NEAR(static_cast<double>(sut.nearest().distance_m), 0.07, 2e-3);
    EXPECT_TRUE(sut.meeting().empty());
    EXPECT_TRUE(sut.within(0.06, 10).empty());
    EXPECT_FALSE(sut.within(0.08, 10).empty());

    state.position_m = middle_m + 0.18 * direction;
    sut.place(pose, state);
    EXPECT_EQ(sut.nearest().distance_m, 0.0L);
    EXPECT_FALSE(sut.meeting().empty());
}

} // namespace

} // namespace tactus::test
