// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/record_coder.hpp"

#include "rt_core/base/assert.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace tactus
{

namespace
{

using Owner = CodedRecord::Owner;

Owner owner_of(FaceId face, FaceState state)
{
    return state.is_base() ? Owner{face.value, Owner::Kind::base, {}}
                           : Owner{state.record().value, Owner::Kind::record, {}};
}

/// Estimated size of a coded owner, in bits; the true size depends on the statistics of the chunk.
std::uint32_t cost_of(const Owner& owner, RecordId id)
{
    if (owner.kind == Owner::Kind::derived)
    {
        return 1;
    }
    const std::uint32_t way =
        owner.value < id.value ? id.value - owner.value : owner.value - id.value;
    const auto width = static_cast<std::uint32_t>(std::bit_width(way));
    // At most 12 bits: distant owners are in coarser tiers, coded relative to the last owner named
    // there.
    return owner.kind == Owner::Kind::base ? 12 : 4 + std::min(width, 8U);
}

std::uint32_t cost_of(const CodedRecord& coded, RecordId id)
{
    std::uint32_t cost = cost_of(coded.anchor, id);
    for (std::uint32_t i = 0; i + 1 < coded.fan_size(); ++i)
    {
        cost += cost_of(coded.others[i], id);
    }
    return cost;
}

} // namespace

RecordCoder::RecordCoder(const AllStars& stars, const ModelCounts& counts, const BaseView& base,
                         const HeaderFields& fields, float quantum_m)
    : stars_(stars), counts_(counts), base_(base), resolver_(stars, counts, base, fields, quantum_m)
{
}

CodedRecord RecordCoder::code(RecordId id)
{
    const VsplitRecord& record = stars_.records[id.value];
    CodedRecord best = fan_from(id, 0);
    for (std::uint32_t anchor = 1; anchor < record.fan_size; ++anchor)
    {
        const CodedRecord coded = fan_from(id, anchor);
        best = cost_of(coded, id) < cost_of(best, id) ? coded : best;
    }
    add_numbers(id, best);
    const auto outcome = resolver_.resolve(id, best);
    TACTUS_ASSERT(outcome == StarResolver<AllStars>::Outcome::resolved);
    TACTUS_ASSERT(std::memcmp(&resolver_.record(), &record, sizeof(record)) == 0);
    return best;
}

CodedRecord RecordCoder::fan_from(RecordId id, std::uint32_t anchor)
{
    const VsplitRecord& record = stars_.records[id.value];
    const StarRing& ring = stars_.rings[id.value];
    const VertexId u = record.parent;
    const FaceId face = record.star[2 + anchor];
    const FaceState state = record.before[anchor];
    CodedRecord coded;
    coded.anchor = owner_of(face, state);
    coded.place = static_cast<std::uint8_t>(state.is_base() ? 0 : state.place());
    const std::array<VertexId, 3> corners =
        state.is_base() ? base_.faces[face.value].corners
                        : resolver_.corners(stars_.find(state.record()), state.place());
    coded.corner = static_cast<std::uint8_t>(std::ranges::find(corners, u) - corners.begin());
    coded.left = static_cast<std::uint8_t>(anchor);
    coded.right = static_cast<std::uint8_t>(record.fan_size - 1U - anchor);
    coded.sides =
        static_cast<std::uint8_t>((record.has_face(0) ? 1U : 0U) | (record.has_face(1) ? 2U : 0U));
    resolver_.begin_fan();
    meet(state);
    std::size_t next = 0;
    for (std::uint32_t place = anchor + 1; place < record.fan_size; ++place)
    {
        coded.others[next++] = other_owner(id, place, u, ring.w[place]);
    }
    for (std::uint32_t place = anchor; place-- > 0;)
    {
        coded.others[next++] = other_owner(id, place, ring.w[place + 1], u);
    }
    return coded;
}

CodedRecord::Owner RecordCoder::other_owner(RecordId id, std::uint32_t fan_place, VertexId from,
                                            VertexId to)
{
    const VsplitRecord& record = stars_.records[id.value];
    const FaceState state = record.before[fan_place];
    const bool is_derived = !state.is_base() && resolver_.derive(from, to) == state;
    meet(state);
    return is_derived ? Owner{} : owner_of(record.star[2 + fan_place], state);
}

void RecordCoder::meet(FaceState state)
{
    if (!state.is_base())
    {
        resolver_.meet(stars_.find(state.record()));
    }
}

void RecordCoder::add_numbers(RecordId id, CodedRecord& coded)
{
    const VsplitRecord& record = stars_.records[id.value];
    coded.error = record.error;
    std::array<GridPosition, kMaxFanFaces + 2> ring{};
    GridPosition v{};
    bool all_found = resolver_.find_position(counts_.vertex_of(id), v) &&
                     resolver_.find_position(record.parent, ring[0]);
    for (std::uint32_t i = 0; i <= record.fan_size; ++i)
    {
        all_found = all_found && resolver_.find_position(stars_.rings[id.value].w[i], ring[i + 1]);
    }
    std::uint32_t bucket = 0;
    all_found = all_found && resolver_.find_bucket(record.star[2U + coded.left], bucket);
    TACTUS_ASSERT(all_found);
    coded.residual = RingPrediction(std::span(ring).first(record.fan_size + 2U)).residual_of(v);
    for (std::uint32_t side = 0; side < 2; ++side)
    {
        if (coded.has_face(side))
        {
            coded.bucket_step[side] = static_cast<std::int32_t>(record.bucket[side] - bucket);
            bucket = record.bucket[side];
        }
    }
}

} // namespace tactus
