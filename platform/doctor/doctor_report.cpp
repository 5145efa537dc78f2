// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/doctor/doctor_report.hpp"

#include "platform/doctor/doctor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace tactus::doctor
{

namespace
{

using Json = nlohmann::ordered_json;

constexpr std::size_t kColumns = 100;
constexpr std::size_t kIndent = 29;

/// Breaks between words; lines after the first begin at kIndent.
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

std::string counts_in_words(const std::vector<Finding>& findings)
{
    std::string text;
    for (std::size_t i = 0; i < kVerdictNames.size(); ++i)
    {
        text += fmt::format("{}{} {}", i == 0 ? "" : ", ",
                            count_of(findings, static_cast<Verdict>(i)), kVerdictNames[i]);
    }
    return text;
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

std::string make_text(const std::vector<Finding>& findings)
{
    std::string text;
    for (const Finding& finding : findings)
    {
        text += block_of(finding) + '\n';
    }
    return text + counts_in_words(findings) + '\n';
}

} // namespace tactus::doctor
