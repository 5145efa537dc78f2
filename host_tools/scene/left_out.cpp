// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/scene/left_out.hpp"

#include <fmt/format.h>

namespace tactus
{

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
