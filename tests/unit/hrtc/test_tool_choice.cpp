// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/shapes/shapes.hpp"
#include "platform/choices/run_options.hpp"
#include "platform/choices/tool_choice.hpp"
#include "platform/readers/file_readers.hpp"
#include "platform/report/footprint.hpp"
#include "tests/shared/temporary_folder.hpp"
#include "tests/shared/test_model.hpp"
#include "transport/store/store_link.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>

namespace tactus::hrtc::test
{
namespace
{

TEST(ToolChoice, takes_shapes_by_their_measures)
{
    EXPECT_TRUE(std::holds_alternative<PointCore>(parse_tool("point").value().core));
    EXPECT_EQ(parse_tool("point").value().radius_m, 0.0);
    EXPECT_EQ(parse_tool("sphere:0.002").value().radius_m, 0.002);
    const ToolChoice capsule = parse_tool("capsule:0.002,0.05").value();
    EXPECT_EQ(capsule.radius_m, 0.002);
    EXPECT_EQ(std::get<Segment>(capsule.core).from, Vec3(0.0, 0.0, -0.025));
    EXPECT_EQ(std::get<Segment>(capsule.core).to, Vec3(0.0, 0.0, 0.025));
    const ToolChoice box = parse_tool("box:0.01,0.02,0.03,0.001").value();
    EXPECT_EQ(std::get<Box>(box.core).half, Vec3(0.005, 0.01, 0.015));
    EXPECT_EQ(box.radius_m, 0.001);
    EXPECT_EQ(parse_tool("box:0.01,0.02,0.03").value().radius_m, 0.0);
    EXPECT_EQ(box.words, "box:0.01,0.02,0.03,0.001");
}

TEST(ToolChoice, takes_names_with_commas_and_a_radius_behind_the_last_one)
{
    const ToolChoice hull = parse_tool("hull:a,b.obj,0.001").value();
    EXPECT_EQ(hull.hull_file, "a,b.obj");
    EXPECT_EQ(hull.radius_m, 0.001);
    EXPECT_EQ(parse_tool("hull:a,b.obj").value().hull_file, "a,b.obj");
    const ToolChoice mesh = parse_tool("mesh:probe@0123,0").value();
    EXPECT_EQ(mesh.mesh_model, "probe@0123");
    EXPECT_EQ(mesh.radius_m, 0.0);
}

TEST(ToolChoice, is_a_sphere_within_the_range_by_default)
{
    EXPECT_EQ(default_tool(0.2).radius_m, 0.002);
    EXPECT_EQ(default_tool(0.2).words, "sphere:0.002");
    EXPECT_TRUE(parse_tool(default_tool(1e6).words));
    EXPECT_TRUE(parse_tool(default_tool(1e-6).words));
}

TEST(ToolChoice, reaches_as_far_as_its_farthest_point)
{
    EXPECT_EQ(reach_m(parse_tool("point").value(), nullptr), 0.0);
    EXPECT_EQ(reach_m(parse_tool("sphere:0.25").value(), nullptr), 0.25);
    EXPECT_EQ(reach_m(parse_tool("capsule:0.25,0.5").value(), nullptr), 0.5);
    EXPECT_DOUBLE_EQ(reach_m(parse_tool("box:0.2,0.2,0.1,0.05").value(), nullptr), 0.2);
}

TEST(ToolChoice, is_held_where_it_touches)
{
    EXPECT_EQ(operator_radius_m(parse_tool("point").value(), nullptr, 0.3), 0.003);
    EXPECT_EQ(operator_radius_m(parse_tool("sphere:0.25").value(), nullptr, 0.3), 0.25);
    EXPECT_EQ(operator_radius_m(parse_tool("sphere:0.25").value(), nullptr, 0.2), 0.2);
    EXPECT_EQ(operator_radius_m(parse_tool("capsule:0.25,0.5").value(), nullptr, 0.3), 0.25);
}

/// Folder with files for one test.
struct ToolFiles : testing::Test
{
    /// Options of one tool, a hull from a file with this text.
    Options of_hull(const std::string& text)
    {
        return of("hull:" + folder_.write("hull.off", text).string());
    }
    static Options of(const std::string& tool)
    {
        Options options;
        options.readers = file_readers();
        options.models = {"cow"};
        options.objects = {{}};
        options.tools[0].shape = parse_tool(tool).value();
        return options;
    }
    static std::string refusal_of(Options options)
    {
        const auto error = take_tool_files(options);
        return error ? error->text : "";
    }

    tactus::test::TemporaryFolder folder_{"tool-files"};
};

TEST_F(ToolFiles, are_the_corners_of_a_hull_each_once)
{
    // Corner 3 equals corner 0.
    Options options = of_hull("OFF\n4 2 0\n0 0 0\n0.3 0 0\n0 0.4 0\n0 0 0\n3 0 1 2\n3 3 1 2\n");
    ASSERT_FALSE(take_tool_files(options));
    const ToolChoice& tool = *options.tools[0].shape;
    EXPECT_EQ(std::get<Hull>(tool.core).vertices().size(), 3U);
    EXPECT_EQ(reach_m(tool, nullptr), 0.4);
}

TEST_F(ToolFiles, may_be_flat_or_a_line)
{
    Options options = of_hull("OFF\n3 1 0\n0 0 0\n0.1 0 0\n0.2 0 0\n3 0 1 2\n");
    EXPECT_FALSE(take_tool_files(options));
}

TEST_F(ToolFiles, are_refused_by_name_when_they_hold_no_hull)
{
    std::string many = "OFF\n65 1 0\n";
    for (int i = 0; i < 65; ++i)
    {
        many += "0." + std::to_string(100 + i) + " 0 0\n";
    }
    EXPECT_NE(
        refusal_of(of_hull(many + "3 0 1 2\n")).find("65 corners; the hull of a tool has at most"),
        std::string::npos);
    EXPECT_NE(refusal_of(of_hull("OFF\n3 1 0\n0 0 0\n2 0 0\n0 1 0\n3 0 1 2\n")).find("is 2 m from"),
              std::string::npos);
    EXPECT_NE(refusal_of(of("hull:" + (folder_.path() / "none.obj").string())).find("none.obj"),
              std::string::npos);
}

TEST_F(ToolFiles, add_what_is_a_mesh_to_the_models_once)
{
    Options options = of("mesh:probe");
    options.tools.push_back(options.tools.front());
    ASSERT_FALSE(take_tool_files(options));
    EXPECT_EQ(options.models, (std::vector<std::string>{"cow", "probe"}));
    EXPECT_EQ(std::get<MeshCore>(options.tools[1].shape->core).model, ModelId{1});
    EXPECT_EQ(options.objects.size(), 1U);
}

TEST_F(ToolFiles, refuse_a_mesh_that_is_touched_as_well)
{
    EXPECT_NE(refusal_of(of("mesh:cow")).find("'cow' is the model of an object as well"),
              std::string::npos);
}

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
