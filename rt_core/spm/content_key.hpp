// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/header.hpp"

#include <cstdint>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// Kind of one transferred piece of a model.
enum class ContentKind : std::uint8_t
{
    base = 0,
    index_page = 1,
    chunk = 2,
    header = 3, ///< Only used on the wire.
};

/// Names one piece within one model. `number` is that of the index page or chunk, and 0 for the
/// base mesh. On the wire, which splits base mesh and header, it is the part's number.
struct ContentKey
{
    ContentKind kind{ContentKind::base};
    std::uint32_t number{0};

    constexpr bool operator==(const ContentKey&) const noexcept = default;
};

/// Names one piece globally; on the wire it precedes every piece: 28 bytes, little-endian. `model`
/// is the first 128 bits of the header's root hash.
struct WireKey
{
    ContentHash model{};
    std::uint32_t revision{0};
    std::uint32_t kind{0}; ///< ContentKind.
    std::uint32_t number{0};

    constexpr bool operator==(const WireKey&) const noexcept = default;
};

static_assert(sizeof(WireKey) == 28);

} // namespace tactus
