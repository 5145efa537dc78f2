// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/work_counters.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>

namespace tactus
{

namespace
{

std::string text_of(const char* name)
{
    std::ifstream file(std::filesystem::path(TACTUS_SOURCE_DIR) / name);
    EXPECT_TRUE(file) << name;
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Expects names in the order of the enumerators' numbers, all different, and on the page of
/// reports.
template <typename Names>
void expect_names(const Names& names, const char* header, const char* enumeration)
{
    std::string source = text_of(header);
    source = source.substr(source.find(enumeration));
    source = source.substr(0, source.find("};"));
    const std::string report = text_of("docs/report.md");
    const std::string shift = " = 1U << ";
    std::set<std::string> seen;
    std::istringstream lines(source);
    for (std::string line; std::getline(lines, line);)
    {
        // An enumerator is indented by four, followed by a comma or its bit.
        const std::size_t end =
            std::min(line.find_first_not_of("abcdefghijklmnopqrstuvwxyz_", 4), line.size());
        const bool has_bit = line.compare(end, shift.size(), shift) == 0;
        if (!line.starts_with("    ") || (!has_bit && line.compare(end, 1, ",") != 0))
        {
            continue;
        }
        const std::string enumerator = line.substr(4, end - 4);
        const std::size_t number =
            has_bit ? std::stoul(line.substr(end + shift.size())) : seen.size();
        ASSERT_LT(number, names.size()) << enumerator;
        EXPECT_EQ(enumerator, names[number]);
        EXPECT_TRUE(seen.insert(names[number]).second) << names[number] << " names two";
        EXPECT_NE(report.find("\n| `" + enumerator + "` |"), std::string::npos) << enumerator;
    }
    EXPECT_EQ(seen.size(), names.size());
}

TEST(Names, are_those_of_every_stage_and_fault_and_explained_on_the_page_of_reports)
{
    expect_names(kFrameFaultNames, "rt_core/records/work_counters.hpp", "enum class FrameFault");
    expect_names(kStageNames, "rt_core/records/frame_input.hpp", "enum class Stage");
}

TEST(Names, every_stage_is_explained_on_the_page_of_architecture)
{
    const std::string architecture = text_of("docs/architecture.md");
    for (const std::string name : kStageNames)
    {
        // A stage has its own heading, or is named after its steps.
        const bool has_heading = architecture.find("\n### " + name + "\n") != std::string::npos ||
                                 architecture.find(": *" + name + "*\n") != std::string::npos;
        EXPECT_TRUE(has_heading) << name;
    }
}

} // namespace

} // namespace tactus
