// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/doctor_command.hpp"

#include "platform/diagnose/doctor/doctor.hpp"
#include "platform/diagnose/doctor/doctor_report.hpp"
#include "platform/diagnose/domain_check.hpp"
#include "platform/machine/rt_thread.hpp"
#include "platform/program/command_line.hpp"
#include "transport/dds/domain.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

namespace tactus::hrtc
{

namespace
{

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
