// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/doctor/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tactus::doctor
{

namespace
{

constexpr std::string_view kWhite = " \t\r\n";

std::string_view trimmed(std::string_view text)
{
    const std::size_t first = text.find_first_not_of(kWhite);
    return first == std::string_view::npos
               ? std::string_view()
               : text.substr(first, text.find_last_not_of(kWhite) - first + 1);
}

std::string without_comments(std::string_view xml)
{
    std::string text;
    for (std::size_t at = 0; at < xml.size();)
    {
        const std::size_t open = std::min(xml.find("<!--", at), xml.size());
        text += xml.substr(at, open - at);
        const std::size_t close = xml.find("-->", open);
        at = close == std::string_view::npos ? xml.size() : close + 3;
    }
    return text;
}

/// Value of an attribute of one tag; empty if the tag lacks it.
std::string_view attribute_of(std::string_view tag, std::string_view name)
{
    for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1))
    {
        std::string_view rest = trimmed(tag.substr(at + name.size()));
        const bool is_whole_name = at > 0 && kWhite.find(tag[at - 1]) != std::string_view::npos;
        if (!is_whole_name || !rest.starts_with('='))
        {
            continue;
        }
        rest = trimmed(rest.substr(1));
        if (!rest.starts_with('"') && !rest.starts_with('\''))
        {
            continue;
        }
        const std::size_t end = rest.find(rest.front(), 1);
        return end == std::string_view::npos ? std::string_view() : rest.substr(1, end - 1);
    }
    return {};
}

/// Adds the name of an interface. Names that contain a path are dropped, since the name becomes a
/// part of a path.
void add_interface(std::string_view name, std::vector<std::string>& interfaces)
{
    const bool is_name = !name.empty() && name != "auto" && name != "." && name != ".." &&
                         name.find('/') == std::string_view::npos;
    if (is_name && std::ranges::count(interfaces, name) == 0)
    {
        interfaces.emplace_back(name);
    }
}

void read_xml(std::string_view xml, std::vector<std::string>& interfaces)
{
    constexpr std::string_view kTag = "<NetworkInterface";
    constexpr std::string_view kElder = "<NetworkInterfaceAddress>";
    const std::string text = without_comments(xml);
    const std::string_view all = text;
    for (std::size_t at = all.find(kTag); at != std::string_view::npos; at = all.find(kTag, at + 1))
    {
        const std::string_view rest = all.substr(at);
        if (rest.starts_with(kElder))
        {
            const std::string_view content = rest.substr(kElder.size());
            add_interface(trimmed(content.substr(0, content.find('<'))), interfaces);
            continue;
        }
        add_interface(attribute_of(rest.substr(0, rest.find('>')), "name"), interfaces);
    }
}

} // namespace

DdsConfiguration read_dds_configuration(std::string_view uri, const SystemFiles& files)
{
    constexpr std::string_view kScheme = "file://";
    DdsConfiguration configuration;
    std::string_view rest = trimmed(uri);
    while (!rest.empty())
    {
        if (rest.front() == ',')
        {
            rest = trimmed(rest.substr(1));
            continue;
        }
        if (rest.front() == '<') // XML has commas of its own, so it ends the list.
        {
            read_xml(rest, configuration.interfaces);
            break;
        }
        const std::size_t comma = std::min(rest.find(','), rest.size());
        const std::string_view item = trimmed(rest.substr(0, comma));
        const std::string path(item.starts_with(kScheme) ? item.substr(kScheme.size()) : item);
        const auto content = files.text(path);
        if (content)
        {
            read_xml(*content, configuration.interfaces);
        }
        else if (configuration.unreadable_file.empty())
        {
            configuration.unreadable_file = path;
        }
        rest = rest.substr(comma);
    }
    return configuration;
}

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
