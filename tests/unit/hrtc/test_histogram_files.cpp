// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/controller/histogram_folder.hpp"
#include "platform/report/report.hpp"
#include "rt_core/frame/frame.hpp"
#include "tests/shared/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>
#include <vector>

namespace tactus::hrtc::test
{
namespace
{

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
