// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/report/verdict.hpp"
#include "rt_core/limits.hpp"
#include "transport/base/number_form.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tactus::hrtc
{

namespace
{

using Json = nlohmann::ordered_json;

/// Remedy that the text proposes for a limit.
enum class Remedy : std::uint8_t
{
    pool,    ///< More --pool-mib.
    splits,  ///< More --splits, or more work a frame.
    work,    ///< More work a frame, or a tool that needs less.
    tool,    ///< A smaller tool; memory does not help.
    server,  ///< A faster network.
    objects, ///< Fewer objects.
};

/// Limit of a frame, with the fault flag of the frames that reached it.
struct Limit
{
    const char* flag;
    const char* words;
    Remedy remedy;
};
/// Limits; if the same number of frames reached two, the earlier one is reported.
constexpr Limit kLimits[] = {
    {"surface_truncated", "more triangles are in reach of the tool than a frame can search",
     Remedy::tool},
    {"node_budget_spent", "a search reached the limit of work, nodes or triangles of a frame",
     Remedy::work},
    {"refine_heap_full", "more coarse faces are in reach of the tool than a frame can rank",
     Remedy::tool},
    {"tool_over_capacity", "more objects or contacts are at the tool than a frame can follow",
     Remedy::tool},
    {"forest_full", "no room for faces", Remedy::pool},
    {"tree_full", "no room for the tree", Remedy::pool},
    {"cache_full", "no room for pages", Remedy::pool},
    {"pair_shed", "no room for a pair of tool and object", Remedy::pool},
    {"split_budget_spent", "too few splits in a frame", Remedy::splits},
    {"held_records_full", "too few splits in a frame", Remedy::splits},
    {"ranking_full", "more regions are to be loaded than can be ranked", Remedy::objects},
    {"chunk_late", "pieces arrived too late", Remedy::server},
};

/// Remedy by more time a frame: --frame-budget-us; empty without a time budget.
std::string more_time(const Json& report)
{
    const Json& frame_us = report["budgets"]["frame_us"];
    return frame_us.is_null() ? std::string()
                              : fmt::format("--frame-budget-us above {:g}", frame_us.get<double>());
}

std::string remedy_text(Remedy remedy, const Json& report)
{
    constexpr const char* kOtherTool =
        "a smaller --tool, or a model with fewer faces; more memory does not help";
    const std::string longer = more_time(report);
    switch (remedy)
    {
    case Remedy::pool:
    {
        const double now_mib = report["pools"]["total_bytes"].get<double>() / 0x1p20;
        return fmt::format("--pool-mib {:g}, 4 times as much", 4.0 * std::ceil(now_mib));
    }
    case Remedy::splits:
        return longer.empty() ||
                       report["budgets"]["splits"].get<std::uint32_t>() < kMaxSplitsPerFrame
                   ? fmt::format("--splits {}, the largest value", kMaxSplitsPerFrame)
                   : longer;
    case Remedy::work:
        return longer.empty() ? kOtherTool : longer + ", " + kOtherTool;
    case Remedy::tool:
        return kOtherTool;
    case Remedy::server:
        return "a nearer server, or a larger --pool-mib, so that more pieces stay loaded";
    case Remedy::objects:
        return "fewer objects at one place";
    }
    return {};
}

} // namespace

std::string limit_text(const Json& report)
{
    const Json& faults = report["faults"];
    const auto frames_of = [&faults](const Limit& limit)
    { return faults.value(limit.flag, std::uint64_t{0}); };
    const auto* const met = std::ranges::max_element(kLimits, [&](const Limit& a, const Limit& b)
                                                     { return frames_of(a) < frames_of(b); });
    return frames_of(*met) == 0
               ? std::string()
               : fmt::format("{} ({} in {}): {}", met->words, met->flag,
                             counted(frames_of(*met), "frame"), remedy_text(met->remedy, report));
}

} // namespace tactus::hrtc
