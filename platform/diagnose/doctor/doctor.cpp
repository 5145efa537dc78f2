// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/doctor/doctor.hpp"

#include "platform/diagnose/doctor/clock_checks.hpp"
#include "platform/diagnose/doctor/kernel_checks.hpp"
#include "platform/diagnose/doctor/network_checks.hpp"
#include "platform/diagnose/doctor/processor_checks.hpp"
#include "platform/diagnose/doctor/rights_checks.hpp"

#include <algorithm>
#include <array>

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

} // namespace tactus::doctor
