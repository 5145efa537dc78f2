// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Checks of single samples of telemetry and refinement state, without a network.

#include "transport/dds/front.hpp"
#include "transport/dds/telemetry.hpp"

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

/// Refinement state of one tool and one object.
bool is_accepted(tactus_v5_RefinementStateTool tool, tactus_v5_RefinementStateObject object)
{
    tactus_v5_RefinementState sample = {};
    tactus_v5_RefinementStateModel model = {};
    std::strcpy(static_cast<char*>(sample.controller_name), "desk");
    sample.tools = {1, 1, &tool, false};
    sample.models = {1, 1, &model, false};
    sample.objects = {1, 1, &object, false};
    const auto news = front_from(sample);
    EXPECT_TRUE(!news || news->front.tools.at(0).shape == static_cast<char*>(tool.shape));
    return news.has_value();
}

TEST(ReportSamples, have_the_letters_of_every_language_but_no_controls)
{
    tactus_v5_ObjectTelemetry object = {};
    object.pose = placement(0.0, 1.0);
    tactus_v5_RefinementStateTool tool = {};
    tactus_v5_RefinementStateObject placed = {};
    placed.pose = placement(0.0, 1.0);
    std::strcpy(static_cast<char*>(object.name), kWord);
    std::strcpy(static_cast<char*>(tool.shape), (std::string("mesh:") + kWord).c_str());
    EXPECT_TRUE(is_accepted(object));
    EXPECT_TRUE(is_accepted(tool, placed));
    for (const char* unclear : kUnclear)
    {
        std::strcpy(static_cast<char*>(object.name), unclear);
        std::strcpy(static_cast<char*>(tool.shape), unclear);
        EXPECT_FALSE(is_accepted(object)) << unclear;
        EXPECT_FALSE(is_accepted(tool, placed)) << unclear;
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
            tactus_v5_RefinementStateObject placed = {};
            placed.pose = object.pose;
            EXPECT_EQ(is_accepted(object), scale == 1.0) << x_m << ' ' << scale;
            EXPECT_EQ(is_accepted({}, placed), scale == 1.0) << x_m << ' ' << scale;
        }
    }
}

} // namespace
} // namespace tactus::dds
