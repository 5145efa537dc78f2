// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/controller/histogram_folder.hpp"
#include "platform/loop/run_statistics.hpp"
#include "platform/report/report.hpp"
#include "rt_core/frame/frame.hpp"
#include "tests/shared/temporary_folder.hpp"
#include "tests/unit/hrtc/period.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <functional>
#include <random>
#include <set>
#include <sstream>
#include <vector>

namespace tactus::hrtc::test
{
namespace
{

constexpr std::uint32_t kModels = 2;
constexpr std::uint32_t kTools = 1;
constexpr std::uint32_t kPairs = kTools * kModels;

/// Consecutive frames of two models under one tool.
struct StatisticsRig
{
    StatisticsRig()
    {
        output_.tools = tools_;
        output_.pairs = pairs_;
        output_.models = models_;
        measures_.cycle.periods = 1;
    }

    void frame(const std::function<void(FrameOutput&, CycleMeasures&)>& change)
    {
        FrameOutput output = output_;
        CycleMeasures measures = measures_;
        change(output, measures);
        sut.add(output, forces_, measures);
    }
    /// Adds a frame of a tool with or without contact, with this force.
    void touch(bool in_contact, double force_n, ForceOff causes = ForceOff::none)
    {
        tools_[0].in_contact = in_contact;
        forces_[0].push.force_n = Vec3(force_n, 0.0, 0.0);
        forces_[0].causes = causes;
        frame([](FrameOutput&, CycleMeasures&) {});
    }

