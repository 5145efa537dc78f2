// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/interleave/explorer.hpp"

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace tactus::interleave
{

/// Replacement of std::atomic in explored code: every operation may be preceded by other threads'.
/// Integers of up to 64 bits; loads and stores only.
template <typename T>
class CheckedAtomic
{
    static_assert(std::is_unsigned_v<T>);

public:
    CheckedAtomic() : CheckedAtomic(T{}) {}
    CheckedAtomic(T value) // NOLINT: implicit, as std::atomic's is.
        : location_(Execution::current().add_location(value))
    {
    }
    CheckedAtomic(const CheckedAtomic&) = delete;
    CheckedAtomic& operator=(const CheckedAtomic&) = delete;

    [[nodiscard]] T load(std::memory_order order) const
    {
        return static_cast<T>(Execution::current().load(location_, order));
    }
    void store(T value, std::memory_order order)
    {
        Execution::current().store(location_, value, order);
    }

private:
    std::size_t location_;
};

/// Shared plain variable: two accesses, one a write, must be ordered by happens-before.
template <typename T>
class CheckedSlot
{
public:
    CheckedSlot() = default;
    CheckedSlot(const CheckedSlot&) = delete;
    CheckedSlot& operator=(const CheckedSlot&) = delete;

    CheckedSlot& operator=(const T& value)
    {
        Execution::current().write_plain(history_);
        value_ = value;
        return *this;
    }
    operator T() const // NOLINT: implicit, to be read like a T.
    {
        Execution::current().read_plain(history_);
        return value_;
    }

private:
    T value_{};
    mutable PlainHistory history_{};
};

/// Requirement in a program; the execution fails with `what` if it does not hold.
inline void require(bool holds, const char* what)
{
    if (!holds)
    {
        Execution::current().fail(what);
    }
}

/// Program of functions over one shared state, which is created for each execution.
template <typename State>
class SmallProgram final : public Program
{
public:
    using Body = std::function<void(State&)>;

    explicit SmallProgram(std::vector<Body> bodies, Body at_end = {})
        : bodies_(std::move(bodies)), at_end_(std::move(at_end))
    {
    }

    [[nodiscard]] std::vector<std::function<void()>> threads() override
    {
        std::vector<std::function<void()>> threads;
        for (const Body& body : bodies_)
        {
            threads.emplace_back([this, &body] { body(state_); });
        }
        return threads;
    }
    void at_end() override
    {
        if (at_end_)
        {
            at_end_(state_);
        }
    }

private:
    State state_;
    std::vector<Body> bodies_;
    Body at_end_;
};

template <typename State>
[[nodiscard]] Exploration explore_small(std::vector<typename SmallProgram<State>::Body> bodies,
                                        typename SmallProgram<State>::Body at_end = {},
                                        std::span<const Fault> faults = {})
{
    return explore([&] { return std::make_unique<SmallProgram<State>>(bodies, at_end); }, faults);
}

} // namespace tactus::interleave
