// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/world/world_values.hpp"

#include <cctype>
#include <cstddef>
#include <string_view>
#include <utility>

namespace tactus::hrtc
{

namespace
{

/// Options whose names differ in more than dashes. A name stands before those that it begins with.
constexpr std::pair<std::string_view, std::string_view> kNames[] = {
    {"--pool-mib", "memory_mib"},
    {"--memory-mib", "the machine"},
    {"--rate", "rate_hz"},
    {"--stiffness", "stiffness_n_per_m"},
    {"--angular-stiffness", "angular_stiffness_nm_per_rad"},
    {"--force-shading", "shading_m"},
    {"--force-tolerance", "force_tolerance_n"},
    {"--objects", "objects_max"},
    {"--tool-mass", "payload"},
    {"--place", "pose"},
    {"--edits", "--edits"}, // The option of a server.
};

/// Characters before an option of a message; dashes behind others are those of a file's name.
constexpr std::string_view kBefore = " '(";

bool is_of_name(char c)
{
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-';
}

/// Name of a World's option or part for an option of hrtc, without the leading dashes if no other
/// name is known.
std::string name_of(std::string_view option)
{
    for (const auto& [of_hrtc, of_world] : kNames)
    {
        if (option == of_hrtc)
        {
            return std::string(of_world);
        }
    }
    std::string name(option.substr(2));
    for (char& c : name)
    {
        c = c == '-' ? '_' : c;
    }
    return name;
}

} // namespace

std::string world_words(std::string text)
{
    std::string said;
    for (std::size_t at = 0; at < text.size();)
    {
        const bool begins = at == 0 || kBefore.find(text[at - 1]) != std::string_view::npos;
        const bool is_option = begins && text.compare(at, 2, "--") == 0 && at + 2 < text.size() &&
                               std::islower(static_cast<unsigned char>(text[at + 2])) != 0;
        if (!is_option)
        {
            said += text[at++];
            continue;
        }
        std::size_t end = at + 2;
        while (end < text.size() && is_of_name(text[end]))
        {
            ++end;
        }
        said += name_of(std::string_view(text).substr(at, end - at));
        at = end;
    }
    return said;
}

} // namespace tactus::hrtc
