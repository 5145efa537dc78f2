// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/doctor/doctor.hpp"

#include "platform/diagnose/doctor/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace tactus::doctor
{

namespace
{

using Check = Finding (*)(const MachineView&);

constexpr std::array<Check, 17> kChecks{
    check_priority,      check_memory_lock, check_clock_source,      check_timer,
    check_float_control, check_preemption,  check_throttling,        check_compaction,
    check_isolation,     check_interrupts,  check_governor,          check_idle_states,
    check_siblings,      check_huge_pages,  check_dds_configuration, check_dds_interface,
    check_dds_buffers,
};

} // namespace

std::vector<Finding> examine(const MachineView& view)
{
    std::vector<Finding> findings;
    for (const Check check : kChecks)
    {
        findings.push_back(check(view));
    }
    return findings;
}

std::size_t count_of(const std::vector<Finding>& findings, Verdict verdict)
{
    return static_cast<std::size_t>(std::ranges::count(findings, verdict, &Finding::verdict));
}

namespace
{

using Json = nlohmann::ordered_json;

constexpr std::size_t kColumns = 100;
constexpr std::size_t kIndent = 29;

/// Breaks the text between words; lines after the first begin at kIndent.
std::string wrapped(std::string_view text)
{
    const std::size_t most = kColumns - kIndent;
    std::string lines;
    while (text.size() > most)
    {
        std::size_t end = text.rfind(' ', most);
        end = end == std::string_view::npos || end == 0 ? most : end;
        lines += fmt::format("{}\n{:{}}", text.substr(0, end), "", kIndent);
        text.remove_prefix(text[end] == ' ' ? end + 1 : end);
    }
    return lines + std::string(text);
}

std::string block_of(const Finding& finding)
{
    std::string block =
        fmt::format("{:<9} {:<18} {}\n{:{}}{}\n", name_of(finding.verdict), finding.name,
                    wrapped(finding.found), "", kIndent, wrapped(finding.why));
    for (const std::string& command : finding.remedy)
    {
        block += fmt::format("{:{}}$ {}\n", "", kIndent, command);
    }
    return block;
}

/// Verdicts in the order of display, the worst first.
constexpr std::array kShown{Verdict::critical, Verdict::unknown, Verdict::advice, Verdict::good};

std::string counts_in_words(const std::vector<Finding>& findings)
{
    std::string text;
    for (const Verdict verdict : kShown)
    {
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count_of(findings, verdict),
                            name_of(verdict));
    }
    return text;
}

/// Line with the names of the good findings.
std::string good_ones(const std::vector<Finding>& findings)
{
    std::string names;
    for (const Finding& finding : findings)
    {
        if (finding.verdict == Verdict::good && !finding.is_asked_for)
        {
            names += (names.empty() ? "" : ", ") + finding.name;
        }
    }
    return names.empty()
               ? ""
               : fmt::format("\n{:<9} {:<18} {}\n", name_of(Verdict::good), "", wrapped(names));
}

} // namespace

Json make_report(const std::vector<Finding>& findings, std::optional<int> cpu)
{
    Json counts = Json::object();
    for (std::size_t i = 0; i < kVerdictNames.size(); ++i)
    {
        counts[kVerdictNames[i]] = count_of(findings, static_cast<Verdict>(i));
    }
    Json checks = Json::array();
    for (const Finding& finding : findings)
    {
        checks.push_back({{"name", finding.name},
                          {"verdict", name_of(finding.verdict)},
                          {"found", finding.found},
                          {"why", finding.why},
                          {"remedy", finding.remedy}});
    }
    Json report{{"schema", 1}, {"cpu", nullptr}, {"counts", counts}, {"checks", checks}};
    if (cpu)
    {
        report["cpu"] = *cpu;
    }
    return report;
}

std::string make_text(const std::vector<Finding>& findings, bool shows_good)
{
    std::string text = counts_in_words(findings) + '\n';
    for (const Verdict verdict : kShown)
    {
        for (const Finding& finding : findings)
        {
            const bool is_shown = verdict != Verdict::good || shows_good || finding.is_asked_for;
            if (finding.verdict == verdict && is_shown)
            {
                text += '\n' + block_of(finding);
            }
        }
    }
    return text + (shows_good ? "" : good_ones(findings));
}

} // namespace tactus::doctor
