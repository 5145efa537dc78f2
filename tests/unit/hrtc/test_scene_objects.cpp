// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/choices/device_choice.hpp"
#include "platform/choices/scene_materials.hpp"
#include "platform/controller/following_operator.hpp"
#include "platform/scene/scene_parts.hpp"
#include "rt_core/base/arena.hpp"
#include "tests/shared/frame_rig.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace tactus::hrtc
{
namespace
{

constexpr std::uint64_t kSeed = 20'260'731;

/// Quaternion of length 1 except for rounding, or with the greatest deviation of a valid pose.
Pose random_pose(std::mt19937_64& random, double length)
{
    std::normal_distribution<double> number;
    Eigen::Vector4d q{number(random), number(random), number(random), number(random)};
    q *= length / q.norm();
    Pose pose;
    pose.rotation = {q[0], q[1], q[2], q[3]};
    pose.translation_m = {number(random), number(random), number(random)};
    pose.scale = std::exp(number(random));
    return pose;
}

TEST(ObjectPose, a_quaternion_becomes_the_rotation_that_it_is_and_stays_orthonormal)
{
    std::mt19937_64 random(kSeed);
    for (int i = 0; i < 100'000; ++i)
    {
        const Pose pose = random_pose(random, i % 2 == 0 ? 1.0 : 1.0 + kPoseUnitTolerance);
        const Mat3 rotation = to_similarity(pose).rotation;
        const auto& q = pose.rotation;
        const Mat3 oracle = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().matrix();
        ASSERT_LT((rotation - oracle).cwiseAbs().maxCoeff(), 2e-15) << "seed " << kSeed << " " << i;
        const Mat3 excess = rotation.transpose() * rotation - Mat3::Identity();
        ASSERT_LT(excess.cwiseAbs().maxCoeff(), 2e-15) << "seed " << kSeed << " " << i;
    }
}

TEST(ObjectPose, from_a_server_is_where_place_would_put_the_object)
{
    const tactus::test::TestModel& model = tactus::test::small_model(0);
    const tactus::test::FrameRig rig(model, tactus::test::with_room_for_all());
    const ModelHeader& header = rig.frame().model({0}).header;
    const auto placement = parse_placement("0.1,-0.2,0.3,0,0,90,2");
    ASSERT_TRUE(placement);
    Pose pose;
    pose.translation_m = {0.1, -0.2, 0.3};
    pose.rotation = {0.0, 0.0, std::sqrt(0.5), std::sqrt(0.5)};
    pose.scale = 2.0;
    const ObjectPose placed = object_pose(placement.value(), header);
    const ObjectPose moved = object_pose(to_similarity(pose), header);
    EXPECT_LT((placed.rotation - moved.rotation).cwiseAbs().maxCoeff(), 1e-15);
    EXPECT_LT((placed.translation_m - moved.translation_m).norm(), 1e-15);
    EXPECT_EQ(placed.scale, moved.scale);
    EXPECT_EQ(placed.revision, moved.revision);
    // Quarter turn about z of the source's point (1, 0, 0).
    const Vec3 world_m = to_world(moved, Vec3(1.0, 0.0, 0.0));
    EXPECT_LT((world_m - Vec3(0.1, -0.2 + 2.0, 0.3)).norm(), 1e-14);
}

using Words = std::vector<std::string>;

TEST(SceneMaterials, of_one_object_go_before_that_of_all_and_both_before_the_scene_s)
{
    SceneMaterials sut;
    const Material said{400.0};
    EXPECT_EQ(sut.material_for("cup", said), said);
    ASSERT_EQ(sut.parse(Words{"cup:800,0.6,0.4"}), "");
    EXPECT_EQ(sut.material_for("cup", said), (Material{800.0, 0.6, 0.4}));
    EXPECT_EQ(sut.material_for("pot", said), said);
    ASSERT_EQ(sut.parse(Words{"stiffness=200,damping=1"}), "");
    EXPECT_EQ(sut.material_for("cup", said), (Material{800.0, 0.6, 0.4}));
    EXPECT_EQ(sut.material_for("pot", said), (Material{200.0, 0.0, 0.0, 1.0}));
}

TEST(SceneMaterials, are_refused_for_what_is_wrong_with_them)
{
    const auto refusal = [](const Words& options) { return SceneMaterials().parse(options); };
    EXPECT_EQ(refusal({"100", "200"}), "--material: is given twice for all objects of the scene; "
                                       "use OBJECT:MATERIAL for one object");
    EXPECT_EQ(refusal({"cup:100", "pot:100", "cup:200"}), "--material: is given twice for 'cup'");
    EXPECT_EQ(refusal({":100"}),
              "--material: ':100': an object's name is missing before the colon");
    EXPECT_EQ(refusal({"cup:wood"}), "--material: 'wood' is not STIFFNESS[,STATIC[,DYNAMIC[,"
                                     "DAMPING]]]: STIFFNESS is 'wood', not a number");
}

TEST(SceneMaterials, of_an_object_that_is_not_there_are_told_with_the_nearest_name)
{
    SceneMaterials sut;
    ASSERT_EQ(sut.parse(Words{"cap:100"}), "");
    EXPECT_EQ(sut.missing(Words{"cap", "pot"}), "");
    EXPECT_EQ(sut.missing(Words{"cup", "pot"}), "--material: no object is called 'cap'; cup?");
    EXPECT_EQ(sut.missing(Words{"kitchen", "table"}),
              "--material: no object is called 'cap'; there are kitchen, table");
    EXPECT_EQ(no_such_object("x", Words(10, "kitchen")),
              "no object is called 'x'; there are kitchen, kitchen, kitchen, kitchen, kitchen, "
              "kitchen, kitchen, kitchen and 2 more");
}

/// Hand that keeps its last sense, and moves 1 mm along x each time.
struct StraightOperator final : public OperatorMotion
{
    OperatorSense* sensed;
    int frames{0};

    explicit StraightOperator(OperatorSense& into) : sensed(&into) {}
    [[nodiscard]] Vec3 start_world_m() const noexcept override { return {1.0, 0.0, 0.0}; }
    [[nodiscard]] Vec3 next_world_m(const OperatorSense& sense) noexcept override
    {
        *sensed = sense;
        return {1.0 + 1e-3 * ++frames, 0.0, 0.0};
    }
    [[nodiscard]] OperatorGrip grip() const noexcept override
    {
        return {Mat3::Identity(), 5, std::nullopt};
    }
};

/// Object initially at (0, 0, 1), and the hand that follows it by up to 0.1 m a step.
struct Rig
{
    alignas(64) std::array<std::byte, 4096> memory{};
    Arena arena{memory};
    ObjectTable objects{arena, 1};
    OperatorSense sensed;
    Similarity start;
    std::unique_ptr<FollowingOperator> hand;

    Rig()
    {
        start.translation_m = {0.0, 0.0, 1.0};
        tell(SceneChangeKind::object_comes, start);
        hand = std::make_unique<FollowingOperator>(std::make_unique<StraightOperator>(sensed),
                                                   objects, 0, start, 0.1);
    }
    void tell(SceneChangeKind kind, const Similarity& place)
    {
        SceneChange change;
        change.kind = kind;
        static_cast<Similarity&>(change.pose) = place;
        objects.make(change, Vec3::Zero(), 1);
    }
    void move(const Similarity& place) { tell(SceneChangeKind::object_moves, place); }
};

/// Quarter turn about z.
Mat3 quarter()
{
    Mat3 rotation;
    rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
    return rotation;
}

TEST(FollowingOperator, is_the_other_hand_while_the_object_stays)
{
    Rig rig;
    OperatorSense sense;
    sense.device_world_m = {0.1, 0.2, 0.3};
    EXPECT_EQ(rig.hand->start_world_m(), Vec3(1.0, 0.0, 0.0));
    EXPECT_EQ(rig.hand->next_world_m(sense), Vec3(1.001, 0.0, 0.0));
    EXPECT_EQ(rig.sensed.device_world_m, sense.device_world_m);
    EXPECT_EQ(rig.hand->grip().rotation, Mat3::Identity());
    EXPECT_EQ(rig.hand->grip().buttons, 5U);
}

TEST(FollowingOperator, goes_turns_and_grows_with_the_object)
{
    Rig rig;
    Similarity place = rig.start;
    place.translation_m = {0.0, 0.05, 1.0}; // Less than a step.
    place.rotation = quarter();
    place.scale = 2.0;
    rig.move(place);
    OperatorSense sense;
    sense.device_world_m = {0.0, 2.05, 1.0};
    sense.force_world_n = {0.0, 3.0, 0.0};
    // The point (x, 0, 0), one below the object, is now two below it and rotated to y.
    EXPECT_NEAR((rig.hand->next_world_m(sense) - Vec3(0.0, 0.05 + 2.002, -1.0)).norm(), 0.0, 1e-12);
    EXPECT_NEAR((rig.sensed.device_world_m - Vec3(1.0, 0.0, 1.0)).norm(), 0.0, 1e-12);
    EXPECT_NEAR((rig.sensed.force_world_n - Vec3(3.0, 0.0, 0.0)).norm(), 0.0, 1e-12);
    EXPECT_EQ(rig.hand->grip().rotation, quarter());
}

TEST(FollowingOperator, comes_after_a_jump_step_by_step)
{
    Rig rig;
    Similarity place = rig.start;
    place.translation_m.x() += 0.25;
    rig.move(place);
    Vec3 before = rig.hand->start_world_m();
    for (const double way_m : {0.1, 0.1, 0.05, 0.0, 0.0})
    {
        const Vec3 now = rig.hand->next_world_m({});
        EXPECT_NEAR((now - before).x(), way_m + 1e-3, 1e-12);
        before = now;
    }
    EXPECT_NEAR(before.x(), 1.0 + 0.25 + 5e-3, 1e-12);
}

TEST(FollowingOperator, stays_where_an_object_was_that_has_gone)
{
    Rig rig;
    Similarity place = rig.start;
    place.translation_m.x() += 0.05;
    rig.move(place);
    static_cast<void>(rig.hand->next_world_m({}));
    rig.tell(SceneChangeKind::object_goes, {});
    EXPECT_NEAR(rig.hand->next_world_m({}).x(), 1.052, 1e-12);
}

} // namespace
} // namespace tactus::hrtc
