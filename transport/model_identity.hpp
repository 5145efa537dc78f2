// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/header.hpp"

#include <cstdint>
#include <string>

// Any thread: these are values; their strings allocate.
namespace tactus
{

/// Identity of a model on the wire.
struct ModelIdentity
{
    std::string name; ///< Published name; passes is_valid_name().
    ContentHash hash{};
    std::uint32_t revision{0};

    bool operator==(const ModelIdentity&) const = default;
};

} // namespace tactus
