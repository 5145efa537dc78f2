// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/doctor/checks.hpp"
#include "platform/diagnose/doctor/dds_configuration.hpp"

#include <fmt/format.h>

#include <utility>

namespace tactus::doctor
{

namespace
{

constexpr std::uint64_t kUp = 0x1; // Flags of net/if.h.
constexpr std::uint64_t kLoopback = 0x8;

struct Interface
{
    std::string name;
    bool is_there{false};
    bool is_told{false}; ///< True if flags and state were readable.
    bool is_loopback{false};
    bool is_up{false};    ///< True if switched on.
    bool has_link{false}; ///< True if also connected, or if the kind of interface has no link
                          ///< state.
};

Interface look_at(const SystemFiles& files, const std::string& name)
{
    const std::string folder = fmt::format("/sys/class/net/{}", name);
    Interface interface {
        name, files.is_folder(folder)
    };
    const auto flags = parse_hexadecimal(files.text(folder + "/flags").value_or(""));
    const auto state = files.text(folder + "/operstate");
    if (flags && state)
    {
        const std::uint64_t bits = flags.value_or(0);
        interface.is_told = true;
        interface.is_loopback = (bits & kLoopback) != 0;
        interface.is_up = (bits & kUp) != 0;
        interface.has_link = interface.is_up && (*state == "up" || *state == "unknown");
    }
    return interface;
}

std::string state_in_words(const Interface& interface)
{
    const std::string name = shown(interface.name);
    if (!interface.is_there)
    {
        return name + " does not exist";
    }
    if (!interface.is_told)
    {
        return name + " has an unknown state";
    }
    if (!interface.is_up)
    {
        return name + " is down";
    }
    return name + (interface.has_link ? " is up" : " is up without a link");
}

std::string remedy_for(const Interface& interface)
{
    const std::string name = shell_word(interface.name);
    if (!interface.is_there)
    {
        return "ip -brief link # Then set one of these in CYCLONEDDS_URI.";
    }
    return interface.is_up
               ? fmt::format("ip link show dev {} # If NO-CARRIER is shown, check the cable.", name)
               : fmt::format("sudo ip link set dev {} up", name);
}

/// Critical if a named interface is missing, down or without a link; unknown if its state is
/// unreadable.
Finding judge_named(const SystemFiles& files, const std::vector<std::string>& names)
{
    Finding finding{.verdict = Verdict::good};
    for (const std::string& name : names)
    {
        const Interface interface = look_at(files, name);
        finding.found += (finding.found.empty() ? "" : "; ") + state_in_words(interface);
        if (interface.has_link)
        {
            continue;
        }
        if (interface.is_there && !interface.is_told)
        {
            finding.verdict = finding.verdict == Verdict::good ? Verdict::unknown : finding.verdict;
            finding.remedy.push_back(fmt::format("ip link show dev {}", shell_word(name)));
            continue;
        }
        finding.verdict = Verdict::critical;
        finding.remedy.push_back(remedy_for(interface));
    }
    return finding;
}

/// DDS chooses an interface that is up, and prefers one with a network.
Finding judge_any(const SystemFiles& files)
{
    Finding finding;
    std::string loopback;
    std::string off;
    for (const std::string& name : files.names("/sys/class/net"))
    {
        const Interface interface = look_at(files, name);
        if (interface.has_link && !interface.is_loopback)
        {
            finding.verdict = Verdict::good;
            finding.found = fmt::format("no interface is named; {}", state_in_words(interface));
            return finding;
        }
        loopback = interface.has_link ? name : loopback;
        off = interface.is_told && !interface.is_loopback ? name : off;
    }
    finding.verdict = loopback.empty() ? Verdict::critical : Verdict::advice;
    finding.found = loopback.empty()
                        ? "no interface is up"
                        : fmt::format("no interface is named, and only {} is up", shown(loopback));
    finding.remedy = {off.empty() ? "ip -brief link # There is only the loopback."
                                  : fmt::format("sudo ip link set dev {} up", shell_word(off))};
    return finding;
}

} // namespace

Finding check_dds_configuration(const MachineView& view)
{
    Finding finding{.verdict = Verdict::good};
    if (view.measured.dds_uri.empty())
    {
        finding.found = "CYCLONEDDS_URI is not set";
        return finding;
    }
    const DdsConfiguration configuration =
        read_dds_configuration(view.measured.dds_uri, view.files);
    finding.found = fmt::format("CYCLONEDDS_URI is {}", shown(view.measured.dds_uri));
    if (!configuration.unreadable_file.empty())
    {
        finding.verdict = Verdict::critical;
        finding.found += fmt::format("; {} can't be read", shown(configuration.unreadable_file));
        finding.remedy = {"unset CYCLONEDDS_URI # Or set it to a readable file."};
    }
    return finding;
}

Finding check_dds_interface(const MachineView& view)
{
    if (view.files.names("/sys/class/net").empty())
    {
        return unreadable(view.files, "/sys/class/net");
    }
    if (view.measured.dds_uri.empty())
    {
        return judge_named(view.files, {"lo"});
    }
    const DdsConfiguration configuration =
        read_dds_configuration(view.measured.dds_uri, view.files);
    return configuration.interfaces.empty() ? judge_any(view.files)
                                            : judge_named(view.files, configuration.interfaces);
}

Finding check_dds_buffers(const MachineView& view)
{
    Finding finding{.verdict = Verdict::good};
    for (const auto& [name, least] :
         {std::pair("rmem_max", kReceiveBytes), std::pair("wmem_max", kSendBytes)})
    {
        const std::string path = fmt::format("/proc/sys/net/core/{}", name);
        const auto text = view.files.text(path);
        const auto bytes = text ? parse_integer(*text) : std::nullopt;
        if (!bytes || *bytes < 0)
        {
            return unreadable(view.files, path);
        }
        finding.found +=
            fmt::format("{}{} {} bytes", finding.found.empty() ? "" : ", ", name, *bytes);
        if (*bytes < least)
        {
            finding.verdict = Verdict::advice;
            finding.remedy.push_back(fmt::format(
                "echo net.core.{}={} | sudo tee -a /etc/sysctl.d/60-tactus.conf", name, least));
        }
    }
    if (finding.verdict == Verdict::advice)
    {
        finding.remedy.emplace_back("sudo sysctl --system");
    }
    return finding;
}

} // namespace tactus::doctor
