// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Summary of the report in a few lines for a reader.

#include "platform/report/report.hpp"
#include "platform/report/verdict.hpp"
#include "transport/base/number_form.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace tactus::hrtc
{

namespace
{

using Json = nlohmann::ordered_json;

std::string work_text(const Json& budgets)
{
    return fmt::format(
        "budget for {} us a frame: {} to {}; {:.0f} used on average, {} at most; least budget in "
        "{}",
        budgets["frame_us"].get<double>(), budgets["work"]["min"].get<std::uint32_t>(),
        budgets["work"]["max"].get<std::uint32_t>(), budgets["work_done"]["mean"].get<double>(),
        budgets["work_done"]["max"].get<std::uint32_t>(),
        counted(budgets["at_floor"].get<std::uint64_t>(), "frame"));
}

/// Largest number of models with a line each; more are summed up in one line.
constexpr std::size_t kModelsInLines = 4;

/// Adds the motion of each model's first object, if it follows a server.
void add_poses(const Json& models, SummaryFacts& facts)
{
    SummaryFacts lines;
    double step_max_m = 0.0;
    double age_max_s = 0.0;
    for (const Json& model : models)
    {
        const Json& pose = model["pose"];
        if (pose.is_null() || !pose["followed"].get<bool>()) // Null if no object shows the model at
                                                             // the start.
        {
            continue;
        }
        const auto step_m = pose["step_max_m"].get<double>();
        const auto age_s = pose["age_max_s"].get<double>();
        step_max_m = std::max(step_max_m, step_m);
        age_max_s = std::max(age_max_s, age_s);
        lines.emplace_back("poses",
                           fmt::format("{}: moved in {}, by at most {:.4g} m; oldest pose {:.3g} s",
                                       model["name"].get<std::string>(),
                                       counted(pose["moves"].get<std::uint64_t>(), "frame"), step_m,
                                       age_s));
    }
    if (lines.size() > kModelsInLines)
    {
        lines = {{"poses", fmt::format("{} models: moved by at most {:.4g} m; oldest pose {:.3g} s",
                                       lines.size(), step_max_m, age_max_s)}};
    }
    facts.insert(facts.end(), lines.begin(), lines.end());
}

/// Number of models in each stage at the end; empty if all are resident.
std::string stages_text(const Json& models)
{
    std::string text;
    bool are_all_here = true;
    for (const auto& [stage, json] : models.items())
    {
        const auto count = json.get<std::uint64_t>();
        text += count > 0 ? fmt::format(" {} {}", count, stage) : "";
        are_all_here = are_all_here && (count == 0 || stage == "resident");
    }
    return are_all_here ? "" : "; models at the end:" + text;
}

/// Adds the scene if it has more than one object.
void add_scene(const Json& scene, SummaryFacts& facts)
{
    if (scene["objects_max"].get<std::uint64_t>() > 1)
    {
        facts.emplace_back(
            "scene",
            fmt::format("{}, at most {}; at most {} near a tool; {} at an invisible wall{}",
                        counted(scene["objects"].get<std::uint64_t>(), "object"),
                        scene["objects_max"].get<std::uint64_t>(),
                        scene["pairs_awake_max"].get<std::uint64_t>(),
                        counted(scene["invisible_wall_frames"].get<std::uint64_t>(), "frame"),
                        stages_text(scene["models"])));
    }
}

/// Adds the changes of forces by the passivity controller and stiffness limit, if there were any.
void add_stability(const Json& tools, SummaryFacts& facts)
{
    std::uint64_t capped = 0;
    std::uint64_t damped = 0;
    double cap = std::numeric_limits<double>::infinity();
    for (const Json& tool : tools)
    {
        capped += tool["conditioned"]["stiffness_limited"].get<std::uint64_t>();
        damped += tool["conditioned"]["damped"].get<std::uint64_t>();
        const Json& softest = tool["least_stiffness_n_per_m"];
        cap = softest.is_null() ? cap : std::min(cap, softest.get<double>());
    }
    if (capped > 0)
    {
        facts.emplace_back("stability",
                           counted(capped, "force") + " softened" +
                               (std::isfinite(cap)
                                    ? fmt::format(", to {:.0f} N/m at the softest", cap)
                                    : " in rotation"));
    }
    if (damped > 0)
    {
        facts.emplace_back("stability",
                           counted(damped, "force") + " damped by the passivity controller");
    }
}

/// Adds the causes of fades, except for the end of the run.
void add_safety(const Json& safety, SummaryFacts& facts)
{
    std::string causes;
    for (const auto& [name, count] : safety["begun"].items())
    {
        if (count.get<std::uint64_t>() > 0 && name != "software")
        {
            causes += fmt::format("{}{} {}", causes.empty() ? "" : ", ", name,
                                  count.get<std::uint64_t>());
        }
    }
    if (!causes.empty())
    {
        facts.emplace_back(
            "safety",
            fmt::format("force faded, causes: {}; {} by the supervisor", causes,
                        counted(safety["supervisor_brakes"].get<std::uint64_t>(), "brake")));
    }
}

std::string recording_text(const Json& recording)
{
    const Json& lost_from = recording["lost_from"];
    return fmt::format(
        "{}, {:.1f} KB{}", counted(recording["frames"].get<std::uint64_t>(), "frame"),
        recording["bytes"].get<double>() / 1e3,
        lost_from.is_null() ? ""
                            : fmt::format("; incomplete: frame {} and all later ones are lost",
                                          lost_from.get<std::uint64_t>()));
}

std::string answers_text(const Json& report)
{
    const double frames = std::max(report["frames"].get<double>(), 1.0);
    const auto share = [&](const char* kind)
    { return 100.0 * report["answers"][kind].get<double>() / frames; };
    return fmt::format(
        "exact {:.2f} %, separated {:.2f} %, {}bounded {:.2f} %, stale {:.2f} %; "
        "longest inexact run {}",
        share("exact"), share("separated"),
        share("within_tolerance") > 0.0
            ? fmt::format("within {:.2g} um {:.2f} %, ",
                          1e6 * report["answers"]["tolerated_max_m"].get<double>(),
                          share("within_tolerance"))
            : "",
        share("bounded"), share("stale"),
        counted(report["answers"]["longest_inexact_run"].get<std::uint64_t>(), "frame"));
}

std::string deadlines_text(const Json& report)
{
    const Json& deadline = report["deadline"];
    const auto stopped = deadline["stopped"].get<std::uint64_t>();
    return fmt::format(
        "{} missed: {}, {}{}; {}, {}", deadline["missed"].get<std::uint64_t>(),
        counted(deadline["overrun"].get<std::uint64_t>(), "overrun"),
        counted(deadline["latency_misses"].get<std::uint64_t>(), "latency miss", "latency misses"),
        stopped > 0 ? fmt::format(", {} stopped from outside", stopped) : "",
        counted(report["realtime"]["allocations"].get<std::uint64_t>(), "allocation"),
        counted(report["realtime"]["page_faults"].get<std::uint64_t>(), "page fault"));
}

/// Adds the models in static mode.
void add_static(const Json& models, SummaryFacts& facts)
{
    SummaryFacts lines;
    for (const Json& model : models)
    {
        if (model["static"].get<bool>())
        {
            lines.emplace_back("static", model["name"].get<std::string>() +
                                             ": loaded as a whole and fully refined");
        }
    }
    if (lines.size() > kModelsInLines)
    {
        lines = {{"static", fmt::format("{} of {} models: loaded as a whole and fully refined",
                                        lines.size(), models.size())}};
    }
    facts.insert(facts.end(), lines.begin(), lines.end());
}

/// Adds a line if messages of other participants were refused.
void add_refused(const Json& peers, SummaryFacts& facts)
{
    std::uint64_t refused = 0;
    for (const Json& peer : peers)
    {
        for (const Json& figure : peer)
        {
            refused += figure.is_number() ? figure.get<std::uint64_t>() : 0;
        }
    }
    if (refused > 0)
    {
        facts.emplace_back(
            "refused", fmt::format("{} from {} on the domain; the report lists the reasons",
                                   counted(refused, "message"), counted(peers.size(), "program")));
    }
}

/// Adds a line if a server was lost or replaced, or another one offered the same name.
void add_servers(const Json& servers, SummaryFacts& facts)
{
    const auto count = [&](const char* key) { return servers[key].get<std::uint64_t>(); };
    if (count("lost") + count("replaced") + count("not_followed") + count("namesake") > 0)
    {
        facts.emplace_back("servers",
                           fmt::format("lost {}, back {}, replaced {}; others with the same name "
                                       "{}, not followed {}; the report lists them",
                                       count("lost"), count("back"), count("replaced"),
                                       count("namesake"), count("not_followed")));
    }
}

/// Adds memory, streaming and arrival times of the models.
void add_models(const Json& report, SummaryFacts& facts)
{
    const Json& pools = report["pools"];
    facts.emplace_back(
        "memory", fmt::format("{:.2f} MiB of pools; {} of {} pages, {} of {} faces at the peak",
                              pools["total_bytes"].get<double>() / (1024.0 * 1024.0),
                              pools["pages"]["used_max"].get<std::uint64_t>(),
                              pools["pages"]["capacity"].get<std::uint64_t>(),
                              pools["faces"]["used_max"].get<std::uint64_t>(),
                              pools["faces"]["capacity"].get<std::uint64_t>()));
    add_static(report["models"], facts);
    facts.emplace_back(
        "streaming",
        fmt::format("{:.1f} KB received, {} loaded, {} evicted{}",
                    report["wire"]["bytes_received"].get<double>() / 1e3,
                    counted(report["cache"]["loads"].get<std::uint64_t>(), "page"),
                    report["cache"]["evictions"].get<std::uint64_t>(),
                    report["wire"]["server_lost"].get<bool>() ? "; the server was lost" : ""));
    if (const Json& arrival = report["wire"]["arrival_ms"]; !arrival["max"].is_null())
    {
        facts.emplace_back(
            "arrival",
            fmt::format("{:.1f} / {:.1f} / {:.1f} ms from a request to its piece (p50 / p99 / max)",
                        arrival["p50"].get<double>(), arrival["p99"].get<double>(),
                        arrival["max"].get<double>()));
    }
    add_servers(report["servers"], facts);
    add_refused(report["refused"], facts);
}

/// Largest torque; empty without torques.
std::string torque_text(const Json& tools)
{
    double most_nm = 0.0;
    for (const Json& tool : tools)
    {
        most_nm = std::max(most_nm, tool["torque_max_nm"].get<double>());
    }
    return most_nm > 0.0 ? fmt::format("; torque at most {:.4f} N m", most_nm) : "";
}

/// Number of frames and their shares. The data-limited share appears only if it isn't zero.
std::string frames_text(const Json& report)
{
    const auto percent = [&report](const char* share)
    { return 100.0 * report["force"][share].get<double>(); };
    const double data_limited = percent("data_limited_share");
    return fmt::format(
        "{} at {:.0f} Hz, in contact {:.1f} %, with a force {:.1f} %{}",
        report["frames"].get<std::uint64_t>(), 1e9 / report["period_ns"].get<double>(),
        percent("contact_share"), percent("force_share"),
        data_limited > 0.0 ? fmt::format(", data-limited {:.1f} %", data_limited) : "");
}

SummaryFacts touch_facts(const Json& report)
{
    return {{"frames", frames_text(report)},
            {"answers", answers_text(report)},
            {"force", fmt::format("at most {:.2f} N, largest step {:.3f} N{}",
                                  report["force"]["max_n"].get<double>(),
                                  report["force"]["max_step_n"].get<double>(),
                                  torque_text(report["tools"]))}};
}

SummaryFacts run_facts(const Json& report)
{
    SummaryFacts facts;
    if (const Json& budgets = report["budgets"];
        100 * budgets["at_floor"].get<std::uint64_t>() > report["frames"].get<std::uint64_t>())
    {
        facts.emplace_back("work", work_text(budgets));
    }
    add_scene(report["scene"], facts);
    add_models(report, facts);
    facts.emplace_back("deadlines", deadlines_text(report));
    add_poses(report["models"], facts);
    add_stability(report["tools"], facts);
    add_safety(report["safety"], facts);
    if (report["realtime"]["system_calls_trapped"].get<bool>())
    {
        facts.emplace_back(
            "calls",
            fmt::format("{} in frames, {} of the loop between frames",
                        counted(report["realtime"]["system_calls_in_frame"].get<std::uint64_t>(),
                                "system call"),
                        report["realtime"]["system_calls_outside"].get<std::uint64_t>()));
    }
    if (!report["recording"].is_null())
    {
        facts.emplace_back("recording", recording_text(report["recording"]));
    }
    if (const Json& carving = report["carving"]; !carving.is_null())
    {
        facts.emplace_back(
            "carving", fmt::format("{} sent for at most {:.3g} mm^3, {} not sent",
                                   counted(carving["sent"].get<std::uint64_t>(), "edit request"),
                                   carving["volume_mm3"].get<double>(),
                                   carving["unsent"].get<std::uint64_t>()));
    }
    if (const Json& trace = report["trace"]; !trace.is_null())
    {
        facts.emplace_back(
            "trace", fmt::format("{}, {:.1f} MB; {} lost",
                                 counted(trace["frames"].get<std::uint64_t>(), "frame"),
                                 trace["bytes"].get<double>() / 1e6,
                                 counted(trace["lost"].get<std::uint64_t>(), "entry", "entries")));
    }
    return facts;
}

std::string to_lines(const SummaryFacts& facts)
{
    std::string text;
    for (const auto& [name, fact] : facts)
    {
        text += fmt::format("{:<12}{}\n", name, fact);
    }
    return text;
}

std::string times_table(const Json& all_times)
{
    std::string text = "times us        mean     p50     p99   p99.9     max\n";
    for (const auto& [name, times] : all_times.items())
    {
        text += fmt::format("  {:<10}{:>8.1f}{:>8.1f}{:>8.1f}{:>8.1f}{:>8.1f}\n", name,
                            times["mean"].get<double>(), times["p50"].get<double>(),
                            times["p99"].get<double>(), times["p999"].get<double>(),
                            times["max"].get<double>());
    }
    return text;
}

} // namespace

SummaryFacts summary_facts(const Json& report)
{
    SummaryFacts facts = touch_facts(report);
    std::ranges::copy(run_facts(report), std::back_inserter(facts));
    return facts;
}

std::string make_summary(const Json& report)
{
    const SummaryFacts verdict{{"verdict", verdict_text(complaints_of(report))}};
    const std::string times =
        report["realtime"]["virtual_time"].get<bool>()
            ? to_lines({{"times", "none: virtual time stands still during a frame"}})
            : times_table(report["times_us"]);
    return to_lines(verdict) + to_lines(touch_facts(report)) + times + to_lines(run_facts(report));
}

} // namespace tactus::hrtc
