// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_publish/pose_script.hpp"
#include "tests/unit/transport/tiny_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace tactus
{
namespace
{

const std::vector<ScriptedObject> kObjects{{"bunny"}, {"cow"}};
const std::string kNoLine =
    "is neither TIME_S NAME X Y Z QX QY QZ QW [SCALE] nor TIME_S NAME material KEY=VALUE[,...]";

/// Fault of a text; empty if there is none.
std::string fault_of(std::string_view text)
{
    const auto lines = parse_pose_lines(text, kObjects);
    return lines ? "" : lines.error().text;
}

TEST(PoseScript, reads_lines_comments_and_empty_lines)
{
    const auto lines = parse_pose_lines("# two objects\n\n0 cow 1 2 3 0 0 0 1\n"
                                        "  0.5\tbunny -1e-2 0 0  0 0 0.6 0.8 2.5 ",
                                        kObjects);
    ASSERT_TRUE(lines) << lines.error().text;
    ASSERT_EQ(lines.value().size(), 2U);
    const PoseLine& cow = lines.value()[0];
    EXPECT_EQ(cow.time_s, 0.0);
    EXPECT_EQ(cow.object, 1U);
    EXPECT_EQ(cow.pose->translation_m, (std::array{1.0, 2.0, 3.0}));
    EXPECT_EQ(cow.pose->scale, 1.0);
    const PoseLine& bunny = lines.value()[1];
    EXPECT_EQ(bunny.time_s, 0.5);
    EXPECT_EQ(bunny.object, 0U);
    EXPECT_EQ(bunny.pose->translation_m[0], -0.01);
    EXPECT_NEAR(bunny.pose->rotation[2], 0.6, 1e-15);
    EXPECT_NEAR(bunny.pose->rotation[3], 0.8, 1e-15);
    EXPECT_EQ(bunny.pose->scale, 2.5);
}

TEST(PoseScript, a_pose_without_a_scale_keeps_that_of_its_object)
{
    const std::vector<ScriptedObject> objects{{"bunny", 0.025}, {"cow", 4.0}};
    const auto lines = parse_pose_lines("0 bunny 1 2 3 0 0 0 1\n"
                                        "1 cow 0 0 0 0 0 0 1 2\n"
                                        "2 bunny 1 2 4 0 0 0 1\n"
                                        "3 cow gone\n"
                                        "4 cow 0 0 0 0 0 0 1\n"
                                        "5 bunny 0 0 0 0 0 0 1 1\n"
                                        "6 bunny 0 0 0 0 0 0 1\n",
                                        objects);
    ASSERT_TRUE(lines) << lines.error().text;
    std::vector<double> scales;
    for (const PoseLine& line : lines.value())
    {
        scales.push_back(line.pose ? line.pose->scale : 0.0);
    }
    EXPECT_EQ(scales, (std::vector<double>{0.025, 2.0, 0.025, 0.0, 2.0, 1.0, 1.0}));
}

TEST(PoseScript, a_name_of_no_object_is_refused_with_those_there_are)
{
    std::vector<ScriptedObject> objects;
    for (int i = 0; i < 10; ++i)
    {
        objects.push_back({"W\u00FCrfel-" + std::to_string(i)});
    }
    EXPECT_EQ(parse_pose_lines("0 W\u00FCrfel gone", objects).error().text,
              "line 1: no object is called 'W\u00FCrfel'; there are W\u00FCrfel-0, W\u00FCrfel-1, "
              "W\u00FCrfel-2, W\u00FCrfel-3, W\u00FCrfel-4, W\u00FCrfel-5, W\u00FCrfel-6, "
              "W\u00FCrfel-7 and 2 more");
    EXPECT_TRUE(parse_pose_lines("0 W\u00FCrfel-3 gone", objects));
}

TEST(PoseScript, an_object_may_go_and_come_again)
{
    const auto lines =
        parse_pose_lines("0 cow 1 2 3 0 0 0 1\n1 cow gone\n2 cow 1 2 3 0 0 0 1", kObjects);
    ASSERT_TRUE(lines) << lines.error().text;
    EXPECT_TRUE(lines.value()[0].pose);
    EXPECT_FALSE(lines.value()[1].pose);
    EXPECT_TRUE(lines.value()[2].pose);
    EXPECT_EQ(fault_of("0 dog gone"), "line 1: no object is called 'dog'; there are bunny, cow");
    EXPECT_EQ(fault_of("0 cow went"), "line 1: " + kNoLine);
    EXPECT_EQ(fault_of("0 cow gone 1"), "line 1: " + kNoLine);
}

TEST(PoseScript, an_object_may_feel_otherwise)
{
    const auto lines = parse_pose_lines(
        "0 cow material stiffness=300,static=0.5,viscosity=2\n1 cow material static=0\n", kObjects);
    ASSERT_TRUE(lines) << lines.error().text;
    EXPECT_FALSE(lines.value()[0].pose);
    EXPECT_EQ(lines.value()[0].material, (Material{300.0, 0.5, 0.5, 0.0, 2.0}));
    EXPECT_EQ(lines.value()[1].material, Material{}) << "what is left out is as usual";
    EXPECT_EQ(fault_of("0 cow material"), "line 1: " + kNoLine);
    EXPECT_EQ(fault_of("0 cow material static=1 dynamic=1"), "line 1: " + kNoLine);
    for (const char* text :
         {"300,0.5", "static=4", "viscosity=21", "texture_height=1e-4",
          "texture_height=1e-4,texture_length=1e-3", "static=0,static=0", "gone"})
    {
        const std::string fault = fault_of("0 cow material " + std::string(text));
        EXPECT_EQ(fault.find("line 1: material '" + std::string(text) + "' is not KEY=VALUE[,"), 0U)
            << fault;
    }
}

TEST(PoseScript, puts_poses_between_the_lines_of_an_object)
{
    const auto lines = parse_pose_lines("0 cow 0 0 0 0 0 0 1\n"
                                        "0.1 bunny 5 0 0 0 0 0 1\n"
                                        "0.4 cow 4 0 8 0 0 -1 0 3\n"
                                        "0.6 cow gone\n"
                                        "0.9 cow 0 0 0 0 0 0 1\n",
                                        kObjects);
    ASSERT_TRUE(lines) << lines.error().text;
    const auto made = interpolated(lines.value(), kObjects.size(), 10.0);
    ASSERT_TRUE(made) << made.error().text;
    const std::vector<PoseLine>& all = made.value();
    ASSERT_EQ(all.size(), 5U + 3U); // None for the bunny, and none while the cow is gone.
    EXPECT_TRUE(std::ranges::is_sorted(all, {}, &PoseLine::time_s));
    // A quarter of the path; half a turn the other way about z, so an eighth of a turn.
    const auto quarter = std::ranges::find_if(all, [](const PoseLine& line)
                                              { return line.object == 1 && line.time_s > 0.0; });
    EXPECT_NEAR(quarter->time_s, 0.1, 1e-15);
    EXPECT_NEAR(quarter->pose->translation_m[0], 1.0, 1e-15);
    EXPECT_NEAR(quarter->pose->translation_m[2], 2.0, 1e-15);
    EXPECT_NEAR(quarter->pose->scale, 1.5, 1e-15);
    EXPECT_NEAR(std::abs(quarter->pose->rotation[2]), std::sin(M_PI / 8.0), 1e-12);
    EXPECT_NEAR(std::abs(quarter->pose->rotation[3]), std::cos(M_PI / 8.0), 1e-12);
    EXPECT_EQ(interpolated(lines.value(), kObjects.size(), 1.0).value().size(), 5U);
}

TEST(PoseScript, refuses_more_poses_between_lines_than_there_is_room_for)
{
    const auto lines =
        parse_pose_lines("0 cow 0 0 0 0 0 0 1\n1000000 cow 1 0 0 0 0 0 1\n", kObjects);
    ASSERT_TRUE(lines);
    EXPECT_TRUE(interpolated(lines.value(), kObjects.size(), 1.0));
    const auto refused = interpolated(lines.value(), kObjects.size(), 3.0);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().text, "--poses-rate: 3 poses a second give more than 2000000 poses");
}

TEST(PoseScript, names_the_line_and_what_is_wrong_with_it)
{
    const std::string good = "0 cow 1 2 3 0 0 0 1\n";
    EXPECT_EQ(fault_of(""), "has no line TIME_S NAME X Y Z QX QY QZ QW [SCALE]");
    EXPECT_EQ(fault_of("# nothing\n"), "has no line TIME_S NAME X Y Z QX QY QZ QW [SCALE]");
    const std::string& form = kNoLine;
    EXPECT_EQ(fault_of(good + "1 cow 1 2 3 0 0 0\n"), "line 2: " + form);
    EXPECT_EQ(fault_of("1 cow 1 2 3 0 0 0 1 1 1\n"), "line 1: " + form);
    EXPECT_EQ(fault_of("\n# x\n1\n"), "line 3: " + form);
    EXPECT_EQ(fault_of("-1 cow 1 2 3 0 0 0 1"), "line 1: time '-1' is not in 0 .. 1000000 s");
    EXPECT_EQ(fault_of("nan cow 1 2 3 0 0 0 1"), "line 1: time 'nan' is not in 0 .. 1000000 s");
    EXPECT_EQ(fault_of("1e7 cow 1 2 3 0 0 0 1"), "line 1: time '1e7' is not in 0 .. 1000000 s");
    EXPECT_EQ(fault_of("0 dog 1 2 3 0 0 0 1"),
              "line 1: no object is called 'dog'; there are bunny, cow");
    EXPECT_EQ(fault_of("0 \x1b[31m 1 2 3 0 0 0 1"),
              "line 1: no object is called '?[31m'; there are bunny, cow");
    EXPECT_EQ(fault_of("0 cow 1 2 x 0 0 0 1"), "line 1: 'x' is not a finite number");
    EXPECT_EQ(fault_of("0 cow 1 2 3 0 0 0 1,0"), "line 1: '1,0' is not a finite number");
    EXPECT_EQ(fault_of("0 cow 1 2 inf 0 0 0 1"), "line 1: 'inf' is not a finite number");
    EXPECT_EQ(fault_of("0 cow 1 2 3 0 0 0 1\r\n"), "line 1: '1?' is not a finite number");
    EXPECT_EQ(fault_of("0 cow 1 2 3 0 0 0 2"),
              "line 1: QX QY QZ QW must have a length within 0.001 of 1");
    EXPECT_EQ(fault_of("0 cow 0 10001 0 0 0 0 1"), "line 1: X Y Z must be -10000 to 10000 m");
    EXPECT_EQ(fault_of("0 cow 0 0 0 0 0 0 1 0"), "line 1: SCALE must be 0.001 to 1000");
    EXPECT_EQ(fault_of("2 cow 0 0 0 0 0 0 1\n1.5 cow 0 0 0 0 0 0 1\n"),
              "line 2: time 1.5 s is before 2 s, the time of the previous line");
}

TEST(PoseScript, refuses_every_cut_in_the_middle_of_a_line_or_reads_what_is_whole)
{
    const std::string text = "0 cow 1 2 3 0 0 0 1\n0.5 bunny 0 0 0 0 0 0.6 0.8 2.5\n";
    for (std::size_t length = 0; length <= text.size(); ++length)
    {
        const auto lines = parse_pose_lines(text.substr(0, length), kObjects);
        const bool is_first_whole = length >= 19;
        EXPECT_LE(lines ? lines.value().size() : 0, 2U);
        EXPECT_FALSE(!is_first_whole && lines.has_value()) << length;
    }
}

TEST(PoseScript, a_file_is_named_in_what_is_said)
{
    const test::TemporaryFolder folder;
    const auto missing = read_pose_file(folder.path() / "none.txt", kObjects);
    ASSERT_FALSE(missing);
    EXPECT_NE(missing.error().text.find("none.txt: cannot be opened: No such file"),
              std::string::npos);
    const auto unread = read_pose_file(folder.path(), kObjects);
    ASSERT_FALSE(unread);
    const std::string text = "0 cow 1 2 3 0 0 0 1\nx\n";
    const auto path = folder.write("bad.txt", std::as_bytes(std::span(text)));
    const auto bad = read_pose_file(path, kObjects);
    ASSERT_FALSE(bad);
    EXPECT_EQ(bad.error().text, path.string() + ": line 2: " + kNoLine);
}

std::vector<PoseLine> played()
{
    return parse_pose_lines("0 cow 1 0 0 0 0 0 1\n0 bunny 1 0 0 0 0 0 1\n1 cow 2 0 0 0 0 0 1\n"
                            "2 cow 3 0 0 0 0 0 1\n",
                            kObjects)
        .value();
}

TEST(PosePlayer, gives_each_line_when_it_is_due_and_once)
{
    PosePlayer sut(played(), 2, false);
    EXPECT_EQ(sut.next_s(), 0.0);
    EXPECT_EQ(sut.take_due(0.0).size(), 2U);
    EXPECT_TRUE(sut.take_due(0.9).empty());
    EXPECT_EQ(sut.next_s(), 1.0);
    const auto due = sut.take_due(1.1);
    ASSERT_EQ(due.size(), 1U);
    EXPECT_EQ(due[0].pose->translation_m[0], 2.0);
    EXPECT_EQ(sut.take_due(100.0).size(), 1U);
    EXPECT_FALSE(sut.next_s());
    EXPECT_TRUE(sut.take_due(200.0).empty());
}

TEST(PosePlayer, sends_how_an_object_feels_beside_where_it_stands)
{
    const auto lines = parse_pose_lines("0 cow 1 0 0 0 0 0 1\n1 cow material static=0.1\n"
                                        "2 cow material static=0.2\n3 cow 2 0 0 0 0 0 1\n"
                                        "4 bunny material static=0.3\n",
                                        kObjects);
    PosePlayer sut(lines.value(), 2, false);
    const auto due = sut.take_due(5.0);
    ASSERT_EQ(due.size(), 3U);
    EXPECT_EQ(due[0].object, 0U);
    EXPECT_EQ(due[0].material->static_friction, 0.3);
    EXPECT_EQ(due[1].object, 1U);
    EXPECT_EQ(due[1].material->static_friction, 0.2);
    EXPECT_EQ(due[2].pose->translation_m[0], 2.0);
}

TEST(PosePlayer, passes_over_what_is_overtaken)
{
    PosePlayer sut(played(), 2, false);
    const auto due = sut.take_due(5.0);
    ASSERT_EQ(due.size(), 2U);
    EXPECT_EQ(due[0].object, 0U);
    EXPECT_EQ(due[1].pose->translation_m[0], 3.0);
}

TEST(PosePlayer, begins_anew_at_the_last_line_s_time_and_catches_up_after_a_stall)
{
    PosePlayer sut(played(), 2, true);
    EXPECT_EQ(sut.take_due(1.5).size(), 2U);
    const auto turn = sut.take_due(2.0); // The last line, and the first ones after it.
    ASSERT_EQ(turn.size(), 2U);
    EXPECT_EQ(turn[1].pose->translation_m[0], 1.0);
    EXPECT_EQ(sut.next_s(), 3.0);
    const auto late = sut.take_due(2'000'001.5);
    ASSERT_EQ(late.size(), 2U);
    EXPECT_EQ(late[1].pose->translation_m[0], 2.0);
    EXPECT_EQ(sut.next_s(), 2'000'002.0);
}

} // namespace
} // namespace tactus
