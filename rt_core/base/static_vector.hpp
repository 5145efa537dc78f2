// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace tactus
{

/// At most `Capacity` values in place. For small lists on the stack or inside records.
template <typename T, std::size_t Capacity>
class StaticVector
{
public:
    /// Appends; returns false and changes nothing when full.
    [[nodiscard]] constexpr bool try_push_back(const T& value) noexcept
    {
        if (size_ == Capacity)
        {
            return false;
        }
        items_[size_++] = value;
        return true;
    }

    /// Appends where the caller knows that there is room; a bug when there is none.
    constexpr void push_back(const T& value) noexcept
    {
        const bool pushed = try_push_back(value);
        TACTUS_ASSERT(pushed);
    }

    constexpr T pop_back() noexcept
    {
        TACTUS_ASSERT(size_ > 0);
        return items_[--size_];
    }

    constexpr void clear() noexcept { size_ = 0; }
    [[nodiscard]] constexpr std::size_t size() const noexcept { return size_; }
    [[nodiscard]] static constexpr std::size_t capacity() noexcept { return Capacity; }
    [[nodiscard]] constexpr bool empty() const noexcept { return size_ == 0; }
    [[nodiscard]] constexpr bool full() const noexcept { return size_ == Capacity; }

    constexpr T& operator[](std::size_t index) noexcept
    {
        TACTUS_ASSERT(index < size_);
        return items_[index];
    }
    constexpr const T& operator[](std::size_t index) const noexcept
    {
        TACTUS_ASSERT(index < size_);
        return items_[index];
    }

    [[nodiscard]] constexpr T* begin() noexcept { return items_.data(); }
    [[nodiscard]] constexpr T* end() noexcept { return items_.data() + size_; }
    [[nodiscard]] constexpr const T* begin() const noexcept { return items_.data(); }
    [[nodiscard]] constexpr const T* end() const noexcept { return items_.data() + size_; }
    [[nodiscard]] constexpr std::span<const T> view() const noexcept
    {
        return {items_.data(), size_};
    }

private:
    std::array<T, Capacity> items_{};
    std::size_t size_{0};
};

} // namespace tactus
