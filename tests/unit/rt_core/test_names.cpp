// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/work_counters.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

namespace tactus
{

namespace
{

/// False for a number that is no enumerator; a new one without a case here does not compile.
bool is_stage(Stage stage)
{
    switch (stage)
    {
    case Stage::load:
    case Stage::refine:
    case Stage::refit:
    case Stage::query:
    case Stage::force:
        return true;
    }
    return false;
}

/// The same for flags.
bool is_flag(FrameFault fault)
{
    switch (fault)
    {
    case FrameFault::none:
        return false;
    case FrameFault::split_budget_spent:
    case FrameFault::forest_full:
    case FrameFault::tree_full:
    case FrameFault::chunk_late:
    case FrameFault::cache_full:
    case FrameFault::node_budget_spent:
    case FrameFault::surface_truncated:
    case FrameFault::model_inconsistent:
    case FrameFault::tool_invalid:
    case FrameFault::proxy_frozen:
    case FrameFault::tool_stuck:
    case FrameFault::tool_jumped:
    case FrameFault::proxy_squeezed:
    case FrameFault::refine_heap_full:
    case FrameFault::held_records_full:
    case FrameFault::ranking_full:
    case FrameFault::tool_crowded:
    case FrameFault::pair_shed:
    case FrameFault::scene_crowded:
    case FrameFault::object_lost:
    case FrameFault::plane_budget_spent:
        return true;
    }
    return false;
}

template <typename Names>
void expect_different_words(const Names& names)
{
    std::set<std::string> seen;
    for (const char* name : names)
    {
        ASSERT_NE(name, nullptr) << "a name is missing at the end";
        EXPECT_TRUE(seen.insert(name).second) << name << " names two";
    }
}

std::string page(const char* name)
{
    std::ifstream file(std::filesystem::path(TACTUS_SOURCE_DIR) / "docs" / name);
    EXPECT_TRUE(file) << name;
    return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Names, every_stage_and_every_fault_of_a_frame_has_one_of_its_own)
{
    for (std::uint32_t i = 0; i <= kStages; ++i)
    {
        EXPECT_EQ(is_stage(static_cast<Stage>(i)), i < kStages) << i;
    }
    for (std::uint32_t bit = 0; bit < 32; ++bit)
    {
        EXPECT_EQ(is_flag(static_cast<FrameFault>(1U << bit)), bit < kFrameFaults) << bit;
    }
    expect_different_words(kStageNames);
    expect_different_words(kFrameFaultNames);
}

TEST(Names, stand_beside_their_meaning)
{
    EXPECT_STREQ(kStageNames[static_cast<std::size_t>(Stage::refit)], "refit");
    EXPECT_EQ(1U << 3U, static_cast<std::uint32_t>(FrameFault::chunk_late));
    EXPECT_STREQ(kFrameFaultNames[3], "chunk_late");
    EXPECT_EQ(1U << 16U, static_cast<std::uint32_t>(FrameFault::tool_crowded));
    EXPECT_STREQ(kFrameFaultNames[16], "tool_crowded");
}

TEST(Names, every_stage_is_explained_on_the_pages_of_architecture_and_of_reports)
{
    const std::string architecture = page("architecture.md");
    const std::string report = page("report.md");
    for (const std::string name : kStageNames)
    {
        // A heading of its own, or behind the steps that make up the stage.
        const bool has_heading = architecture.find("\n### " + name + "\n") != std::string::npos ||
                                 architecture.find(": *" + name + "*\n") != std::string::npos;
        EXPECT_TRUE(has_heading) << name;
        EXPECT_NE(report.find("\n| `" + name + "` |"), std::string::npos) << name;
    }
}

TEST(Names, every_fault_is_explained_on_the_page_of_reports)
{
    const std::string report = page("report.md");
    for (const std::string name : kFrameFaultNames)
    {
        EXPECT_NE(report.find("\n| `" + name + "` |"), std::string::npos) << name;
    }
}

} // namespace

} // namespace tactus
