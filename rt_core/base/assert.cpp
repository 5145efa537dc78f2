// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/base/assert.hpp"

#include <atomic>

namespace tactus
{

namespace
{

// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables): one handler per process.
std::atomic<AssertHandler> current_handler{nullptr};

} // namespace

AssertHandler set_assert_handler(AssertHandler handler) noexcept
{
    return current_handler.exchange(handler);
}

void assertion_failed(const char* condition, const char* file, int line) noexcept
{
    if (const AssertHandler handler = current_handler.load(); handler != nullptr)
    {
        handler(condition, file, line);
    }
    __builtin_trap();
}

} // namespace tactus
