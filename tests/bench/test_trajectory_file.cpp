// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/trajectory_file.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/temporary_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

namespace tactus::bench
{

namespace
{

constexpr const char* kUsual = "t,x,y,z,fx,fy,fz";

Result<Trajectory, TrajectoryError> parsed(const std::string& text, const char* columns = kUsual,
                                           double metres_per_unit = 1.0)
{
    return parse_trajectory(text, TrajectoryColumns::parse(columns).value(), metres_per_unit);
}

std::string refusal(const std::string& text, const char* columns = kUsual)
{
    const auto result = parsed(text, columns);
    return result ? "accepted" : result.error().text;
}

std::string column_refusal(std::string_view text)
{
    const auto result = TrajectoryColumns::parse(text);
    return result ? "accepted" : result.error().text;
}

constexpr const char* kTwo = "0 1 2 3 4 5 6\n0.001 1.5 2.5 3.5 -4 -5 -6e-1\n";

TEST(TrajectoryFile, columns_become_time_position_and_force)
{
    const Trajectory sut = parsed(kTwo, kUsual, 0.5).value();

    ASSERT_EQ(sut.samples.size(), 2U);
    EXPECT_TRUE(sut.has_force_direction);
    EXPECT_EQ(sut.samples[1].time_s, 0.001);
    EXPECT_EQ(sut.samples[1].position_m, Vec3(0.75, 1.25, 1.75));
    EXPECT_EQ(sut.samples[1].force_n, Vec3(-4.0, -5.0, -0.6));
    EXPECT_EQ(sut.duration_s(), 0.001);
}

TEST(TrajectoryFile, columns_may_come_in_any_order_and_sign_and_be_passed_over)
{
    const Trajectory sut =
        parsed("9 1 0 8 2 3 4 5 6\n9 1 1 8 2 3 4 5 6\n", "_,-fz,t,_,x,z,y,fy,-fx").value();

    EXPECT_EQ(sut.samples[0].position_m, Vec3(2.0, 4.0, 3.0));
    EXPECT_EQ(sut.samples[0].force_n, Vec3(-6.0, 5.0, -1.0));
}

TEST(TrajectoryFile, a_force_may_be_an_amount)
{
    const Trajectory sut = parsed("0 1 2 3 0.25\n1 1 2 3 0.5\n", "t,x,y,z,fn").value();

    EXPECT_FALSE(sut.has_force_direction);
    EXPECT_EQ(sut.samples[1].force_n.norm(), 0.5);
}

TEST(TrajectoryFile, titles_come_first_comments_anywhere_and_lines_may_end_in_cr_lf)
{
    const Trajectory sut = parsed("Probe over a plane\r\ntime x y z\r\n# 1 kHz\r\n\r\n"
                                  "\t0  1 2\t3 4 5 6 \r\n% middle\r\n1 1 2 3 4 5 6\r\n  \r\n")
                               .value();

    EXPECT_EQ(sut.samples.size(), 2U);
    EXPECT_EQ(sut.samples[0].force_n.z(), 6.0);
}

TEST(TrajectoryFile, names_the_line_and_what_is_wrong_there)
{
    const std::string two = kTwo;
    EXPECT_EQ(refusal(two + "0.002 1 2 3 4 5\n"), "line 3: 6 columns; a sample has 7");
    EXPECT_EQ(refusal(two + "0.002 1 2 3 4 5 6 7\n"), "line 3: 8 columns; a sample has 7");
    EXPECT_EQ(refusal(two + "0.002 1 2 3 4 5 6,\n"), "line 3: column 7: '6,' is no finite number");
    EXPECT_EQ(refusal("nan 1 2 3 4 5 6\n" + two), "line 1: column 1: 'nan' is no finite number");
    EXPECT_EQ(refusal(two + "0.002 1 2 inf 4 5 6\n"),
              "line 3: column 4: 'inf' is no finite number");
    EXPECT_EQ(refusal(two + "0.002 1 2 3 4 5 1e999\n"),
              "line 3: column 7: '1e999' is no finite number");
    EXPECT_EQ(refusal(two + "title\n"), "line 3: column 1: 'title' is no finite number");
    EXPECT_EQ(refusal(two + "0.001 1 2 3 4 5 6\n"),
              "line 3: time 0.001 s is not after the sample's before, 0.001 s");
    EXPECT_EQ(refusal(two + "-1 1 2 3 4 5 6\n"),
              "line 3: time -1 s is not after the sample's before, 0.001 s");
    EXPECT_EQ(refusal(two + "1 1 2e6 3 4 5 6\n"),
              "line 3: a coordinate is not within 1000000 m of 0");
    EXPECT_EQ(refusal(two + "1 1 2 3 4 5 2e6\n"), "line 3: a force of more than 1000000 N");
    EXPECT_EQ(refusal(two + "1 1 2 3 4 5 6"),
              "line 3: no line end; the file may have been cut there");
}

TEST(TrajectoryFile, needs_two_samples)
{
    EXPECT_EQ(refusal(""), "line 0: the file ends after 0 samples; at least 2 are needed");
    EXPECT_EQ(refusal("# nothing\n\n"),
              "line 2: the file ends after 0 samples; at least 2 are needed");
    EXPECT_EQ(refusal("0 1 2 3 4 5 6\n"),
              "line 1: the file ends after 1 samples; at least 2 are needed");
}

TEST(TrajectoryFile, takes_sixteen_lines_of_titles_and_no_more)
{
    std::string titles;
    for (std::size_t i = 0; i < kMaxTitleLines; ++i)
    {
        titles += "title\n";
    }
    EXPECT_EQ(refusal(titles + kTwo), "accepted");
    EXPECT_EQ(refusal(titles + "one more\n" + kTwo),
              "line 17: 'one' is no number; at most 16 lines of titles may come before the first "
              "sample");
}

/// Cut anywhere but at a line's end the file is refused; there it is a shorter file.
TEST(TrajectoryFile, is_refused_when_it_is_cut_within_a_line)
{
    std::string whole = "time and the rest\r\n# probe\n";
    for (int i = 0; i < 5; ++i)
    {
        whole += fmt::format("{} {} 20.25 -3e-2 0.5 1 -1.125{}", 0.001 * i, 10 + i,
                             i % 2 == 0 ? "\n" : "\r\n");
    }
    ASSERT_EQ(parsed(whole).value().samples.size(), 5U);
    for (std::size_t length = 0; length < whole.size(); ++length)
    {
        const std::string cut = whole.substr(0, length);
        const auto result = parsed(cut);
        const auto lines = static_cast<std::size_t>(std::ranges::count(cut, '\n'));
        const bool is_whole_line = length > 0 && cut.back() == '\n';
        ASSERT_EQ(result.has_value(), is_whole_line && lines >= 4) << length;
        ASSERT_TRUE(!result || result.value().samples.size() == lines - 2) << length;
    }
}

TEST(TrajectoryFile, survives_garbage)
{
    test::Random random(906);
    const std::string whole = kTwo;
    for (int i = 0; i < 20'000; ++i)
    {
        std::string text = whole + whole;
        for (std::size_t changes = 1 + random.below(std::size_t{4}); changes > 0; --changes)
        {
            text[random.below(text.size())] = static_cast<char>(random.below(256U));
        }
        const auto result = parsed(text);
        ASSERT_TRUE(result || result.error().text.starts_with("line ")) << text;
        ASSERT_TRUE(!result || result.value().duration_s() > 0.0) << text;
    }
}

TEST(TrajectoryFile, a_file_s_name_stands_before_its_error)
{
    const test::TemporaryFolder folder("trajectory");
    const auto columns = TrajectoryColumns::parse(kUsual).value();
    const auto refused = [&](const std::filesystem::path& path)
    {
        const auto result = read_trajectory(path, columns, 1.0);
        return result ? "accepted" : result.error().text;
    };
    const std::filesystem::path path = folder.path() / "probe.traj";
    EXPECT_EQ(refused(path), path.string() + ": no such file");
    EXPECT_EQ(refused(folder.path()), folder.path().string() + ": is not a regular file");
    std::ofstream(path) << kTwo << "1 2\n";
    EXPECT_EQ(refused(path), path.string() + ": line 3: 2 columns; a sample has 7");
    std::ofstream(path) << kTwo;
    EXPECT_EQ(refused(path), "accepted");
}

TEST(TrajectoryColumns, are_refused_unless_all_are_there_once)
{
    const std::string allowed =
        "; allowed are t, x, y, z, fx, fy, fz or fn, each once, - before one, and _";
    EXPECT_EQ(column_refusal(kUsual), "accepted");
    EXPECT_EQ(column_refusal("t,x,y,z,fn"), "accepted");
    EXPECT_EQ(column_refusal(""), "column 1: ''" + allowed);
    EXPECT_EQ(column_refusal("t,x,y,z,fx,fy,fz,"), "column 8: ''" + allowed);
    EXPECT_EQ(column_refusal("t,x,y,z,fx,fy,fz,fz"), "column 8: 'fz'" + allowed);
    EXPECT_EQ(column_refusal("t,x,y,q,fx,fy,fz"), "column 4: 'q'" + allowed);
    EXPECT_EQ(column_refusal("t,x,y,--z,fx,fy,fz"), "column 4: '-z'" + allowed);
    EXPECT_EQ(column_refusal("t,x,y,fx,fy,fz"), "z is missing" + allowed);
    EXPECT_EQ(column_refusal("t,x,y,z,fx,fz"), "fy is missing" + allowed);
    EXPECT_EQ(column_refusal("t,x,y,z,fn,fy"), "fy stands beside fn" + allowed);
    EXPECT_EQ(column_refusal("t,x,y,z,fn,fx"), "column 6: 'fx'" + allowed);
    std::string many = kUsual;
    for (std::size_t i = 7; i < kMaxTrajectoryColumns; ++i)
    {
        many += ",_";
    }
    EXPECT_EQ(column_refusal(many), "accepted");
    EXPECT_EQ(column_refusal(many + ",_"), "more than 32 columns");
}

} // namespace

} // namespace tactus::bench
