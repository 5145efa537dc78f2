// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/fuzz/record_laws.hpp"

#include "rt_core/spm/coded_record.hpp"
#include "tests/fuzz/model_laws.hpp"

#include <algorithm>
#include <cstring>
#include <span>

namespace tactus::fuzz
{

namespace
{

bool has_lawful_star(const ModelCounts& counts, RecordId id, const VsplitRecord& record)
{
    const std::uint32_t first_face = counts.base_faces + 2 * id.value;
    for (std::uint32_t side = 0; side < 2; ++side)
    {
        if (record.has_face(side) && record.star[side].value != first_face + side)
        {
            return false;
        }
    }
    if (record.fan_size < 1 || record.fan_size > 6)
    {
        return false;
    }
    for (std::uint32_t i = 0; i < record.fan_size; ++i)
    {
        const FaceId face = record.star[2 + i];
        const FaceState before = record.before[i];
        const auto fan = std::span(record.star).subspan(2, record.fan_size);
        const bool is_possible =
            before.is_base() ? face.value < counts.base_faces
                             : before.record().value < counts.records && before.record() != id;
        if (face.value >= counts.base_faces + 2 * counts.records || !is_possible ||
            std::ranges::count(fan, face) != 1)
        {
            return false;
        }
    }
    return true;
}

/// Exact faces and only those are never split.
bool has_lawful_next(const ModelCounts& counts, const VsplitRecord& record)
{
    for (std::uint32_t place = 0; place < 2U + record.fan_size; ++place)
    {
        const std::uint32_t next = record.next[place];
        const bool is_exact = record.error[place] == 0;
        if (!record.star[place].is_none() &&
            (is_exact ? next != kNextExact : next != kNextPending && next >= counts.records))
        {
            return false;
        }
    }
    return true;
}

bool is_lawful_owner(const ModelCounts& counts, RecordId id, const CodedRecord::Owner& owner)
{
    switch (owner.kind)
    {
    case CodedRecord::Owner::Kind::derived:
        return owner.value == 0;
    case CodedRecord::Owner::Kind::record:
        return owner.value < counts.records && owner.value != id.value;
    case CodedRecord::Owner::Kind::base:
        return owner.value < counts.base_faces;
    }
    return false;
}

/// True if there is an L with each error 0 or one of L, L - 2, ... L - 28, at least 1.
bool has_lawful_errors(const CodedRecord& record)
{
    const int largest = std::ranges::max(record.error);
    for (int top = std::max(largest, 1); top <= std::min(largest + 28, 255); ++top)
    {
        const auto is_step = [top](int error)
        {
            const bool is_below = error >= top - 28 && (top - error) % 2 == 0;
            return error == 0 || is_below || (error == 1 && top <= 28);
        };
        if (std::ranges::all_of(record.error, is_step))
        {
            return true;
        }
    }
    return false;
}

/// True if all fields that the grammar does not store are 0.
bool has_nothing_else(const CodedRecord& record)
{
    CodedRecord told;
    told.anchor = {record.anchor.value, record.anchor.kind, {}};
    told.place =
        record.anchor.kind == CodedRecord::Owner::Kind::base ? std::uint8_t{0} : record.place;
    told.corner = record.corner;
    told.left = record.left;
    told.right = record.right;
    told.sides = record.sides;
    told.residual = record.residual;
    for (std::size_t i = 0; i < std::size_t{0} + record.left + record.right; ++i)
    {
        told.others[i] = {record.others[i].value, record.others[i].kind, {}};
        told.error[2 + i] = record.error[2 + i];
    }
    const std::size_t last = std::size_t{2} + record.left + record.right;
    told.error[last] = record.error[last];
    for (std::uint32_t side = 0; side < 2; ++side)
    {
        if (((record.sides >> side) & 1U) != 0)
        {
            told.error[side] = record.error[side];
            told.bucket_step[side] = record.bucket_step[side];
        }
    }
    return std::memcmp(&told, &record, sizeof(told)) == 0;
}

bool is_lawful_coded(const ModelCounts& counts, RecordId id, const CodedRecord& record)
{
    const bool has_fan = record.left + record.right <= 5;
    return has_fan && record.anchor.kind != CodedRecord::Owner::Kind::derived &&
           is_lawful_owner(counts, id, record.anchor) &&
           std::ranges::all_of(record.others, [&](const CodedRecord::Owner& owner)
                               { return is_lawful_owner(counts, id, owner); }) &&
           record.place <= 7 && record.corner <= 2 && is_in(record.sides, 0, 3) &&
           std::ranges::all_of(record.residual, [](std::int32_t residual)
                               { return is_in(residual, -134'217'728, 134'217'728); }) &&
           has_lawful_errors(record) && has_nothing_else(record);
}

bool is_cleared(const VsplitRecord& record)
{
    const VsplitRecord clear;
    return std::memcmp(&record, &clear, sizeof(record)) == 0;
}

} // namespace

bool is_lawful_parsed_page(const ModelHeader& header, ChunkId id, const Page& page)
{
    for (std::uint32_t place = 0; place < 64; ++place)
    {
        const RecordId record{id.value * 64 + place};
        const bool is_lawful =
            record.value < header.fields().records
                ? is_lawful_coded(header.counts(), record, coded_form(page.records[place]))
                : is_cleared(page.records[place]);
        if (!is_lawful)
        {
            return false;
        }
    }
    return true;
}

bool is_lawful_linked(const ModelHeader& header, RecordId id, const VsplitRecord& record)
{
    const ModelCounts counts = header.counts();
    return is_in(record.depth, 1, header.fields().max_depth) && record.reach != 0 &&
           record.parent.value < counts.base_vertices + counts.records &&
           record.parent.value != counts.base_vertices + id.value &&
           is_on_grid(header, record.position_m) && has_lawful_star(counts, id, record) &&
           has_lawful_next(counts, record);
}

} // namespace tactus::fuzz
