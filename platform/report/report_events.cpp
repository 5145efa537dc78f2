// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/controller/finished_run.hpp"
#include "platform/report/report.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <utility>

namespace tactus::hrtc
{

namespace
{

using Json = nlohmann::ordered_json;

/// Names of the bits that are set in `bits`; `names` in the order of the bits.
template <std::size_t Count>
Json names_of(unsigned bits, const std::array<const char*, Count>& names)
{
    Json list = Json::array();
    for (std::size_t bit = 0; bit < Count; ++bit)
    {
        if ((bits & (1U << bit)) != 0)
        {
            list.push_back(names[bit]);
        }
    }
    return list;
}

Json cycle_of(const NotedCycle& cycle)
{
    return {{"frame", cycle.frame},
            {"flags", names_of(static_cast<unsigned>(cycle.flags), kCycleFlagNames)},
            {"wake_us", to_us(cycle.wake_lateness)},
            {"frame_us", to_us(cycle.frame_time)},
            {"cpu_us", to_us(cycle.cpu)},
            {"end_us", to_us(cycle.lateness_of_end)}};
}

Json event_of(const SafetyEvent& event, MonotonicTime start)
{
    Json json{{"time_s", to_seconds(event.time - start)},
              {"frame", event.frame},
              {"tool", event.tool},
              {"state", kSafetyStateNames[static_cast<std::size_t>(event.state)]},
              {"causes", names_of(static_cast<unsigned>(event.causes), kForceOffNames)}};
    if (event.by_supervisor) // The supervisor counts no frames.
    {
        json["frame"] = nullptr;
    }
    return json;
}

} // namespace

Json deadlines_of(const FinishedRun& run)
{
    constexpr std::size_t kCyclesShown = 100;
    const DeadlineAccount& deadlines = run.statistics.deadlines;
    Json cycles = Json::object();
    for (std::size_t bit = 0; bit < kCycleFlags; ++bit)
    {
        cycles[kCycleFlagNames[bit]] = deadlines.flagged[bit];
    }
    Json noted = Json::array();
    for (const NotedCycle& cycle :
         deadlines.noted().first(std::min(deadlines.noted().size(), kCyclesShown)))
    {
        noted.push_back(cycle_of(cycle));
    }
    return {{"missed", deadlines.missed},
            {"overrun", deadlines.overruns},
            {"latency_misses", deadlines.latency_misses},
            {"stopped", deadlines.stopped},
            {"missed_periods", run.timer.missed_periods},
            {"episodes", run.timer.episodes},
            {"extra_switches", deadlines.cycles_with(CycleFlag::gave_way)},
            {"over_budget", deadlines.cycles_with(CycleFlag::over_work)},
            {"cycles", cycles},
            {"noted", noted},
            {"noted_left_out", deadlines.noted().size() - noted.size() + deadlines.not_kept}};
}

Json safety_of(const FinishedRun& run)
{
    const SafetyRecord& safety = run.safety;
    Json begun = Json::object();
    for (std::size_t bit = 0; bit < kForceOffs; ++bit)
    {
        begun[kForceOffNames[bit]] = safety.begun()[bit];
    }
    Json events = Json::array();
    for (const SafetyEvent& event : safety.events())
    {
        events.push_back(event_of(event, safety.events().front().time));
    }
    return {{"supervisor_fifo", run.supervisor_fifo},
            {"supervisor_periods", run.supervisor_periods},
            {"supervisor_brakes", safety.brakes()},
            {"begun", begun},
            {"events", events},
            {"events_left_out", safety.left_out()}};
}

Json servers_of(const FinishedRun& run)
{
    const auto& safety = run.safety.events();
    const MonotonicTime start = safety.empty() ? MonotonicTime{} : safety.front().time;
    std::array<std::uint64_t, dds::kServerNewsKinds> counts{};
    Json events = Json::array();
    for (const dds::ServerEvent& event : run.server_events)
    {
        const auto kind = static_cast<std::size_t>(event.news);
        ++counts.at(kind);
        const MonotonicTime time{std::chrono::nanoseconds(event.time.time_since_epoch()).count()};
        events.push_back({{"time_s", to_seconds(time - start)},
                          {"event", dds::server_news_names().at(kind)},
                          {"name", event.what},
                          {"server", event.server}});
    }
    Json json = Json::object();
    for (std::size_t kind = 0; kind < counts.size(); ++kind)
    {
        json[dds::server_news_names().at(kind)] = counts.at(kind);
    }
    json["events"] = std::move(events);
    return json;
}

} // namespace tactus::hrtc
