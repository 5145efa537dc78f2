// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/scene/object_table.hpp"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <limits>

namespace tactus::test
{
namespace
{

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<bool, 2> kShown{true, false}; ///< The second model is a tool's.

class ObjectTableTest : public testing::Test
{
protected:
    static constexpr std::uint32_t kCapacity = 3;

    std::optional<ChangeRefusal> change(const SceneChange& change)
    {
        const auto refusal = sut.find_refusal(change, kShown);
        if (!refusal)
        {
            sut.make(change, Vec3(1.0, 0.0, 0.0), 7);
        }
        return refusal;
    }
    static SceneChange comes(std::uint32_t number, std::uint32_t generation)
    {
        SceneChange change;
        change.kind = SceneChangeKind::object_comes;
        change.number = number;
        change.generation = generation;
        change.object.model = ModelId{0};
        return change;
    }
    static SceneChange with(SceneChange change, SceneChangeKind kind)
    {
        change.kind = kind;
        return change;
    }

    std::array<std::byte, 4'096> bytes_ alignas(64){};
    Arena arena_{bytes_};
    ObjectTable sut{arena_, kCapacity};
};

TEST_F(ObjectTableTest, has_nobody_at_first_and_room_up_to_its_capacity)
{
    EXPECT_EQ(sut.capacity(), kCapacity);
    for (std::uint32_t i = 0; i < kCapacity; ++i)
    {
        EXPECT_FALSE(sut[i].is_resident);
        EXPECT_EQ(change(comes(i, 5)), std::nullopt);
        EXPECT_TRUE(sut[i].is_resident);
        EXPECT_EQ(sut[i].came_frame, 7U);
        EXPECT_EQ(sut[i].generation, 5U);
    }
    EXPECT_EQ(change(comes(kCapacity, 5)), ChangeRefusal::number_too_big);
}

TEST_F(ObjectTableTest, places_the_model_where_its_source_is_told_to_stand)
{
    SceneChange object = comes(0, 0);
    object.pose.scale = 2.0;
    object.pose.translation_m = Vec3(0.0, 3.0, 0.0);
    ASSERT_EQ(change(object), std::nullopt);
    EXPECT_EQ(sut[0].pose.translation_m, Vec3(2.0, 3.0, 0.0)); // The origin is at x = 1.
    object = with(object, SceneChangeKind::object_moves);
    object.pose.rotation << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
    object.pose.arrival_ns = 77;
    ASSERT_EQ(change(object), std::nullopt);
    EXPECT_EQ(sut[0].pose.translation_m, Vec3(0.0, 5.0, 0.0));
    EXPECT_EQ(sut[0].pose.rotation, object.pose.rotation);
    EXPECT_EQ(sut[0].pose.arrival_ns, 77);
    EXPECT_EQ(sut[0].spec.model, ModelId{0});
}

TEST_F(ObjectTableTest, takes_no_change_of_an_object_that_is_gone_or_another)
{
    EXPECT_EQ(change(with(comes(0, 4), SceneChangeKind::object_moves)), ChangeRefusal::not_here);
    EXPECT_EQ(change(with(comes(0, 4), SceneChangeKind::object_goes)), ChangeRefusal::not_here);
    ASSERT_EQ(change(comes(0, 4)), std::nullopt);
    EXPECT_EQ(change(comes(0, 5)), ChangeRefusal::already_here);
    for (const std::uint32_t other : {0U, 3U, 5U, 0xFFFF'FFFFU})
    {
        EXPECT_EQ(change(with(comes(0, other), SceneChangeKind::object_moves)),
                  ChangeRefusal::old_generation);
        EXPECT_EQ(change(with(comes(0, other), SceneChangeKind::object_goes)),
                  ChangeRefusal::old_generation);
        EXPECT_TRUE(sut[0].is_resident);
    }
    ASSERT_EQ(change(with(comes(0, 4), SceneChangeKind::object_goes)), std::nullopt);
    EXPECT_EQ(change(with(comes(0, 4), SceneChangeKind::object_goes)), ChangeRefusal::not_here);
    EXPECT_EQ(change(comes(0, 4)), ChangeRefusal::old_generation);
    EXPECT_EQ(change(comes(0, 3)), ChangeRefusal::old_generation);
    EXPECT_FALSE(sut[0].is_resident);
    EXPECT_EQ(change(comes(0, 5)), std::nullopt);
}

TEST_F(ObjectTableTest, shows_only_models_that_are_there_and_no_tools)
{
    SceneChange object = comes(0, 0);
    for (const std::uint32_t model : {1U, 2U, 0xFFFF'FFFFU})
    {
        object.object.model = ModelId{model};
        EXPECT_EQ(change(object), ChangeRefusal::unknown_model);
    }
}

TEST_F(ObjectTableTest, refuses_poses_that_are_not_rigid_or_out_of_range)
{
    using Change = std::function<void(ObjectPose&)>;
    const std::vector<Change> wrong{[](ObjectPose& p) { p.rotation(1, 1) = 1.0 + 1e-5; },
                                    [](ObjectPose& p) { p.rotation(2, 2) = -1.0; }, // Mirror.
                                    [](ObjectPose& p) { p.rotation.setZero(); },
                                    [](ObjectPose& p) { p.rotation(0, 2) = kNotANumber; },
                                    [](ObjectPose& p) { p.translation_m.y() = kNotANumber; },
                                    [](ObjectPose& p)
                                    { p.translation_m.z() = -1.0001 * kPoseReachMax_m; },
                                    [](ObjectPose& p) { p.translation_m.x() = kInfinity; },
                                    [](ObjectPose& p) { p.scale = 0.0; },
                                    [](ObjectPose& p) { p.scale = -1.0; },
                                    [](ObjectPose& p) { p.scale = 0.999 * kPoseScaleMin; },
                                    [](ObjectPose& p) { p.scale = 1.001 * kPoseScaleMax; },
                                    [](ObjectPose& p) { p.scale = kNotANumber; }};
    ASSERT_EQ(change(comes(1, 0)), std::nullopt);
    for (std::size_t i = 0; i < wrong.size(); ++i)
    {
        SCOPED_TRACE(i);
        SceneChange object = comes(0, 0);
        wrong[i](object.pose);
        EXPECT_EQ(change(object), ChangeRefusal::bad_pose);
        object = with(comes(1, 0), SceneChangeKind::object_moves);
        wrong[i](object.pose);
        EXPECT_EQ(change(object), ChangeRefusal::bad_pose);
        EXPECT_EQ(sut[1].pose.scale, 1.0);
        object.kind = SceneChangeKind::object_goes; // The pose of a removed object is ignored.
        EXPECT_EQ(sut.find_refusal(object, kShown), std::nullopt);
    }
    EXPECT_FALSE(sut[0].is_resident);
    SceneChange edge = comes(0, 0);
    edge.pose.scale = kPoseScaleMax;
    edge.pose.translation_m = Vec3(kPoseReachMax_m, -kPoseReachMax_m, 0.0);
    edge.pose.rotation(1, 1) = 1.0 + 0.4 * kRotationTolerance;
    EXPECT_EQ(change(edge), std::nullopt);
    EXPECT_EQ(sut[0].pose.rotation, Mat3(Mat3::Identity())); // Made orthonormal.
}

TEST_F(ObjectTableTest, refuses_materials_out_of_range)
{
    using Change = std::function<void(Material&)>;
    const std::vector<Change> wrong{
        [](Material& m) { m.stiffness_n_per_m = 0.0; },
        [](Material& m) { m.stiffness_n_per_m = kNotANumber; },
        [](Material& m) { m.static_friction = -0.1; },
        [](Material& m) { m.static_friction = 1.001 * kFrictionMax; },
        [](Material& m) { m.dynamic_friction = 0.1; }, // Above the static one.
        [](Material& m) { m.damping_n_s_per_m = -1.0; },
        [](Material& m) { m.damping_n_s_per_m = 1.001 * kDampingMax_n_s_per_m; },
        [](Material& m) { m.viscosity_n_s_per_m = -1.0; },
        [](Material& m) { m.viscosity_n_s_per_m = 1.001 * kDampingMax_n_s_per_m; },
        [](Material& m) { m.texture_height_m = 1e-6; }, // No length.
        [](Material& m) { m.texture_length_m = kNotANumber; },
        [](Material& m) { m.texture_length_m = 1.001 * kTextureLengthMax_m; },
        [](Material& m)
        {
            m.texture_length_m = 0.999 * kTextureLengthMin_m;
            m.texture_height_m = 1e-6;
        },
        [](Material& m)
        {
            m.texture_length_m = 0.01;
            m.texture_height_m = 1.001 * 0.01 * kTextureSteepest;
        }};
    ASSERT_EQ(change(comes(1, 0)), std::nullopt);
    for (std::size_t i = 0; i < wrong.size(); ++i)
    {
        SceneChange object = comes(0, 0);
        wrong[i](object.object.material);
        EXPECT_EQ(change(object), ChangeRefusal::bad_material) << i;
        object = with(comes(1, 0), SceneChangeKind::object_feels);
        wrong[i](object.object.material);
        EXPECT_EQ(change(object), ChangeRefusal::bad_material) << i;
        EXPECT_EQ(sut[1].spec.material, Material{}) << i;
    }
    SceneChange edge = comes(0, 0);
    edge.object.material = {kInfinity,
                            kFrictionMax,
                            kFrictionMax,
                            kDampingMax_n_s_per_m,
                            kDampingMax_n_s_per_m,
                            kTextureSteepest * kTextureLengthMin_m,
                            kTextureLengthMin_m};
    EXPECT_EQ(change(edge), std::nullopt);
    EXPECT_EQ(change(with(edge, SceneChangeKind::object_goes)), std::nullopt);
    edge = with(edge, SceneChangeKind::object_feels);
    EXPECT_EQ(change(edge), ChangeRefusal::not_here);
    edge.number = 1;
    edge.generation = 9;
    EXPECT_EQ(change(edge), ChangeRefusal::old_generation);
    edge.generation = 0;
    edge.pose.scale = kNotANumber; // The pose of a material change is ignored.
    EXPECT_EQ(change(edge), std::nullopt);
    EXPECT_EQ(sut[1].spec.material, edge.object.material);
    EXPECT_EQ(sut[1].pose.scale, 1.0);
}

} // namespace
} // namespace tactus::test
