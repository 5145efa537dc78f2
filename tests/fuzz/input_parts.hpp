// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::fuzz
{

/// Reads an input as a sequence of parts: a control byte, two bytes of a size, low first, and as
/// many bytes as that, or those that are left. Bytes past the end are 0.
class InputParts
{
public:
    InputParts(const std::uint8_t* data, std::size_t size) : rest_(data, size) {}

    struct Part
    {
        unsigned control{0};
        std::vector<std::byte> bytes;
    };

    [[nodiscard]] bool is_at_end() const { return rest_.empty(); }
    unsigned byte()
    {
        const unsigned value = rest_.empty() ? 0U : rest_.front();
        rest_ = rest_.subspan(std::min<std::size_t>(rest_.size(), 1));
        return value;
    }
    Part part()
    {
        Part part;
        part.control = byte();
        const unsigned low = byte();
        const std::size_t stated = low + 256U * byte();
        const auto bytes = std::as_bytes(rest_.first(std::min(stated, rest_.size())));
        part.bytes.assign(bytes.begin(), bytes.end());
        rest_ = rest_.subspan(bytes.size());
        return part;
    }

private:
    std::span<const std::uint8_t> rest_;
};

} // namespace tactus::fuzz
