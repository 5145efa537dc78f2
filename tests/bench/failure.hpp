// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"

#include <stdexcept>
#include <utility>

namespace tactus::bench
{

/// Why a case can't be run, or that it gave wrong answers: a line, thrown, that ends the case.
class Failure : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
};

/// What a step brought; a failure when it was refused.
template <typename Value, typename Error>
Value needed(Result<Value, Error> result)
{
    if (!result)
    {
        throw Failure(result.error().text);
    }
    return std::move(result).value();
}

} // namespace tactus::bench
