// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/base/print_assertions.hpp"

#include "rt_core/base/assert.hpp"

#include <cstdio>

namespace tactus
{

namespace
{

void print_assertion(const char* condition, const char* file, int line) noexcept
{
    static_cast<void>(
        std::fprintf(stderr, "assertion failed: %s (%s:%d)\n", condition, file, line));
}

} // namespace

void print_failed_assertions() noexcept
{
    if (const AssertHandler before = set_assert_handler(print_assertion); before != nullptr)
    {
        set_assert_handler(before);
    }
}

} // namespace tactus
