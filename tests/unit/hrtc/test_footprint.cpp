// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/shapes/shapes.hpp"
#include "platform/report/report.hpp"
#include "tests/shared/test_model.hpp"
#include "transport/store/store_link.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace tactus::hrtc::test
{

namespace
{

constexpr double kPerSquareMetre = 1e6;
constexpr double kWay_m = 1e-4; ///< Motion of a hand, beyond the radius.

ToolSpec tool_of(const ToolCore& core, double radius_m)
{
    ToolSpec tool;
    tool.core = core;
    tool.radius_m = radius_m;
    return tool;
}

TEST(Footprint, is_the_outline_of_the_core_and_what_is_in_reach_around_it)
{
    const double r = 0.01;
    const double aside = std::sqrt(std::pow(1.05 * r + kWay_m, 2) - r * r);
    const double disc = std::numbers::pi * aside * aside;
    const auto faces = [](const ToolCore& core, double radius_m)
    { return faces_under(tool_of(core, radius_m), kPerSquareMetre) / kPerSquareMetre; };
    EXPECT_DOUBLE_EQ(faces(PointCore{}, r), disc);
    EXPECT_DOUBLE_EQ(faces(Segment{{0, 0, -0.1}, {0, 0, 0.1}}, r), disc + 0.4 * aside);
    EXPECT_DOUBLE_EQ(faces(Box{{0.01, 0.03, 0.02}}, r), disc + 0.04 * 0.06 + 0.2 * aside);
    const std::array<Vec3, 4> corners{
        {{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.0, 0.2, 0.0}, {0.0, 0.0, 0.3}}};
    EXPECT_DOUBLE_EQ(faces(Hull::create(corners).value(), r), disc + 0.06 + 1.0 * aside);
    EXPECT_DOUBLE_EQ(faces(PointCore{}, 0.0), std::numbers::pi * kWay_m * kWay_m);
    EXPECT_EQ(faces(MeshCore{}, r), 0.0);
    EXPECT_EQ(faces_under(tool_of(PointCore{}, r), 0.0), 0.0);
}

TEST(Footprint, counts_the_faces_of_a_model_by_its_base_mesh)
{
    const tactus::test::TestModel& plate =
        tactus::test::test_model("plate-9k", make_shape(Shape::plate, 9'000).value(), 500);
    ServedModel served = serve_from_file(plate.path, "plate", {}).value();
    double area_m2 = 0.0;
    for (const tactus::test::Face& face : plate.faces)
    {
        const Vec3 corner = to_vec3(face[0]);
        area_m2 += 0.5 * (to_vec3(face[1]) - corner).cross(to_vec3(face[2]) - corner).norm();
    }
    const auto all = static_cast<double>(plate.faces.size());
    const FaceDensity density = face_density(served);
    const double per_m2 = density.per_m2;
    EXPECT_NEAR(per_m2, all / area_m2, 0.01 * per_m2);

    const ToolSpec tool = tool_of(PointCore{}, 0.02 * plate.diagonal_m);
    const Footprint once = footprint_of(tool, density, 1.0);
    EXPECT_EQ(once.faces, faces_under(tool, per_m2));
    EXPECT_GT(once.kept, once.faces);
    EXPECT_DOUBLE_EQ(footprint_of(tool, density, 0.5).faces, 4.0 * once.faces);
    const Footprint small_object = footprint_of(tool, density, 1e-4);
    EXPECT_EQ(small_object.faces, all) << "no more than there are";
    EXPECT_EQ(small_object.kept, all);

    served.base.clear();
    EXPECT_EQ(face_density(served).per_m2, 0.0);
    EXPECT_EQ(footprint_of(tool, face_density(served), 1.0).kept, 0.0);
}

} // namespace

} // namespace tactus::hrtc::test
