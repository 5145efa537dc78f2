// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/byte_io.hpp"

#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

namespace tactus
{

/// Appends a value in little-endian, without padding: the counterpart of ByteReader.
template <typename T>
void append(std::vector<std::byte>& bytes, const T& value)
{
    static_assert(std::is_arithmetic_v<T>);
    const auto* first = reinterpret_cast<const std::byte*>(&value);
    bytes.insert(bytes.end(), first, first + sizeof(T));
}

inline void append_bytes(std::vector<std::byte>& bytes, std::span<const std::byte> more)
{
    bytes.insert(bytes.end(), more.begin(), more.end());
}

} // namespace tactus
