// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/verdict.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>

namespace tactus::hrtc
{

using Json = nlohmann::ordered_json;

std::vector<std::string> losses_of(const Json& report)
{
    std::vector<std::string> losses;
    if (report["wire"]["host_lost"].get<bool>())
    {
        losses.emplace_back("the host went away");
    }
    if (const auto times = report["safety"]["begun"]["disconnect"].get<std::uint64_t>(); times > 0)
    {
        losses.push_back(fmt::format("devices gone: {}", times));
    }
    for (const Json& model : report["models"])
    {
        const auto name = model["name"].get<std::string>();
        if (const auto refused = model["pieces_refused"].get<std::uint64_t>(); refused > 0)
        {
            losses.push_back(fmt::format("{} damaged pieces of {}", refused, name));
        }
        if (const auto overdue = model["pieces_overdue"].get<std::uint64_t>(); overdue > 0)
        {
            losses.push_back(fmt::format("{} pieces of {} that didn't come within 1 s, {} never",
                                         overdue, name,
                                         model["pieces_missing"].get<std::uint64_t>()));
        }
    }
    const Json& tools = report["tools"];
    for (std::size_t i = 0; i < tools.size(); ++i)
    {
        const Json& softest = tools[i]["softest_wall_n_per_m"]; // Null: none was softened.
        if (!softest.is_null() && softest.get<double>() < kSoftestFelt_n_per_m)
        {
            losses.push_back(fmt::format("tool {}: a wall of {:.2g} N/m, which nobody feels", i,
                                         softest.get<double>()));
        }
    }
    if (const auto limited = report["scene"]["limited"].get<std::uint64_t>(); limited > 0)
    {
        losses.push_back(fmt::format("{} materials were limited", limited));
    }
    if (report["force"]["contact_share"].get<double>() == 0.0)
    {
        losses.emplace_back("nothing was touched");
    }
    return losses;
}

std::vector<std::string> complaints_of(const Json& report)
{
    std::vector<std::string> complaints;
    const auto count = [&](const Json& value, const char* what)
    {
        if (const auto number = value.get<std::uint64_t>(); number > 0)
        {
            complaints.push_back(fmt::format("{} {}", number, what));
        }
    };
    count(report["deadline"]["own_fault"], "deadlines missed by the loop's own fault");
    count(report["deadline"]["unexplained"], "missed with nobody to blame");
    count(report["realtime"]["allocations"], "allocations in the loop");
    count(report["realtime"]["system_calls_in_frame"], "system calls in frames");
    count(report["answers"]["stale"], "frames with a stale answer");
    std::string causes;
    for (const auto& [cause, times] : report["safety"]["begun"].items())
    {
        if (cause != "software" && times.get<std::uint64_t>() > 0) // Software: a run's own end.
        {
            causes += fmt::format("{}{} {}", causes.empty() ? "" : ", ", cause,
                                  times.get<std::uint64_t>());
        }
    }
    if (!causes.empty())
    {
        complaints.push_back("force off for: " + causes);
    }
    count(report["safety"]["supervisor_brakes"], "brakes by the supervisor");
    std::ranges::copy(losses_of(report), std::back_inserter(complaints));
    if (const Json& recording = report["recording"];
        !recording.is_null() && !recording["lost_from"].is_null())
    {
        complaints.emplace_back("the recording is incomplete");
    }
    return complaints;
}

} // namespace tactus::hrtc
