// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"

#include <utility>
#include <variant>

// Any thread; allocates only what a value or an error does itself.
namespace tactus
{

/// A value, or the reason why set-up or input was refused. A refusal leaves the state unchanged.
/// `Value` and `Error` must be different types.
template <typename Value, typename Error>
class [[nodiscard]] Result
{
public:
    Result(Value value) : content_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : content_(std::in_place_index<1>, std::move(error)) {}

    [[nodiscard]] bool has_value() const noexcept { return content_.index() == 0; }
    explicit operator bool() const noexcept { return has_value(); }

    /// The value; calling it after a refusal is a bug (asserted).
    [[nodiscard]] Value& value() & noexcept
    {
        TACTUS_ASSERT(has_value());
        return *std::get_if<0>(&content_);
    }
    [[nodiscard]] const Value& value() const& noexcept
    {
        TACTUS_ASSERT(has_value());
        return *std::get_if<0>(&content_);
    }
    [[nodiscard]] Value&& value() && noexcept
    {
        TACTUS_ASSERT(has_value());
        return std::move(*std::get_if<0>(&content_));
    }

    /// The reason; calling it when there is a value is a bug (asserted).
    [[nodiscard]] const Error& error() const noexcept
    {
        TACTUS_ASSERT(!has_value());
        return *std::get_if<1>(&content_);
    }

private:
    std::variant<Value, Error> content_;
};

/// Value of a Result that only reports success.
struct Done
{
};

} // namespace tactus
