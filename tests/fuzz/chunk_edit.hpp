// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/coded_record.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus::fuzz
{

/// One change of a chunk, of its bytes or of a record that was parsed from it.
struct Edit
{
    enum Kind : std::uint32_t
    {
        set_byte,
        flip_bit,
        cut,
        insert_byte,
        set_anchor, ///< From here on of records.
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

/// No effect when it is of a record. `bytes` is never empty, before and after.
void edit_bytes(const Edit& edit, std::vector<std::byte>& bytes);

/// Changes a record as another chunk could say it, which reaches records that random bytes of a
/// chunk hardly ever spell; `place` / 64, below 1024, is the number to put there. It may still be
/// one that no chunk says. No effect when it is of bytes.
void edit_record(const Edit& edit, const ModelCounts& counts, CodedRecord& record);

} // namespace tactus::fuzz
