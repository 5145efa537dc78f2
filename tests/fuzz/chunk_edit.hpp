// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/coded_record.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus::fuzz
{

/// Change of a chunk: of its bytes or of a record parsed from it.
struct Edit
{
    enum Kind : std::uint32_t
    {
        set_byte,
        flip_bit,
        cut,
        insert_byte,
        set_anchor, ///< First kind of a change of records.
        set_place,
        set_fan,
        set_other,
        set_residual,
        set_error,
        set_bucket,
        kinds
    };

    std::uint32_t chunk{0};
    Kind kind{set_byte};
    std::uint32_t place{0};
    std::uint32_t value{0};
};

/// Applies an edit of bytes; no effect for one of a record. `bytes` is never empty.
void edit_bytes(const Edit& edit, std::vector<std::byte>& bytes);

/// Changes a record as another chunk could code it, which reaches records that random bytes hardly
/// produce; `place` / 64, below 1024, is the new number, possibly one that no chunk codes. No
/// effect for an edit of bytes.
void edit_record(const Edit& edit, const ModelCounts& counts, CodedRecord& record);

} // namespace tactus::fuzz
