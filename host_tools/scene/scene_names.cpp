// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/scene/scene_names.hpp"

#include "rt_core/base/assert.hpp"
#include "transport/base/printable.hpp"
#include "transport/model_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace tactus
{

std::string plain_name(std::string_view given)
{
    std::string name;
    std::string_view rest = whole_characters(given, kMaxNameBytes);
    while (!rest.empty())
    {
        const std::string_view character =
            rest.substr(0, std::max<std::size_t>(character_bytes(rest), 1));
        name += is_name_character(character) ? character : "_";
        rest.remove_prefix(character.size());
    }
    return name;
}

std::vector<std::string> unique_names(std::span<const std::string> names)
{
    std::set<std::string, std::less<>> taken(names.begin(), names.end());
    // Last number appended to each name.
    std::map<std::string, std::size_t, std::less<>> last_number;
    std::vector<std::string> result;
    for (const std::string& name : names)
    {
        TACTUS_ASSERT(is_valid_name(name));
        std::size_t& number = last_number[name];
        std::string own = name;
        for (++number; number > 1; ++number)
        {
            const std::string ending = "-" + std::to_string(number);
            own = std::string(whole_characters(name, kMaxNameBytes - ending.size())) + ending;
            if (taken.insert(own).second)
            {
                break;
            }
        }
        result.push_back(std::move(own));
    }
    return result;
}

namespace
{

/// Number of parts named in a line; more names would hide the reason.
constexpr std::size_t kNamed = 3;

} // namespace

void LeftOut::add(const std::string& reason, const std::string& what)
{
    Things& things = by_reason_[reason];
    if (++things.count <= kNamed)
    {
        things.named += (things.count == 1 ? "" : ", ") + what;
    }
}

std::vector<std::string> LeftOut::notes() const
{
    std::vector<std::string> notes;
    for (const auto& [reason, things] : by_reason_)
    {
        const std::string more =
            things.count > kNamed ? fmt::format(" and {} more", things.count - kNamed) : "";
        notes.push_back(fmt::format("{}{} left out: {}", things.named, more, reason));
    }
    return notes;
}

} // namespace tactus