    RunStatistics sut{kTools, kPairs, kModels, kPeriod};

private:
    std::array<ToolOutput, kTools> tools_{};
    std::array<PairOutput, kPairs> pairs_{};
    std::array<ModelOutput, kModels> models_{};
    std::array<ToolForce, kTools> forces_{};
    FrameOutput output_;
    CycleMeasures measures_;
};

/// Budgets belong to the frame, independent of the models, and count several walks.
TEST(RunStatistics, counts_a_frame_as_over_budget_from_one_beyond_what_it_may_do)
{
    StatisticsRig run;
    const auto with = [&run](auto change)
    {
        run.frame([change](FrameOutput& output, CycleMeasures& measures)
                  { change(output.work, measures.budgets); });
        return run.sut.deadlines.cycles_with(CycleFlag::over_work);
    };
    EXPECT_EQ(
        with([](WorkCounters& work, const Budgets& budgets) { work.splits = budgets.splits; }), 0U);
    EXPECT_EQ(
        with([](WorkCounters& work, const Budgets& budgets) { work.splits = budgets.splits + 1; }),
        1U);
    EXPECT_EQ(with([](WorkCounters& work, const Budgets& budgets)
                   { work.nodes_visited = 2 * kFrameWalks * budgets.nodes; }),
              1U);
    EXPECT_EQ(with([](WorkCounters& work, const Budgets& budgets)
                   { work.nodes_visited = 2 * kFrameWalks * budgets.nodes + 1; }),
              2U);
    EXPECT_EQ(with([](WorkCounters& work, const Budgets& budgets)
                   { work.requests = budgets.requests + budgets.regions + 1; }),
              3U);
    EXPECT_EQ(run.sut.deadlines.overruns, 3U);
    EXPECT_EQ(run.sut.frames, 5U);
}

/// A long frame is an overrun if its work is more than a quick frame showed to fit: four times that
/// frame's work.
TEST(RunStatistics, compares_long_frames_with_quick_ones_by_their_work)
{
    for (const std::uint32_t done : {12'000U, 12'001U})
    {
        StatisticsRig run;
        run.frame([](FrameOutput& output, CycleMeasures&) { output.work.budget.spend(3'000); });
        run.frame(
            [done](FrameOutput& output, CycleMeasures& measures)
            {
                output.work.budget.spend(done);
                measures.cpu = kPeriod;
            });
        EXPECT_EQ(run.sut.deadlines.overruns, done == 12'000 ? 0U : 1U);
    }
}

TEST(RunStatistics, takes_no_damping_in_free_air_for_a_force_of_what_is_touched)
{
    StatisticsRig run;
    run.touch(false, 2.0, ForceOff::stall);
    run.touch(false, 0.0);
    run.touch(true, 0.5);
    run.touch(false, 2.0, ForceOff::velocity);
    run.touch(true, 0.25);
    EXPECT_EQ(run.sut.tools[0].max_n, 0.5);
    EXPECT_EQ(run.sut.tools[0].max_step_n, 0.5);
}

TEST(RunStatistics, tells_contact_from_force_and_leaves_out_the_end_of_the_run)
{
    StatisticsRig run;
    run.touch(false, 0.25, ForceOff::stall); // Damping in the air is a force without contact.
    run.touch(true, 0.0, ForceOff::stall);
    run.touch(true, 0.5);
    run.touch(true, 1.0);
    run.touch(true, 3.0, ForceOff::software);
    run.touch(false, 9.0, ForceOff::software | ForceOff::stall);
    EXPECT_EQ(run.sut.contact_frames, 4U);
    EXPECT_EQ(run.sut.force_frames, 3U);
    const ForceCounts& tool = run.sut.tools[0];
    EXPECT_EQ(tool.contact_frames, 4U);
    EXPECT_EQ(tool.force_frames, 3U);
    EXPECT_EQ(tool.max_n, 1.0);
    EXPECT_EQ(tool.max_step_n, 0.5);
}

SeriesPoint random_point(std::mt19937& random)
{
    std::uniform_real_distribution<float> values(0.0F, 100.0F);
    SeriesPoint point{.force_n = values(random),
                      .width_m = values(random),
                      .frame_us = values(random),
                      .stage_us = {}};
    std::ranges::generate(point.stage_us, [&] { return values(random); });
    return point;
}

/// Maximum of each `stride` numbers.
std::vector<float> largest(const std::vector<float>& values, std::size_t stride)
{
    std::vector<float> result;
    for (std::size_t first = 0; first < values.size(); first += stride)
    {
        const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
        const auto end =
            values.begin() + static_cast<std::ptrdiff_t>(std::min(first + stride, values.size()));
        result.push_back(*std::max_element(begin, end));
    }
    return result;
}

/// One value of every point or frame.
template <typename Value>
std::vector<float> all_of(const std::vector<SeriesPoint>& points, Value value_of)
{
    std::vector<float> values;
    for (const SeriesPoint& point : points)
    {
        values.push_back(value_of(point));
    }
    return values;
}

TEST(RunSeries, each_point_is_the_worst_of_its_frames)
{
    std::mt19937 random(2031);
    std::vector<SeriesPoint> frames;
    RunSeries series;
    EXPECT_TRUE(series.points().empty());
    // Counts around each doubling, and while pairs are being merged.
    const std::vector<std::size_t> looks{1,     2,     2'047, 2'048, 2'049, 2'050, 3'000, 3'072,
                                         3'073, 4'095, 4'096, 4'097, 5'121, 8'192, 8'193, 20'000};
    for (const std::size_t count : looks)
    {
        while (frames.size() < count)
        {
            frames.push_back(random_point(random));
            series.add(frames.back());
        }
        SCOPED_TRACE(count);
        const auto stride = static_cast<std::size_t>(series.stride());
        const std::vector<SeriesPoint> points = series.points();
        EXPECT_LE(points.size(), RunSeries::kPoints);
        EXPECT_TRUE(stride == 1 || points.size() > RunSeries::kPoints / 2);
        EXPECT_EQ(points.size(), (count + stride - 1) / stride);
        const auto agree = [&](auto value_of)
        { return all_of(points, value_of) == largest(all_of(frames, value_of), stride); };
        EXPECT_TRUE(agree([](const SeriesPoint& point) { return point.force_n; }));
        EXPECT_TRUE(agree([](const SeriesPoint& point) { return point.width_m; }));
        EXPECT_TRUE(agree([](const SeriesPoint& point) { return point.frame_us; }));
        for (std::size_t stage = 0; stage < kStages; ++stage)
        {
            EXPECT_TRUE(agree([stage](const SeriesPoint& point) { return point.stage_us[stage]; }))
                << "stage " << stage;
        }
    }
}

TEST(ToolPath, has_of_neighbouring_frames_the_place_with_the_most_force)
{
    ToolPath path;
    for (int i = 0; i < 5'000; ++i)
    {
        path.add({{static_cast<float>(i), 0.0F, 0.0F}, i % 4 == 2 ? 1.0F : 0.25F});
    }
    ASSERT_EQ(path.stride(), 4U);
    const std::vector<PathPoint> points = path.points();
    ASSERT_EQ(points.size(), 1'250U);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
        EXPECT_EQ(points[i], (PathPoint{{static_cast<float>(4 * i + 2), 0.0F, 0.0F}, 1.0F})) << i;
    }
}

struct Line
{
    double value_us;
    double share;
    std::uint64_t count;
};

std::vector<Line> lines_of(const std::string& text)
{
    std::vector<Line> lines;
    std::istringstream stream(text);
    std::string line;
    std::getline(stream, line);
    EXPECT_EQ(line, "       Value     Percentile TotalCount 1/(1-Percentile)");
    std::getline(stream, line);
    EXPECT_EQ(line, "");
    while (std::getline(stream, line) && line[0] != '#')
    {
        Line told{};
        std::istringstream(line) >> told.value_us >> told.share >> told.count;
        lines.push_back(told);
    }
    return lines;
}

TEST(HdrText, tells_of_no_values)
{
    EXPECT_EQ(hdr_text(LatencyHistogram()),
              "       Value     Percentile TotalCount 1/(1-Percentile)\n\n"
              "#[Mean    =        0.000, StdDeviation   =        0.000]\n"
              "#[Max     =        0.000, Total count    =            0]\n"
              "#[Buckets =           27, SubBuckets     =         2048]\n");
}

TEST(HdrText, tells_of_one_value)
{
    LatencyHistogram histogram;
    histogram.record(nanoseconds(1'500));
    EXPECT_EQ(hdr_text(histogram), "       Value     Percentile TotalCount 1/(1-Percentile)\n\n"
                                   "       1.500 0.000000000000          1           1.00\n"
                                   "       1.500 1.000000000000          1\n"
                                   "#[Mean    =        1.500, StdDeviation   =        0.000]\n"
                                   "#[Max     =        1.500, Total count    =            1]\n"
                                   "#[Buckets =           27, SubBuckets     =         2048]\n");
}

/// Each value below 2,048 ns has its own counter, so the text must be exact.
TEST(HdrText, holds_against_the_sorted_values)
{
    constexpr std::int64_t kValues = 997; // Prime: no share except 0 is a whole number of them.
    std::vector<std::int64_t> values_ns;
    LatencyHistogram histogram;
    for (std::int64_t i = 0; i < kValues; ++i)
    {
        values_ns.push_back(i * i * 2 / 1'000);
        histogram.record(nanoseconds(values_ns.back()));
    }
    const std::vector<Line> lines = lines_of(hdr_text(histogram));
    ASSERT_GT(lines.size(), 40U);
    double before = -1.0;
    for (const Line& line : lines)
    {
        const auto value_ns = static_cast<std::int64_t>(line.value_us * 1e3 + 0.5);
        const auto below = std::ranges::upper_bound(values_ns, value_ns) - values_ns.begin();
        const auto rank = static_cast<std::size_t>(std::max(std::ceil(line.share * kValues), 1.0));
        EXPECT_EQ(value_ns, values_ns[rank - 1]) << line.share;
        EXPECT_EQ(line.count, static_cast<std::uint64_t>(below));
        EXPECT_GT(line.share, before);
        before = line.share;
    }
    EXPECT_EQ(lines.back().share, 1.0);
    EXPECT_EQ(lines.back().count, static_cast<std::uint64_t>(kValues));
    // Five lines for each half: 0, 0.1 .. 0.4, 0.5, 0.55 .. 0.7, 0.75 and so on.
    EXPECT_NEAR(lines[1].share, 0.1, 1e-12);
    EXPECT_NEAR(lines[5].share, 0.5, 1e-12);
    EXPECT_NEAR(lines[6].share, 0.55, 1e-12);
    EXPECT_NEAR(lines[10].share, 0.75, 1e-12);
}

TEST(Histograms, are_one_file_for_each_time)
{
    const tactus::test::TemporaryFolder folder("histograms");
    RunStatistics statistics(1, 1, 1, milliseconds(1));
    statistics.frame.record(microseconds(7));
    EXPECT_FALSE(probe_histograms(folder.path().string()));
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
    EXPECT_FALSE(write_histograms(statistics, folder.path().string()));
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    {
        names.insert(entry.path().filename().string());
    }
    EXPECT_EQ(names, (std::set<std::string>{"load.hgrm", "refine.hgrm", "refit.hgrm", "query.hgrm",
                                            "force.hgrm", "frame.hgrm", "cpu.hgrm", "wake.hgrm",
                                            "response.hgrm"}));
    std::ostringstream text;
    text << std::ifstream(folder.path() / "frame.hgrm").rdbuf();
    EXPECT_EQ(lines_of(text.str()).front().value_us, 7.0);
    EXPECT_TRUE(probe_histograms((folder.path() / "none").string()));
}

} // namespace
} // namespace tactus::hrtc::test
