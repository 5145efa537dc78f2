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

/// Frame with all values different, recorded and replayed.
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
        given.request_room = 9;
        given.events.assign(frame.events.begin(), frame.events.end());
        ToolOutput& tool = frame.tool_outputs[0];
        tool.force_n = Vec3(51.0, 52.0, 53.0);
        tool.torque_nm = Vec3(54.0, 55.0, 56.0);
        tool.proxy_m = Vec3(57.0, 58.0, 59.0);
        tool.stiffness_n_per_m = 60.0;
        tool.lag_m = 61.0;
        tool.object_way_m = 88.0;
        tool.object_rotation_rad = 89.0;
        tool.carried_m = Vec3(90.0, 91.0, 92.0);
        tool.carried_rad = Vec3(93.0, 94.0, 95.0);
        tool.in_contact = true;
        tool.data_limited = true;
        tool.sample_fault = FrameFault::tool_stuck;
        PairOutput& pair = frame.pair_outputs[0];
        pair.object = 3;
        pair.kind = AnswerKind::exact;
        pair.tool_m = Vec3(97.0, 98.0, 99.0);
        pair.point_m = Vec3(62.0, 63.0, 64.0);
        pair.lower_m = 65.0;
        pair.upper_m = 66.0;
        pair.certified_radius_m = 67.0;
        pair.tolerated_m = 96.0;
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
        output.faults = FrameFault::chunk_late | FrameFault::proxy_halted;
        output.scene = {82, 83, 84, 85, 86, {0, 0, 87}};
        return output;
    }
};

/// Exports the example under this name, repeated `frames` times.
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

/// Paths of `expected` with another value in `told`.
std::vector<std::string> told_otherwise(const Json& expected, const Json& told)
{
    std::vector<std::string> paths;
    const Json flat = expected.flatten();
    for (const auto& [path, value] : flat.items())
    {
        const Json::json_pointer pointer(path);
        const Json::json_pointer holder = pointer.parent_pointer();
        if (!told.contains(pointer) || told.at(pointer) != value ||
            (told.at(holder).is_array() && told.at(holder).size() != expected.at(holder).size()))
        {
            paths.push_back(path);
        }
    }
    return paths;
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
    EXPECT_EQ(told_otherwise(Json::parse(R"({
        "frame": 1, "time_ns": 3000000123, "time_s": 2.0, "faults": ["chunk_late", "proxy_halted"],
        "splits": 79, "cache_misses": 80, "skipped_pairs": 81, "budget_splits": 11,
        "budget_regions": 18, "arrivals": 1, "link_updates": 1, "request_room": 9, "objects": 82,
        "traversals": 86, "refused_already_here": 87,
        "tools": [{
            "device_world_m": [0.5, -0.25, 2.0], "sample_time_ns": 77, "elapsed_periods": 3,
            "clutched_device_world_m": [31.0, 32.0, 33.0],
            "velocity_world_m_per_s": [34.0, 35.0, 36.0],
            "angular_velocity_world_rad_per_s": [37.0, 38.0, 39.0], "buttons": 40,
            "gripper_m": 41.0, "sent_force_world_n": [42.0, 43.0, 44.0],
            "sent_torque_world_nm": [45.0, 46.0, 47.0], "sent_gripper_n": 48.0,
            "force_world_n": [51.0, 52.0, 53.0], "torque_world_nm": [54.0, 55.0, 56.0],
            "proxy_world_m": [57.0, 58.0, 59.0], "stiffness_n_per_m": 60.0, "lag_m": 61.0,
            "clear_m": null, "object_way_m": 88.0, "object_rotation_rad": 89.0,
            "carried_world_m": [90.0, 91.0, 92.0], "carried_world_rad": [93.0, 94.0, 95.0],
            "in_contact": true, "data_limited": true, "halted": false,
            "faults": ["tool_stuck"]}],
        "pairs": [{
            "object": 3, "answer": "exact", "tool_world_m": [97.0, 98.0, 99.0],
            "tool_rotation_world": [0.0, 0.0, 0.0, 1.0],
            "point_world_m": [62.0, 63.0, 64.0], "lower_m": 65.0, "upper_m": 66.0,
            "certified_radius_m": 67.0, "tolerated_m": 96.0, "nearest_face": 68,
            "nearest_point_world_m": [69.0, 70.0, 71.0], "nearest_feature": "edge_2",
            "damping_n_s_per_m": 72.0, "normal_world": [0.0, 0.0, 1.0], "side": "outside",
            "contacts": 0, "meeting_faces": null}],
        "models": [{
            "pages_used": 73, "index_pages_used": 74, "faces_used": 75, "blocks_used": 76,
            "nodes_used": 77, "refined_records": 78, "stage": "leaving"}],
        "changes": [
            {"change": "object_moves", "translation_world_m": [0.125, 4.0, -8.0], "scale": 1.5,
             "static_friction": null},
            {"change": "object_comes", "generation": 7, "model": 0, "static_friction": 0.4},
            {"change": "object_feels", "translation_world_m": null}]})"),
                             frame),
              std::vector<std::string>{});
    // The rotation is a third of a turn about (1, 1, 1), which maps y to x.
    const auto turn =
        frame.at("tools").at(0).at("device_rotation_world").get<std::array<double, 4>>();
    const double sign = turn[3] < 0.0 ? -1.0 : 1.0;
    for (std::size_t i = 0; i < turn.size(); ++i)
    {
        EXPECT_NEAR(turn[i] * sign, i < 3 ? -0.5 : 0.5, 1e-15);
    }
    EXPECT_EQ(told_otherwise(Json::parse(R"({"setup": {
        "period_ns": 1000000, "prediction": "quadratic", "compiler": "some compiler",
        "tools": [{"core": "point", "angular_stiffness_nm_per_rad": 0.75, "shading_m": 0.002}],
        "objects": [{"translation_world_m": [1.0, 2.0, 3.0], "dynamic_friction": 0.25}],
        "models": [{"faces": 400}]}})"),
                             Json::parse(first)),
              std::vector<std::string>{});
}

TEST(FrameExport, names_each_intersection_of_two_meshes)
{
    MeshReport report;
    Example example;
    example.frame.pair_outputs[0].mesh = &report;
    for (std::size_t i = 0; i < kIntersections; ++i)
    {
        report.intersection = static_cast<Intersection>(i);
        const Json frame = Json::parse(exported("a.jsonl", example, 1));
        EXPECT_EQ(frame.at("pairs").at(0).at("intersection"), kIntersectionNames.at(i));
    }
}

/// A device may send an invalid rotation, which no program should have to read.
TEST(FrameExport, does_not_know_a_rotation_that_is_none)
{
    Example example;
    example.given.tools[0].rotation.setConstant(kInfinity);
    const Json frame = Json::parse(exported("a.jsonl", example, 1));
    EXPECT_EQ(frame.at("tools").at(0).at("device_rotation_world"), nullptr);
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
