// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/fuzz/chunk_edit.hpp"

#include <algorithm>

namespace tactus::fuzz
{

namespace
{

/// Owner by the lowest bits of the edit's value: derived, base face or record.
CodedRecord::Owner owner_of(const Edit& edit, std::uint32_t number, const ModelCounts& counts)
{
    switch (edit.value % 4)
    {
    case 0:
        return {};
    case 1:
        return {number % counts.base_faces, CodedRecord::Owner::Kind::base, {}};
    default:
        return {number % counts.records, CodedRecord::Owner::Kind::record, {}};
    }
}

/// Error that can be coded beside the record's largest one.
ErrorCode error_beside(const CodedRecord& record, const Edit& edit)
{
    const ErrorCode largest = std::max(ErrorCode{1}, std::ranges::max(record.error));
    const std::uint32_t below = 2 * (edit.value / 8 % 16);
    return static_cast<ErrorCode>(below == 30 ? 0U : largest > below ? largest - below : 1U);
}

/// Clears the fields that a chunk does not store for a record with this fan and these sides.
void clear_the_rest(CodedRecord& record)
{
    const std::uint32_t fan = record.fan_size();
    std::fill(record.others.begin() + (fan - 1), record.others.end(), CodedRecord::Owner{});
    std::fill(record.error.begin() + (2 + fan), record.error.end(), ErrorCode{0});
    for (std::uint32_t side = 0; side < 2; ++side)
    {
        record.error[side] = record.has_face(side) ? record.error[side] : ErrorCode{0};
        record.bucket_step[side] = record.has_face(side) ? record.bucket_step[side] : 0;
    }
}

} // namespace

void edit_bytes(const Edit& edit, std::vector<std::byte>& bytes)
{
    const auto at = bytes.begin() + static_cast<std::ptrdiff_t>(edit.place % bytes.size());
    switch (edit.kind)
    {
    case Edit::set_byte:
        *at = static_cast<std::byte>(edit.value);
        break;
    case Edit::flip_bit:
        *at ^= static_cast<std::byte>(1U << (edit.value % 8));
        break;
    case Edit::cut:
        bytes.erase(at + 1, bytes.end()); // One byte stays for the following edits.
        break;
    case Edit::insert_byte:
        bytes.insert(at, static_cast<std::byte>(edit.value));
        break;
    default:
        break;
    }
}

void edit_record(const Edit& edit, const ModelCounts& counts, CodedRecord& record)
{
    const std::uint32_t value = edit.value;
    const std::uint32_t number = edit.place / 64;
    const std::int32_t step = static_cast<std::int32_t>(number) - 512;
    switch (edit.kind)
    {
    case Edit::set_anchor:
        record.anchor = owner_of(edit, number, counts);
        record.place = value % 4 == 1 ? std::uint8_t{0} : record.place;
        break;
    case Edit::set_place:
        record.place = static_cast<std::uint8_t>(value % 8);
        record.corner = static_cast<std::uint8_t>(value / 8 % 3);
        break;
    case Edit::set_fan:
        record.left = static_cast<std::uint8_t>(value % 6);
        record.right = static_cast<std::uint8_t>(value / 6 % (6U - record.left));
        record.sides = static_cast<std::uint8_t>(value / 36 % 4);
        break;
    case Edit::set_other:
        record.others[value / 4 % 5] = owner_of(edit, number, counts);
        break;
    case Edit::set_residual:
        record.residual[value % 3] = step * (1 << (value / 3 % 19));
        break;
    case Edit::set_error:
        record.error[value % 8] = error_beside(record, edit);
        break;
    case Edit::set_bucket:
        record.bucket_step[value % 2] = step * (1 << (value / 2 % 22));
        break;
    default:
        return;
    }
    clear_the_rest(record);
}

} // namespace tactus::fuzz
