// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/report/verdict.hpp"

#include "platform/scene/material_limits.hpp"
#include "transport/base/number_form.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>

namespace tactus::hrtc
{

namespace
{

using Json = nlohmann::ordered_json;

/// Least data-limited share of a run for a complaint. Smaller shares come from the time that data
/// takes to arrive.
constexpr double kDataLimitedShare = 0.25;

/// Derives the complaints from a report.
class Judge
{
public:
    explicit Judge(const Json& report) : report_(report) {}

    void judge_scene();
    void judge_controller();
    void judge_machine();

    [[nodiscard]] std::vector<Complaint> take() { return std::move(complaints_); }

private:
    void say(RunPart part, std::string words)
    {
        complaints_.push_back({part, std::move(words), false});
    }
    void say_loss(RunPart part, std::string words)
    {
        complaints_.push_back({part, std::move(words), true});
    }
    [[nodiscard]] std::uint64_t begun(const char* cause) const
    {
        return report_["safety"]["begun"].value(cause, std::uint64_t{0});
    }
    /// True if the machine made the loop late: there was a stall and no overrun. A watchdog without
    /// a stall may be the device's.
    [[nodiscard]] bool is_latency_miss() const
    {
        return begun("stall") > 0 && report_["deadline"]["overrun"].get<std::uint64_t>() == 0;
    }
    [[nodiscard]] std::string why_untouched() const;

    void judge_models();
    void judge_answers();
    void judge_walls();
    void judge_forces();

