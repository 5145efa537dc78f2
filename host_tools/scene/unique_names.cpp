// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/scene/unique_names.hpp"

#include "rt_core/base/assert.hpp"
#include "transport/model_name.hpp"

#include <map>
#include <set>

namespace tactus
{

std::string plain_name(std::string_view given)
{
    std::string name(given.substr(0, kMaxNameBytes));
    for (char& c : name)
    {
        c = is_valid_name({&c, 1}) ? c : '_';
    }
    return name;
}

std::vector<std::string> unique_names(std::span<const std::string> names)
{
    std::set<std::string, std::less<>> taken(names.begin(), names.end());
    std::map<std::string, std::size_t, std::less<>> last_number; // Of each name that came up.
    std::vector<std::string> result;
    for (const std::string& name : names)
    {
        TACTUS_ASSERT(is_valid_name(name));
        std::size_t& number = last_number[name];
        std::string own = name;
        for (++number; number > 1; ++number)
        {
            const std::string ending = "-" + std::to_string(number);
            own = name.substr(0, kMaxNameBytes - ending.size()) + ending;
            if (taken.insert(own).second)
            {
                break;
            }
        }
        result.push_back(std::move(own));
    }
    return result;
}

} // namespace tactus
