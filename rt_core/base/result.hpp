// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"

#include <utility>
#include <variant>

// Any thread; allocates only what a value or an error does itself.
namespace tactus
{

/// A value, or the reason why set-up or input was refused. State is unchanged after a refusal.
/// `Value` and `Error` must be different types.
template <typename Value, typename Error>
class [[nodiscard]] Result
{
public:
    Result(Value value) : content_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : content_(std::in_place_index<1>, std::move(error)) {}

    [[nodiscard]] bool has_value() const noexcept { return content_.index() == 0; }
    explicit operator bool() const noexcept { return has_value(); }

    /// The value; a bug to ask for it after a refusal.
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

    /// The reason; a bug to ask for it when there is a value.
    [[nodiscard]] const Error& error() const noexcept
    {
        TACTUS_ASSERT(!has_value());
        return *std::get_if<1>(&content_);
    }

private:
    std::variant<Value, Error> content_;
};

/// What a function returns that has nothing to say but "done".
struct Done
{
};

} // namespace tactus
