// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/export/frame_export.hpp"
#include "rt_core/math/infinity.hpp"
#include "tests/shared/temporary_folder.hpp"
#include "tests/unit/recording/recorded_example.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <sstream>

namespace tactus::test
{
namespace
{

using Json = nlohmann::json;

std::string text_of(const std::filesystem::path& path)
{
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

/// A frame whose values are all others, as it was recorded and replayed.
struct Example
{
    ExampleFrame frame;
    RecordedFrame given;
    RecordedSetup setup;
    ContactReport touch;

    Example() : setup(example_setup(make_tiny_model({})))
    {
        given.now_ns = 3'000'000'123;
        given.tools.assign(frame.tools.begin(), frame.tools.end());
        given.devices.assign(frame.devices.begin(), frame.devices.end());
        given.changes.assign(frame.changes.begin(), frame.changes.end());
        given.budgets = frame.budgets;
        given.wish_room = 9;
        given.events.assign(frame.events.begin(), frame.events.end());
        ToolOutput& tool = frame.tool_outputs[0];
        tool.force_n = Vec3(51.0, 52.0, 53.0);
        tool.torque_nm = Vec3(54.0, 55.0, 56.0);
        tool.proxy_m = Vec3(57.0, 58.0, 59.0);
        tool.stiffness_n_per_m = 60.0;
        tool.lag_m = 61.0;
        tool.in_contact = true;
        tool.held_back = true;
        tool.sample_fault = FrameFault::tool_stuck;
        PairOutput& pair = frame.pair_outputs[0];
        pair.object = 3;
        pair.kind = AnswerKind::exact;
        pair.point_m = Vec3(62.0, 63.0, 64.0);
        pair.lower_m = 65.0;
        pair.upper_m = 66.0;
        pair.certified_radius_m = 67.0;
        pair.nearest_face = FaceId{68};
        pair.nearest_point_m = Vec3(69.0, 70.0, 71.0);
        pair.nearest_feature = TriangleFeature::edge_2;
        pair.damping_n_s_per_m = 72.0;
        touch.normal = Vec3(0.0, 0.0, 1.0);
        touch.side = Side::outside;
        pair.contacts = &touch;
        ModelOutput& model = frame.model_outputs[0];
        model.pages.used = 73;
        model.index_pages.used = 74;
        model.faces.used = 75;
        model.blocks.used = 76;
        model.nodes.used = 77;
        model.refined_records = 78;
        model.stage = ModelStage::leaving;
    }

    [[nodiscard]] FrameOutput output() const
    {
        FrameOutput output = frame.output();
        output.work.splits = 79;
        output.work.cache_misses = 80;
        output.work.skipped.add(Skip::pairs, 81);
        output.faults = FrameFault::chunk_late | FrameFault::proxy_frozen;
        output.scene = {82, 83, 84, 85, 86, {0, 0, 87}};
        return output;
    }
};

/// Exports the example under this name, as often as there are frames.
std::string exported(const std::string& name, const Example& example, std::uint64_t frames)
{
    const TemporaryFolder folder;
    const auto path = folder.path() / name;
    {
        auto sut = FrameExport::create(path.string(), example.setup);
        EXPECT_TRUE(sut) << sut.error().text;
        const FrameOutput output = example.output();
        for (std::uint64_t i = 0; i < frames; ++i)
        {
            sut.value()->add({i, 1'000'000'123, example.given, output});
        }
        EXPECT_FALSE(std::filesystem::exists(path));
        EXPECT_TRUE(sut.value()->commit());
    }
    return text_of(path);
}

TEST(FrameExport, knows_its_formats_by_the_ending)
{
    for (const char* name : {"a.csv", "a.jsonl", "a.mcap", "a.b/c.csv"})
    {
        EXPECT_TRUE(is_export_name(name)) << name;
    }
    for (const char* name : {"", "csv", "a.json", "a.CSV", "a.csv ", "a.csv.gz"})
    {
        EXPECT_FALSE(is_export_name(name)) << name;
    }
}

TEST(FrameExport, tells_every_value_under_its_name)
{
    const std::string text = exported("a.jsonl", Example(), 2);
    std::istringstream lines(text);
    std::string first;
    std::string second;
    std::getline(lines, first);
    std::getline(lines, second);
    const Json frame = Json::parse(second);
    EXPECT_FALSE(frame.contains("setup"));
    EXPECT_EQ(frame.at("frame"), 1);
    EXPECT_EQ(frame.at("time_ns"), 3'000'000'123);
    EXPECT_EQ(frame.at("time_s"), 2.0);
    EXPECT_EQ(frame.at("faults"), Json({"chunk_late", "proxy_frozen"}));
    EXPECT_EQ(frame.at("splits"), 79);
    EXPECT_EQ(frame.at("cache_misses"), 80);
    EXPECT_EQ(frame.at("skipped_pairs"), 81);
    EXPECT_EQ(frame.at("budget_splits"), 11);
    EXPECT_EQ(frame.at("budget_regions"), 18);
    EXPECT_EQ(frame.at("arrivals"), 1);
    EXPECT_EQ(frame.at("link_updates"), 1);
    EXPECT_EQ(frame.at("wish_room"), 9);
    EXPECT_EQ(frame.at("objects"), 82);
    EXPECT_EQ(frame.at("walks"), 86);
    EXPECT_EQ(frame.at("refused_already_here"), 87);

    const Json& tool = frame.at("tools").at(0);
    EXPECT_EQ(tool.at("goal_world_m"), Json({0.5, -0.25, 2.0}));
    EXPECT_EQ(tool.at("sample_time_ns"), 77);
    EXPECT_EQ(tool.at("elapsed_periods"), 3);
    EXPECT_EQ(tool.at("hand_world_m"), Json({31.0, 32.0, 33.0}));
    EXPECT_EQ(tool.at("velocity_world_m_per_s"), Json({34.0, 35.0, 36.0}));
    EXPECT_EQ(tool.at("angular_velocity_world_rad_per_s"), Json({37.0, 38.0, 39.0}));
    EXPECT_EQ(tool.at("buttons"), 40);
    EXPECT_EQ(tool.at("gripper_m"), 41.0);
    EXPECT_EQ(tool.at("sent_force_world_n"), Json({42.0, 43.0, 44.0}));
    EXPECT_EQ(tool.at("sent_torque_world_nm"), Json({45.0, 46.0, 47.0}));
    EXPECT_EQ(tool.at("sent_gripper_n"), 48.0);
    EXPECT_EQ(tool.at("force_world_n"), Json({51.0, 52.0, 53.0}));
    EXPECT_EQ(tool.at("torque_world_nm"), Json({54.0, 55.0, 56.0}));
    EXPECT_EQ(tool.at("proxy_world_m"), Json({57.0, 58.0, 59.0}));
    EXPECT_EQ(tool.at("stiffness_n_per_m"), 60.0);
    EXPECT_EQ(tool.at("lag_m"), 61.0);
    EXPECT_EQ(tool.at("clear_m"), nullptr); // Infinite.
    EXPECT_EQ(tool.at("in_contact"), true);
    EXPECT_EQ(tool.at("held_back"), true);
    EXPECT_EQ(tool.at("frozen"), false);
    EXPECT_EQ(tool.at("faults"), Json({"tool_stuck"}));
    // A third of a turn about (1, 1, 1), which takes y to x.
    const auto turn = tool.at("goal_rotation_world").get<std::vector<double>>();
    const double sign = turn.at(3) < 0.0 ? -1.0 : 1.0;
    EXPECT_NEAR(turn.at(0) * sign, -0.5, 1e-15);
    EXPECT_NEAR(turn.at(1) * sign, -0.5, 1e-15);
    EXPECT_NEAR(turn.at(2) * sign, -0.5, 1e-15);
    EXPECT_NEAR(turn.at(3) * sign, 0.5, 1e-15);

    const Json& pair = frame.at("pairs").at(0);
    EXPECT_EQ(pair.at("object"), 3);
    EXPECT_EQ(pair.at("answer"), "exact");
    EXPECT_EQ(pair.at("point_world_m"), Json({62.0, 63.0, 64.0}));
    EXPECT_EQ(pair.at("lower_m"), 65.0);
    EXPECT_EQ(pair.at("upper_m"), 66.0);
    EXPECT_EQ(pair.at("certified_radius_m"), 67.0);
    EXPECT_EQ(pair.at("nearest_face"), 68);
    EXPECT_EQ(pair.at("nearest_point_world_m"), Json({69.0, 70.0, 71.0}));
    EXPECT_EQ(pair.at("nearest_feature"), "edge_2");
    EXPECT_EQ(pair.at("damping_n_s_per_m"), 72.0);
    EXPECT_EQ(pair.at("normal_world"), Json({0.0, 0.0, 1.0}));
    EXPECT_EQ(pair.at("side"), "outside");
    EXPECT_EQ(pair.at("contacts"), 0);
    EXPECT_EQ(pair.at("meeting_faces"), nullptr);

    const Json& model = frame.at("models").at(0);
    EXPECT_EQ(model.at("pages_used"), 73);
    EXPECT_EQ(model.at("index_pages_used"), 74);
    EXPECT_EQ(model.at("faces_used"), 75);
    EXPECT_EQ(model.at("blocks_used"), 76);
    EXPECT_EQ(model.at("nodes_used"), 77);
    EXPECT_EQ(model.at("refined_records"), 78);
    EXPECT_EQ(model.at("stage"), "leaving");

    const Json& changes = frame.at("changes");
    EXPECT_EQ(changes.at(0).at("change"), "object_moves");
    EXPECT_EQ(changes.at(0).at("translation_world_m"), Json({0.125, 4.0, -8.0}));
    EXPECT_EQ(changes.at(0).at("scale"), 1.5);
    EXPECT_EQ(changes.at(0).at("static_friction"), nullptr);
    EXPECT_EQ(changes.at(1).at("change"), "object_comes");
    EXPECT_EQ(changes.at(1).at("generation"), 7);
    EXPECT_EQ(changes.at(1).at("model"), 0);
    EXPECT_EQ(changes.at(1).at("static_friction"), 0.4);
    EXPECT_EQ(changes.at(2).at("change"), "object_feels");
    EXPECT_EQ(changes.at(2).at("translation_world_m"), nullptr);

    const Json setup = Json::parse(first).at("setup");
    EXPECT_EQ(setup.at("period_ns"), 1'000'000);
    EXPECT_EQ(setup.at("prediction"), "quadratic");
    EXPECT_EQ(setup.at("compiler"), "some compiler");
    EXPECT_EQ(setup.at("tools").at(0).at("core"), "point");
    EXPECT_EQ(setup.at("tools").at(0).at("angular_stiffness_nm_per_rad"), 0.75);
    EXPECT_EQ(setup.at("tools").at(0).at("smooth_m"), 0.002);
    EXPECT_EQ(setup.at("objects").at(0).at("translation_world_m"), Json({1.0, 2.0, 3.0}));
    EXPECT_EQ(setup.at("objects").at(0).at("dynamic_friction"), 0.25);
    EXPECT_EQ(setup.at("models").at(0).at("faces"), 400);
}

/// A device may say what is no rotation; no tool should have to read that.
TEST(FrameExport, does_not_know_a_rotation_that_is_none)
{
    Example example;
    example.given.tools[0].rotation.setConstant(kInfinity);
    const Json frame = Json::parse(exported("a.jsonl", example, 1));
    EXPECT_EQ(frame.at("tools").at(0).at("goal_rotation_world"), nullptr);
}

TEST(FrameExport, has_the_names_of_columns_once)
{
    const std::string text = exported("a.csv", Example(), 3);
    std::istringstream lines(text);
    std::string line;
    std::getline(lines, line);
    const auto commas = std::ranges::count(line, ',');
    EXPECT_TRUE(line.starts_with("frame,time_ns,time_s,faults,splits,")) << line;
    EXPECT_NE(line.find(",tool0.nearest.nearest_point_world_m.z,"), std::string::npos);
    int rows = 0;
    while (std::getline(lines, line))
    {
        ++rows;
        EXPECT_EQ(std::ranges::count(line, ','), commas);
        EXPECT_EQ(line.back(), '\r');
    }
    EXPECT_EQ(rows, 3);
}

TEST(FrameExport, leaves_nothing_where_it_is_not_committed)
{
    const TemporaryFolder folder;
    const Example example;
    for (const char* name : {"a.csv", "a.jsonl", "a.mcap"})
    {
        auto sut = FrameExport::create((folder.path() / name).string(), example.setup);
        ASSERT_TRUE(sut);
        sut.value()->add({0, 0, example.given, example.output()});
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(FrameExport, is_refused_where_no_file_can_be)
{
    const TemporaryFolder folder;
    const Example example;
    const auto sut =
        FrameExport::create((folder.path() / "none" / "a.csv").string(), example.setup);
    ASSERT_FALSE(sut);
    EXPECT_NE(sut.error().text.find("a.csv: can't be written"), std::string::npos)
        << sut.error().text;
}

} // namespace
} // namespace tactus::test
