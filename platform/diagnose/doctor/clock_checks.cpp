// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/doctor/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace tactus::doctor
{

namespace
{

constexpr const char* kCurrentSource =
    "/sys/devices/system/clocksource/clocksource0/current_clocksource";
constexpr const char* kSources =
    "/sys/devices/system/clocksource/clocksource0/available_clocksource";

/// Clock sources that every kernel of the last years reads in user space, the best first. Others,
/// such as xen, may be as good; only a count of the system calls tells.
constexpr std::array<std::string_view, 4> kReadInUserSpace{"tsc", "arch_sys_counter", "kvm-clock",
                                                           "hyperv_clocksource_tsc_page"};
constexpr std::array<std::string_view, 6> kReadByCall{
    "hpet", "acpi_pm", "jiffies", "refined-jiffies", "pit", "hyperv_clocksource_msr"};

std::string take_better_source(const SystemFiles& files, const std::string& current,
                               const std::string& machine)
{
    const std::string list = files.text(kSources).value_or("");
    for (const std::string_view source : kReadInUserSpace)
    {
        if (source != current && has_word(list, source))
        {
            return fmt::format("echo {} | sudo tee {}", source, kCurrentSource);
        }
    }
    return machine == "x86_64"
               ? add_to_kernel_line("clocksource=tsc tsc=reliable")
               : "dmesg | grep -i clocksource # Shows why there is no better source.";
}

} // namespace

Finding check_clock_source(const MachineView& view)
{
    Finding finding{.verdict = Verdict::good};
    const auto source = view.files.text(kCurrentSource);
    const auto calls = view.measured.clock_calls;
    if (!calls && !source)
    {
        return unreadable(view.files, kCurrentSource);
    }
    const bool by_call = calls ? *calls > 0 : std::ranges::count(kReadByCall, *source) > 0;
    if (!calls && !by_call && std::ranges::count(kReadInUserSpace, *source) == 0)
    {
        return unreadable(view.files, kCurrentSource);
    }
    finding.found = fmt::format(
        "{}, {}", source ? shown(*source) : "unknown source",
        calls     ? fmt::format("{} system calls in {} reads", *calls, Measured::kClockReads)
        : by_call ? "read by a system call"
                  : "read without a system call");
    if (by_call)
    {
        finding.verdict = Verdict::critical;
        finding.remedy = {
            take_better_source(view.files, source.value_or(""), view.measured.machine)};
    }
    return finding;
}

Finding check_timer(const MachineView& view)
{
    Finding finding{.verdict = Verdict::good};
    const auto resolution_ns = view.measured.clock_resolution_ns;
    if (!resolution_ns || *resolution_ns <= 0)
    {
        finding.verdict = Verdict::unknown;
        finding.found = "the resolution of CLOCK_MONOTONIC is unknown";
        finding.remedy = {"grep -m 1 resolution /proc/timer_list"};
        return finding;
    }
    finding.found = fmt::format("timer resolution of {} ns", *resolution_ns);
    if (*resolution_ns <= kMostResolution_ns)
    {
        return finding;
    }
    finding.verdict = Verdict::critical;
    const bool is_off = has_word(view.files.text("/proc/cmdline").value_or(""), "highres=off");
    finding.remedy = {is_off ? "sudo sed -i 's/highres=off//' /etc/default/grub && "
                               "sudo update-grub && sudo reboot"
                             : "grep HIGH_RES_TIMERS /boot/config-$(uname -r) # Must be y."};
    return finding;
}

Finding check_float_control(const MachineView& view)
{
    Finding finding{.verdict = Verdict::good,
                    .found = "new threads keep denormals and round to nearest"};
    if (view.measured.float_control_is_default)
    {
        return finding;
    }
    finding.verdict = Verdict::critical;
    finding.found = "new threads flush denormals (FTZ, DAZ), use another rounding mode or trap";
    if (view.measured.preloaded.empty())
    {
        finding.remedy = {
            "for l in $(ldd \"$(command -v hrtc)\" | grep -o '/[^ ]*'); do objdump -d "
            "$l | grep -q ldmxcsr && echo $l; done # Rebuild without -ffast-math."};
        return finding;
    }
    finding.found += fmt::format("; LD_PRELOAD is {}", shown(view.measured.preloaded));
    finding.remedy = {"unset LD_PRELOAD"};
    return finding;
}

} // namespace tactus::doctor
