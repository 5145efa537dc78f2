// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"

#include <stdexcept>
#include <utility>

namespace tactus::bench
{

/// Reason, in one line, why a case cannot be run or has wrong answers. Thrown; ends the case.
class Failure : public std::runtime_error
{
public:
    using std::runtime_error::runtime_error;
};

/// Value of a result; a failure if it was refused.
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
