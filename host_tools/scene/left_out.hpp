// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace tactus
{

/// What of a scene is left out, for notes: one line a reason, which names what it holds for.
class LeftOut
{
public:
    void add(const std::string& reason, const std::string& what);

    /// "A, B, C and 4 more left out: REASON", ordered by the reasons.
    [[nodiscard]] std::vector<std::string> notes() const;

private:
    struct Things
    {
        std::string named; ///< The first ones.
        std::size_t count{0};
    };
    std::map<std::string, Things> by_reason_;
};

} // namespace tactus
