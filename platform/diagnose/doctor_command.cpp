// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/commands.hpp"
#include "platform/diagnose/doctor/doctor.hpp"
#include "platform/diagnose/doctor/machine_view.hpp"
#include "platform/machine/rt_thread.hpp"
#include "platform/program/command_line.hpp"
#include "transport/base/printable.hpp"
#include "transport/dds/catalogue.hpp"
#include "transport/dds/domain.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace tactus::hrtc
{

namespace
{

constexpr const char* kDomainCheck = "dds-domain";
constexpr std::chrono::milliseconds kLookEvery{20};
constexpr std::size_t kHeardShown = 8;

doctor::Finding not_joined(const Refusal& refusal)
{
    return {kDomainCheck,
            doctor::Verdict::critical,
            printable(refusal.text),
            "hrtc gets no models from this domain",
            {}};
}

/// Joins the names with commas, and shortens a long list.
std::string joined_names(const std::set<std::string>& names)
{
    std::string text;
    std::size_t shown = 0;
    for (const std::string& name : names)
    {
        if (shown == kHeardShown)
        {
            return text + fmt::format(" and {} more", names.size() - shown);
        }
        text += (shown++ == 0 ? "" : ", ") + name;
    }
    return text;
}

/// Joins a DDS domain, 0 to 232, as a controller and listens for `wait`. Reports the participants
/// and published models. Good if there are models, critical if the domain can't be joined, else
/// advice. Ordinary thread; waits.
doctor::Finding check_domain(const dds::DomainChoice& choice, std::chrono::milliseconds wait)
{
    const std::uint32_t domain = choice.id;
    auto joined = dds::Domain::join(choice, dds::Party::controller);
    if (!joined)
    {
        return not_joined(joined.error());
    }
    std::string refused; // Last message of the catalogue.
    auto catalogue = dds::Catalogue::create(joined.value(), [&refused](const std::string& line)
                                            { refused = line; });
    if (!catalogue)
    {
        return not_joined(catalogue.error());
    }
    const auto end = std::chrono::steady_clock::now() + wait;
    while (std::chrono::steady_clock::now() < end)
    {
        std::this_thread::sleep_for(kLookEvery);
        catalogue.value().refresh();
    }
    const std::set<std::string> heard = joined.value().participants().names();
    const std::string models = catalogue.value().names();
    const std::string where =
        fmt::format("on domain {} within {} s", domain, static_cast<double>(wait.count()) / 1e3);
    const std::string more = refused.empty() ? "" : "; " + printable(refused);
    if (heard.empty())
    {
        return {kDomainCheck,
                doctor::Verdict::advice,
                "no program is heard " + where + more,
                "hrtc finds no model on this domain: " +
                    printable_line(dds::why_unheard(domain).value_or(
                        "no spm_publish runs on this domain, or CYCLONEDDS_URI names another "
                        "interface or other peers, or a firewall blocks DDS")),
                {fmt::format("spm_publish MODEL.spm --domain {}", domain),
                 fmt::format("sudo ss -ulpn '( sport >= :{} and sport <= :{} )'",
                             7'410 + 250 * domain, 7'429 + 250 * domain)}};
    }
    const bool has_models = models != "none";
    return {kDomainCheck,
            has_models ? doctor::Verdict::good : doctor::Verdict::advice,
            fmt::format("{} heard {}; models published: {}{}", joined_names(heard), where, models,
                        more),
            has_models ? "hrtc finds these models" : "hrtc finds no model on this domain",
            has_models ? std::vector<std::string>{}
                       : std::vector{fmt::format("spm_publish MODEL.spm --domain {}", domain)},
            true};
}

/// Reason why the loop can't be pinned to a processor, in the words of hrtc; empty if it can.
std::string why_not_on(int cpu)
{
    RtThreadOptions options;
    options.cpu = cpu;
    options.lock_memory = false;
    const auto probed = probe_realtime(options);
    return probed ? "" : probed.error().text;
}

} // namespace

int run_doctor(int argc, char** argv)
{
    CommandLine line(
        "hrtc doctor",
        "Checks whether this machine is fit for the haptic loop. Prints each problem, its effect "
        "and the command that fixes it. Exit code 1 if something critical is missing.");
    std::optional<int> cpu;
    std::optional<std::uint32_t> domain;
    double wait_s = 3.0;
    bool as_json = false;
    bool shows_good = false;
    line.add_option("--cpu", cpu, "Processor planned for the haptic thread [default: none]")
        .integer_between(0, 1'023);
    const CommandOption of_domain =
        line.add_option("--domain", domain,
                        "DDS domain to check as well, with its participants and published models "
                        "[default: none]")
            .integer_between(0U, dds::kMaxDomain);
    NetworkSecurity security;
    line.add_security_options(security);
    line.add_option("--wait", wait_s, "Time to listen in that domain, in seconds")
        .number_between(0.1, 3'600.0)
        .show_default()
        .needs(of_domain);
    line.add_flag("--all", shows_good, "Also print the details of the checks without a problem");
    line.add_flag("--json", as_json, "Print the result as one JSON object");
    if (const std::optional<int> code = line.parse(argc, argv))
    {
        return *code;
    }
    if (const std::string fault = cpu ? why_not_on(*cpu) : ""; !fault.empty())
    {
        return line.fail("--cpu: " + fault, kExitUsage);
    }
    const doctor::SystemFiles files("/");
    const doctor::Measured measured = doctor::measure();
    std::vector<doctor::Finding> findings = doctor::examine({files, measured, cpu});
    if (domain)
    {
        findings.push_back(
            check_domain({*domain, security},
                         std::chrono::milliseconds(static_cast<std::int64_t>(wait_s * 1e3))));
    }
    fmt::print("{}", as_json ? doctor::make_report(findings, cpu).dump(2) + '\n'
                             : doctor::make_text(findings, shows_good));
    if (std::fflush(stdout) != 0)
    {
        return line.fail("the findings can't be written");
    }
    return doctor::count_of(findings, doctor::Verdict::critical) == 0 ? kExitDone
                                                                      : kExitCriterionNotMet;
}

} // namespace tactus::hrtc
