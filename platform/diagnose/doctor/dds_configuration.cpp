// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/doctor/dds_configuration.hpp"

#include <algorithm>

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

} // namespace tactus::doctor