    const Json& report_;
    std::vector<Complaint> complaints_;
};

void Judge::judge_scene()
{
    if (report_["wire"]["server_lost"].get<bool>())
    {
        say_loss(RunPart::scene, "the server was lost");
    }
    judge_models();
    if (const auto limited = report_["scene"]["limited"].get<std::uint64_t>(); limited > 0)
    {
        say_loss(RunPart::scene,
                 counted(limited, "material was limited", "materials were limited"));
    }
    judge_answers();
    for (std::size_t i = 0; i < report_["tools"].size(); ++i)
    {
        if (const Json& inside = report_["tools"][i]["begins_inside"]; !inside.is_null())
        {
            say(RunPart::scene,
                fmt::format("tool {} began inside {}, and the surface keeps it inside", i,
                            inside.get<std::string>()));
        }
    }
    if (report_["force"]["contact_share"].get<double>() == 0.0)
    {
        say_loss(RunPart::scene, "nothing was touched: " + why_untouched());
    }
}

void Judge::judge_models()
{
    for (const Json& model : report_["models"])
    {
        const auto name = model["name"].get<std::string>();
        if (const auto refused = model["pieces_refused"].get<std::uint64_t>(); refused > 0)
        {
            say_loss(RunPart::scene, counted(refused, "damaged piece") + " of " + name);
        }
        if (const auto overdue = model["pieces_overdue"].get<std::uint64_t>(); overdue > 0)
        {
            say_loss(RunPart::scene, fmt::format("{} of {} did not arrive within 1 s, {} never",
                                                 counted(overdue, "piece"), name,
                                                 model["pieces_missing"].get<std::uint64_t>()));
        }
    }
}

/// Complains of stale answers, of a run without exact answers, and of data-limited tools with the
/// limit that caused it.
void Judge::judge_answers()
{
    const Json& answers = report_["answers"];
    if (const auto brackets = answers["bounded"].get<std::uint64_t>();
        brackets > 0 && answers["exact"].get<std::uint64_t>() == 0 &&
        answers["within_tolerance"].get<std::uint64_t>() == 0)
    {
        say_loss(RunPart::scene,
                 "no answer was exact, " + counted(brackets, "was bounded", "were bounded"));
    }
    const auto stale = answers["stale"].get<std::uint64_t>();
    if (stale > 0)
    {
        say(RunPart::scene, counted(stale, "frame") + " with a stale answer");
    }
    const std::uint64_t halted = begun("halted");
    const auto data_limited = report_["force"]["data_limited_share"].get<double>();
    if (halted > 0 || data_limited >= kDataLimitedShare)
    {
        const std::string limit = limit_text(report_);
        say_loss(RunPart::scene,
                 fmt::format("data-limited for {:.1f} % of the time{}: {}", 100.0 * data_limited,
                             halted > 0 ? ", and the force faded " + counted(halted, "time") : "",
                             limit.empty() ? "the surface at the tool wasn't known" : limit));
    }
}

std::string Judge::why_untouched() const
{
    const Json& tools = report_["tools"];
    if (std::ranges::any_of(tools,
                            [](const Json& tool) { return !tool["begins_inside"].is_null(); }))
    {
        return "the tool began inside";
    }
    const Json& answers = report_["answers"];
    if (answers["exact"].get<std::uint64_t>() + answers["bounded"].get<std::uint64_t>() +
            answers["within_tolerance"].get<std::uint64_t>() ==
        0)
    {
        return "no tool came near an object; the lines at the start give their positions";
    }
    for (const auto& [cause, times] : report_["safety"]["begun"].items())
    {
        const bool is_moment = cause == "software" || cause == "stall" || cause == "watchdog";
        if (times.get<std::uint64_t>() > 0 && !is_moment)
        {
            return fmt::format("the force was off, cause {}", cause);
        }
    }
    if (report_["force"]["data_limited_share"].get<double>() > 0.0)
    {
        return "the tool was data-limited before it reached the surface";
    }
    return "a tool came near, but the run ended before a contact";
}

void Judge::judge_controller()
{
    const auto count = [&](const Json& value, std::string_view one, std::string_view many)
    {
        if (const auto number = value.get<std::uint64_t>(); number > 0)
        {
            say(RunPart::controller, counted(number, one, many));
        }
    };
    const Json& realtime = report_["realtime"];
    count(report_["deadline"]["overrun"], "deadline missed by an overrun of the loop",
          "deadlines missed by an overrun of the loop");
    count(realtime["allocations"], "allocation in the loop", "allocations in the loop");
    count(realtime["system_calls_in_frame"], "system call in frames", "system calls in frames");
    judge_forces();
    judge_walls();
    if (const Json& recording = report_["recording"];
        !recording.is_null() && !recording["lost_from"].is_null())
    {
        say(RunPart::controller, "the recording is incomplete");
    }
}

/// Complains of the causes of fades, except those that other complaints name.
void Judge::judge_forces()
{
    std::string causes;
    for (const auto& [cause, times] : report_["safety"]["begun"].items())
    {
        const bool is_told = cause == "software" || cause == "halted" ||
                             (is_latency_miss() && (cause == "stall" || cause == "watchdog"));
        if (const auto number = times.get<std::uint64_t>(); number > 0 && !is_told)
        {
            causes += fmt::format("{}{} {}", causes.empty() ? "" : ", ", cause, number);
        }
    }
    if (!causes.empty())
    {
        say(RunPart::controller, "force off, causes: " + causes);
    }
    if (const std::uint64_t gone = begun("disconnect"); gone > 0)
    {
        say_loss(RunPart::controller, counted(gone, "device disconnection"));
    }
}

void Judge::judge_walls()
{
    const Json& tools = report_["tools"];
    for (std::size_t i = 0; i < tools.size(); ++i)
    {
        const Json& softest = tools[i]["least_stiffness_n_per_m"]; // Null: no wall was softened.
        if (!softest.is_null() && softest.get<double>() < kSoftestFelt_n_per_m)
        {
            say_loss(RunPart::controller,
                     fmt::format("tool {}: a stiffness of {:.2g} N/m, too soft to feel", i,
                                 softest.get<double>()));
        }
    }
}

/// Judges the machine. A stall fades the force for milliseconds only, so it doesn't count as "force
/// off".
void Judge::judge_machine()
{
    const auto stopped = report_["deadline"]["stopped"].get<std::uint64_t>();
    if (stopped > 0)
    {
        say(RunPart::machine,
            counted(stopped, "deadline") + " missed while the process was stopped from outside");
    }
    const std::uint64_t late = begun("stall") + begun("watchdog");
    const auto brakes = report_["safety"]["supervisor_brakes"].get<std::uint64_t>();
    if (is_latency_miss())
    {
        say(RunPart::machine, fmt::format("the loop was woken late, and the force faded for a "
                                          "moment {}{}: 'hrtc doctor' lists the causes",
                                          counted(late, "time"),
                                          brakes > 0 ? fmt::format(" ({} by the supervisor)",
                                                                   counted(brakes, "brake"))
                                                     : ""));
    }
    else if (brakes > 0)
    {
        say(RunPart::controller, counted(brakes, "brake") + " by the supervisor");
    }
}

} // namespace

std::vector<Complaint> complaints_of(const Json& report)
{
    Judge judge(report);
    judge.judge_scene();
    judge.judge_controller();
    judge.judge_machine();
    return judge.take();
}

bool has_loss(std::span<const Complaint> complaints) noexcept
{
    return std::ranges::any_of(complaints, &Complaint::is_loss);
}

bool is_machine_alone(std::span<const Complaint> complaints) noexcept
{
    return std::ranges::all_of(complaints, [](const Complaint& complaint)
                               { return complaint.part == RunPart::machine; });
}

std::string verdict_text(std::span<const Complaint> complaints)
{
    if (complaints.empty())
    {
        return "ok";
    }
    std::string text;
    for (const auto& [part, name] :
         {std::pair(RunPart::scene, "mesh and scene"), std::pair(RunPart::controller, "controller"),
          std::pair(RunPart::machine, "machine")})
    {
        std::string words;
        for (const Complaint& complaint : complaints)
        {
            words += complaint.part == part ? (words.empty() ? "" : "; ") + complaint.words : "";
        }
        text +=
            fmt::format("{}{}: {}", text.empty() ? "" : " | ", name, words.empty() ? "ok" : words);
    }
    return text;
}

} // namespace tactus::hrtc
