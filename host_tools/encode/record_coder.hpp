// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/base_mesh.hpp"
#include "rt_core/spm/coded_record.hpp"
#include "rt_core/spm/header.hpp"
#include "rt_core/spm/star_resolver.hpp"

#include <span>

namespace tactus
{

/// Lookup for StarResolver in which every record of the model is linked.
struct AllStars
{
    std::span<const VsplitRecord> records;
    std::span<const StarRing> rings;

    [[nodiscard]] LinkedStar find(RecordId id) const noexcept
    {
        return {&records[id.value], &rings[id.value], id};
    }
};

/// Expresses records relative to others; the inverse of StarResolver.
///
/// Any fan face may be the anchor; the one with the least estimated size is chosen. Only
/// `extent_quanta` and `max_depth` of `fields` are used. The viewed data must outlive the coder.
/// One thread at a time.
class RecordCoder
{
public:
    RecordCoder(const AllStars& stars, const ModelCounts& counts, const BaseView& base,
                const HeaderFields& fields, float quantum_m);

    /// Returns the coded form of a record; asserts that it resolves to the same record.
    [[nodiscard]] CodedRecord code(RecordId id);

private:
    [[nodiscard]] CodedRecord fan_from(RecordId id, std::uint32_t anchor);
    [[nodiscard]] CodedRecord::Owner other_owner(RecordId id, std::uint32_t fan_place,
                                                 VertexId from, VertexId to);
    void meet(FaceState state);
    void add_numbers(RecordId id, CodedRecord& coded);

    const AllStars& stars_;
    ModelCounts counts_;
    BaseView base_;
    StarResolver<AllStars> resolver_;
};

} // namespace tactus
