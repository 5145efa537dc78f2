// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tactus
{

/// First broken invariant that a validator found; none if everything is sound.
struct Flaw
{
    const char* thing{nullptr}; ///< "block", "face" ...; null if everything is sound.
    std::uint32_t index{0};     ///< Number of the thing.
    const char* what{nullptr};  ///< Description of the flaw: "is in use and free".

    [[nodiscard]] constexpr bool is_none() const noexcept { return thing == nullptr; }
};

/// "block 12 is in use and free", cut to 127 characters; empty if there is no flaw.
using FlawText = std::array<char, 128>;

[[nodiscard]] constexpr FlawText text_of(const Flaw& flaw) noexcept
{
    FlawText text{};
    if (flaw.is_none())
    {
        return text;
    }
    std::array<char, 11> digits{};
    std::size_t at = digits.size() - 1;
    digits[--at] = static_cast<char>('0' + flaw.index % 10);
    for (std::uint32_t left = flaw.index / 10; left > 0; left /= 10)
    {
        digits[--at] = static_cast<char>('0' + left % 10);
    }
    std::size_t length = 0;
    for (const char* part :
         std::array<const char*, 5>{flaw.thing, " ", &digits[at], " ", flaw.what})
    {
        for (; *part != '\0' && length + 1 < text.size(); ++part)
        {
            text[length++] = *part;
        }
    }
    return text;
}

/// Keeps the first flaw of a validator's checks.
class FlawFinder
{
public:
    /// Keeps a flaw of the thing with number `index` if `holds` is false and no earlier flaw is
    /// kept. Returns `holds`.
    constexpr bool expect(bool holds, const char* thing, std::uint32_t index,
                          const char* what) noexcept
    {
        if (!holds && first_.is_none())
        {
            first_ = {thing, index, what};
        }
        return holds;
    }

    [[nodiscard]] constexpr bool is_sound() const noexcept { return first_.is_none(); }
    [[nodiscard]] constexpr const Flaw& first() const noexcept { return first_; }

private:
    Flaw first_;
};

} // namespace tactus
