// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/base/byte_io.hpp"
#include "rt_core/math/vec3.hpp"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

namespace tactus
{

/// Writes into memory of fixed size, which must suffice (asserted).
class FixedWriter
{
public:
    explicit FixedWriter(std::span<std::byte> bytes) noexcept : bytes_(bytes) {}

    template <typename T>
    void write(const T& value) noexcept
    {
        static_assert(std::is_arithmetic_v<T>);
        TACTUS_ASSERT(bytes_.size() - at_ >= sizeof(T));
        std::memcpy(bytes_.data() + at_, &value, sizeof(T));
        at_ += sizeof(T);
    }
    void write_bytes(std::span<const std::byte> bytes) noexcept
    {
        TACTUS_ASSERT(bytes_.size() - at_ >= bytes.size());
        std::copy(bytes.begin(), bytes.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(at_));
        at_ += bytes.size();
    }
    void write_vector(const Vec3& value) noexcept
    {
        write(value.x());
        write(value.y());
        write(value.z());
    }
    /// Writes a rotation, row by row.
    void write_rotation(const Mat3& rotation) noexcept
    {
        for (int row = 0; row < 3; ++row)
        {
            write_vector(rotation.row(row).transpose());
        }
    }
    [[nodiscard]] std::size_t size() const noexcept { return at_; }

private:
    std::span<std::byte> bytes_;
    std::size_t at_{0};
};

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
