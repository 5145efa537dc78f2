// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/program/print_out.hpp"

#include <cstdio>

namespace tactus
{

void print_out(std::string_view text) noexcept
{
    static_cast<void>(std::fwrite(text.data(), 1, text.size(), stdout));
    static_cast<void>(std::fflush(stdout));
}

} // namespace tactus
