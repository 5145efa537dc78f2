// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/options/kernel_choice.hpp"

#include "transport/base/printable.hpp"

#include <fmt/format.h>

#include <string>

namespace tactus::hrtc
{

Result<const Kernels*, Refusal> choose_kernels(std::string_view name,
                                               std::span<const Kernels* const> available)
{
    std::string names;
    for (const Kernels* kernels : available)
    {
        if (kernels->name == name)
        {
            return kernels;
        }
        names += (names.empty() ? "" : ", ") + std::string(kernels->name);
    }
    return Refusal{fmt::format("--kernels: '{}' is not one of the kernels for this processor: {}",
                               printable(name), names)};
}

} // namespace tactus::hrtc
