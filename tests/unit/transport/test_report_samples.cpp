// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Checks of single samples of telemetry, without a network.

#include "transport/dds/telemetry.hpp"
#include "transport/telemetry_from_frame.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <string>

#include "tactus.h"

namespace tactus::dds
{
namespace
{

constexpr double kFar_m = 2.0 * kPoseReachMax_m;
constexpr const char* kWord = "W\u00FCrfel-\u7ACB\u65B9";
/// Texts that no terminal should get: a control, half a character, a change of direction.
constexpr const char* kUnclear[] = {"a\x1b[31m", "a\xc3", "a\u202E"};

tactus_v5_Placement placement(double x_m, double scale)
{
    return {{0.0, 0.0, 0.0, 1.0}, {x_m, 0.0, 0.0}, scale};
}

/// Telemetry of one object.
bool is_accepted(tactus_v5_ObjectTelemetry object)
{
    tactus_v5_Telemetry sample = {};
    std::strcpy(static_cast<char*>(sample.controller_name), "desk");
    sample.objects = {1, 1, &object, false};
    const auto news = watched_from(sample);
    EXPECT_TRUE(!news || news->objects.objects.at(0).name == static_cast<char*>(object.name));
    return news.has_value();
}

/// Telemetry with the refinement state of one tool.
bool is_accepted(tactus_v5_RefinementStateTool tool)
{
    tactus_v5_RefinementState state = {};
    state.tools = {1, 1, &tool, false};
    tactus_v5_Telemetry sample = {};
    std::strcpy(static_cast<char*>(sample.controller_name), "desk");
    sample.refinement_state = {1, 1, &state, false};
    const auto news = watched_from(sample);
    EXPECT_TRUE(!news || news->state->state.tools.at(0).shape == static_cast<char*>(tool.shape));
    return news.has_value();
}

TEST(ReportSamples, have_the_letters_of_every_language_but_no_controls)
{
    tactus_v5_ObjectTelemetry object = {};
    object.pose = placement(0.0, 1.0);
    tactus_v5_RefinementStateTool tool = {};
    std::strcpy(static_cast<char*>(object.name), kWord);
    std::strcpy(static_cast<char*>(tool.shape), (std::string("mesh:") + kWord).c_str());
    EXPECT_TRUE(is_accepted(object));
    EXPECT_TRUE(is_accepted(tool));
    for (const char* unclear : kUnclear)
    {
        std::strcpy(static_cast<char*>(object.name), unclear);
        std::strcpy(static_cast<char*>(tool.shape), unclear);
        EXPECT_FALSE(is_accepted(object)) << unclear;
        EXPECT_FALSE(is_accepted(tool)) << unclear;
    }
}

TEST(ReportSamples, may_place_an_object_far_away_but_with_a_possible_scale)
{
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    for (const double x_m : {0.0, kFar_m, -kFar_m})
    {
        for (const double scale : {1.0, 0.0, -1.0, 0.5 * kPoseScaleMin, 2.0 * kPoseScaleMax, kNan})
        {
            tactus_v5_ObjectTelemetry object = {};
            object.pose = placement(x_m, scale);
            EXPECT_EQ(is_accepted(object), scale == 1.0) << x_m << ' ' << scale;
        }
    }
}

TEST(ReportSamples, have_poses_of_the_source_mesh_that_lead_back_to_the_models_frame)
{
    Similarity frame;
    frame.rotation = Eigen::Quaterniond(0.8, 0.0, 0.6, 0.0).toRotationMatrix();
    frame.translation_m = {1.0, -2.0, 3.0};
    frame.scale = 2.0;
    const Vec3 origin_m{0.1, 0.2, 0.3};
    const Pose source = source_pose_of(frame, origin_m);
    for (int axis = 0; axis < 3; ++axis) // The source's point `origin_m` is the frame's origin.
    {
        const Vec3 rotated_m = frame.rotation * origin_m;
        EXPECT_NEAR(source.translation_m[static_cast<std::size_t>(axis)],
                    frame.translation_m[axis] - 2.0 * rotated_m[axis], 1e-15);
    }
    const Pose back = frame_pose_of(source, origin_m);
    for (int axis = 0; axis < 3; ++axis)
    {
        EXPECT_NEAR(back.translation_m[static_cast<std::size_t>(axis)], frame.translation_m[axis],
                    1e-15);
    }
    EXPECT_EQ(back.rotation, source.rotation);
    EXPECT_EQ(back.scale, 2.0);
}

} // namespace
} // namespace tactus::dds
