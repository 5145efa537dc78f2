// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace tactus
{

/// Collects ignored parts of a scene for notes: one line for each reason, with the names of the
/// first three parts.
class LeftOut
{
public:
    void add(const std::string& reason, const std::string& what);

    /// Lines "A, B, C and 4 more left out: REASON", ordered by the reasons.
    [[nodiscard]] std::vector<std::string> notes() const;

private:
    struct Things
    {
        std::string named; ///< Names of the first three parts.
        std::size_t count{0};
    };
    std::map<std::string, Things> by_reason_;
};

} // namespace tactus
