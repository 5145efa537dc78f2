// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"

#include <array>
#include <cstddef>
#include <new>
#include <span>
#include <type_traits>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// List of at most `Capacity` values in place, for the stack or inside records. Construction costs
/// nothing: unused capacity is not initialised. An index beyond the size and pop_back() of an empty
/// list are bugs (asserted).
template <typename T, std::size_t Capacity>
class StaticVector // NOLINT(cppcoreguidelines-special-member-functions): moving is copying.
{
    static_assert(std::is_trivially_destructible_v<T>);
    static_assert(Capacity > 0);

public:
    StaticVector() noexcept {} // NOLINT(modernize-use-equals-default): `= default` would zero it.
    StaticVector(const StaticVector& other) noexcept { assign(other); }
    StaticVector& operator=(const StaticVector& other) noexcept
    {
        if (this != &other)
        {
            assign(other);
        }
        return *this;
    }
    ~StaticVector() = default;

    /// Appends; false, with nothing changed, if the list is full.
    [[nodiscard]] bool try_push_back(const T& value) noexcept
    {
        if (size_ == Capacity)
        {
            return false;
        }
        ::new (static_cast<void*>(begin() + size_)) T(value);
        ++size_;
        return true;
    }

    /// Appends; a full list is a bug (asserted).
    void push_back(const T& value) noexcept
    {
        const bool pushed = try_push_back(value);
        TACTUS_ASSERT(pushed);
    }

    T pop_back() noexcept
    {
        TACTUS_ASSERT(size_ > 0);
        return begin()[--size_];
    }

    void clear() noexcept { size_ = 0; }
    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    [[nodiscard]] static constexpr std::size_t capacity() noexcept { return Capacity; }
    [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
    [[nodiscard]] bool full() const noexcept { return size_ == Capacity; }

    T& operator[](std::size_t index) noexcept
    {
        TACTUS_ASSERT(index < size_);
        return begin()[index];
    }
    const T& operator[](std::size_t index) const noexcept
    {
        TACTUS_ASSERT(index < size_);
        return begin()[index];
    }

    [[nodiscard]] T* begin() noexcept { return std::launder(reinterpret_cast<T*>(bytes_.data())); }
    [[nodiscard]] T* end() noexcept { return begin() + size_; }
    [[nodiscard]] const T* begin() const noexcept
    {
        return std::launder(reinterpret_cast<const T*>(bytes_.data()));
    }
    [[nodiscard]] const T* end() const noexcept { return begin() + size_; }
    [[nodiscard]] std::span<const T> view() const noexcept { return {begin(), size_}; }

private:
    void assign(const StaticVector& other) noexcept
    {
        size_ = 0;
        for (const T& item : other)
        {
            push_back(item);
        }
    }

    alignas(T)
        std::array<std::byte, Capacity * sizeof(T)> bytes_; ///< Only the first `size_` are objects.
    std::size_t size_{0};
};

} // namespace tactus
