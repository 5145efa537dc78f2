// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus
{

/// Valid name for any given name: each character that is not allowed, blanks included, becomes '_',
/// and the result is cut to at most 63 bytes. Empty stays empty.
[[nodiscard]] std::string plain_name(std::string_view given);

/// Makes names unique, in their order: the first of equal ones keeps the name, each further one
/// gets "-2", "-3" and so on, the first that is unused. `names` must be valid (is_valid_name), and
/// so are the results. n log n.
[[nodiscard]] std::vector<std::string> unique_names(std::span<const std::string> names);

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
