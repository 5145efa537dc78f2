// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/interleave/explorer.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <iostream>

namespace tactus::interleave
{

/// Expects that every order was run, at least `at_least`, and all were correct.
inline void expect_sound(const char* what, const Exploration& result, std::uint64_t at_least)
{
    EXPECT_EQ(result.failure, "");
    EXPECT_GE(result.executions, at_least);
    std::cout << what << ": " << result.executions << " executions, " << result.redundant
              << " given up as redundant\n";
}

} // namespace tactus::interleave
