// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/base_mesh.hpp"
#include "rt_core/spm/coded_record.hpp"
#include "rt_core/spm/ring_prediction.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>

namespace tactus
{

/// The vertices round v besides u: w0 .. wk of a record's star.
struct StarRing
{
    std::array<VertexId, kMaxFanFaces + 1> w{};
};

/// A record that is linked, with its ring.
struct LinkedStar
{
    const VsplitRecord* record{nullptr}; ///< Null if it isn't linked.
    const StarRing* ring{nullptr};
    RecordId id{};
};

/// Makes a VsplitRecord of a CodedRecord and the linked records that it depends on.
///
/// The record that last changed a face is always one of the face's corners, the finest of them. So
/// a fan is walked from its anchor: the next face over an edge is searched in the stars of that
/// edge's two vertices and of the owners found so far; a chunk names it only if the deepest of
/// these isn't the right one. Vertices of a star, and the records that brought its faces, are among
/// a record's dependencies, so a record can be resolved with its dependencies alone.
///
/// `Lookup` has `LinkedStar find(RecordId) const`, for records of the model. Bounded by the star's
/// size; whole numbers except one root. Source: docs/internals/spm-format.md, section 6.
template <typename Lookup>
class StarResolver
{
public:
    enum class Outcome : std::uint8_t
    {
        resolved,
        waits, ///< The record missing() is not linked.
        refused
    };

    StarResolver(const Lookup& lookup, const ModelCounts& counts, const BaseView& base,
                 const HeaderFields& fields, float quantum_m) noexcept
        : lookup_(lookup), counts_(counts), base_(base), fields_(fields), quantum_m_(quantum_m)
    {
    }

    [[nodiscard]] Outcome resolve(RecordId id, const CodedRecord& coded) noexcept
    {
        record_ = VsplitRecord{};
        ring_ = StarRing{};
        owner_count_ = 0;
        missing_ = RecordId{};
        const bool is_done = place_anchor(coded) && walk(coded) && lay_out(id, coded) &&
                             place_vertex(coded) && place_buckets(coded);
        return is_done ? Outcome::resolved : missing_.is_none() ? Outcome::refused : Outcome::waits;
    }
    [[nodiscard]] const VsplitRecord& record() const noexcept { return record_; }
    [[nodiscard]] const StarRing& ring() const noexcept { return ring_; }
    [[nodiscard]] RecordId missing() const noexcept { return missing_; }

    /// Corners of the face at `place` of a star, v first, in canonical order.
    [[nodiscard]] std::array<VertexId, 3> corners(const LinkedStar& star,
                                                  std::uint32_t place) const noexcept
    {
        TACTUS_ASSERT(star.record != nullptr);
        TACTUS_ASSERT(place < star.record->star_end());
        const VertexId v = counts_.vertex_of(star.id);
        const auto& w = star.ring->w;
        if (place == 0)
        {
            return {v, star.record->parent, w[0]};
        }
        return place == 1 ? std::array{v, w[star.record->fan_size], star.record->parent}
                          : std::array{v, w[place - 2], w[place - 1]};
    }

    /// Place in the star of the face with the directed edge, or kNoPlace. If the fan closes (w0 =
    /// wk), fan faces come before A and B.
    [[nodiscard]] std::uint32_t place_with_edge(const LinkedStar& star, VertexId from,
                                                VertexId to) const noexcept
    {
        TACTUS_ASSERT(star.record != nullptr);
        const VsplitRecord& record = *star.record;
        const auto& w = star.ring->w;
        const VertexId v = counts_.vertex_of(star.id);
        const VertexId u = record.parent;
        for (std::uint32_t i = 0; i < record.fan_size; ++i)
        {
            const bool is_resident = from == v ? to == w[i]
                                     : to == v ? from == w[i + 1]
                                               : from == w[i] && to == w[i + 1];
            if (is_resident)
            {
                return 2 + i;
            }
        }
        if (record.has_face(0) && has_edge({v, u, w[0]}, from, to))
        {
            return 0;
        }
        if (record.has_face(1) && has_edge({v, w[record.fan_size], u}, from, to))
        {
            return 1;
        }
        return kNoPlace;
    }
    static constexpr std::uint32_t kNoPlace = 8;

    /// Finds the vertex's place on the grid; false if its record is missing.
    [[nodiscard]] bool find_position(VertexId vertex, GridPosition& position) noexcept
    {
        TACTUS_ASSERT(vertex.value < counts_.vertices());
        const Vec3f* at = nullptr;
        if (counts_.is_base(vertex))
        {
            at = &base_.positions_m[vertex.value];
        }
        else
        {
            const LinkedStar star = find(counts_.record_of(vertex));
            if (star.record == nullptr)
            {
                return false;
            }
            at = &star.record->position_m;
        }
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            // Exact: the quantum is a power of two and the multiple has at most 24 bits.
            position[axis] = static_cast<std::int32_t>((*at)[axis] / quantum_m_);
        }
        return true;
    }

    /// Finds the bucket of a face of the model; false if the record that brings it is missing.
    [[nodiscard]] bool find_bucket(FaceId face, std::uint32_t& bucket) noexcept
    {
        TACTUS_ASSERT(face.value < counts_.face_ids());
        if (counts_.is_base(face))
        {
            bucket = base_.faces[face.value].bucket;
            return true;
        }
        const std::uint32_t index = face.value - counts_.base_faces;
        const LinkedStar star = find({index / 2});
        bucket = star.record == nullptr ? 0 : star.record->bucket[index % 2];
        return star.record != nullptr;
    }

    /// Grid places of the last resolved record's ring, u first.
    [[nodiscard]] std::span<const GridPosition> ring_positions() const noexcept
    {
        return std::span(ring_positions_).first(record_.fan_size + 2U);
    }

    // The functions below are for the encoder, which tries several anchors.

    /// Starts a fan, with no owners found yet.
    void begin_fan() noexcept
    {
        owner_count_ = 0;
        missing_ = RecordId{};
    }
    void meet(const LinkedStar& owner) noexcept
    {
        TACTUS_ASSERT(owner_count_ < owners_.size());
        owners_[owner_count_++] = owner;
    }
    /// State of the face with the directed edge `from` -> `to`, as the walk derives it: that of the
    /// deepest known record; the base state if none has the edge.
    [[nodiscard]] FaceState derive(VertexId from, VertexId to) noexcept
    {
        FaceState best = FaceState::base();
        std::uint32_t best_depth = 0;
        const auto consider = [&](const LinkedStar& star)
        {
            if (star.record == nullptr || star.record->depth <= best_depth)
            {
                return;
            }
            if (const std::uint32_t place = place_with_edge(star, from, to); place != kNoPlace)
            {
                best = FaceState::after(star.id, place);
                best_depth = star.record->depth;
            }
        };
        for (const VertexId end : {from, to})
        {
            if (!counts_.is_base(end))
            {
                consider(find(counts_.record_of(end)));
            }
        }
        for (std::uint32_t i = 0; i < owner_count_; ++i)
        {
            consider(owners_[i]);
        }
        return best;
    }

private:
    using Owner = CodedRecord::Owner;

    [[nodiscard]] LinkedStar find(RecordId id) noexcept
    {
        TACTUS_ASSERT(id.value < counts_.records);
        const LinkedStar star = lookup_.find(id);
        if (star.record == nullptr && missing_.is_none())
        {
            missing_ = id;
        }
        return star;
    }

    [[nodiscard]] static bool has_face(const LinkedStar& star, std::uint32_t place) noexcept
    {
        return place < star.record->star_end() && !star.record->star[place].is_none();
    }
    [[nodiscard]] static bool has_edge(const std::array<VertexId, 3>& corners, VertexId from,
                                       VertexId to) noexcept
    {
        return (corners[0] == from && corners[1] == to) ||
               (corners[1] == from && corners[2] == to) || (corners[2] == from && corners[0] == to);
    }
    [[nodiscard]] static VertexId opposite(const std::array<VertexId, 3>& corners, VertexId from,
                                           VertexId to) noexcept
    {
        const auto third = std::find_if(corners.begin(), corners.end(),
                                        [&](VertexId c) { return c != from && c != to; });
        return third == corners.end() ? VertexId{} : *third;
    }

    /// Puts a base face in its base state into the fan.
    void take(std::uint32_t fan_place, FaceId face) noexcept
    {
        TACTUS_ASSERT(fan_place < kMaxFanFaces);
        record_.star[2 + fan_place] = face;
        record_.before[fan_place] = FaceState::base();
        fan_owners_[fan_place] = LinkedStar{};
    }
    /// Puts the face at a place of its owner's star into the fan.
    void take(std::uint32_t fan_place, const LinkedStar& owner, std::uint32_t place) noexcept
    {
        TACTUS_ASSERT(fan_place < kMaxFanFaces);
        TACTUS_ASSERT(owner.record != nullptr);
        record_.star[2 + fan_place] = owner.record->star[place];
        record_.before[fan_place] = FaceState::after(owner.id, place);
        fan_owners_[fan_place] = owner;
        meet(owner);
    }

    [[nodiscard]] bool place_anchor(const CodedRecord& coded) noexcept
    {
        TACTUS_ASSERT(coded.fan_size() <= kMaxFanFaces);
        TACTUS_ASSERT(coded.corner < 3);
        record_.fan_size = static_cast<std::uint8_t>(coded.fan_size());
        std::array<VertexId, 3> anchor{};
        if (coded.anchor.kind == Owner::Kind::base)
        {
            anchor = base_.faces[coded.anchor.value].corners;
            take(coded.left, FaceId{coded.anchor.value});
        }
        else
        {
            const LinkedStar star = find({coded.anchor.value});
            if (star.record == nullptr || !has_face(star, coded.place))
            {
                return false;
            }
            anchor = corners(star, coded.place);
            take(coded.left, star, coded.place);
        }
        record_.parent = anchor[coded.corner];
        ring_.w[coded.left] = anchor[(coded.corner + 1U) % 3];
        ring_.w[coded.left + 1U] = anchor[(coded.corner + 2U) % 3];
        return true;
    }

    [[nodiscard]] bool walk(const CodedRecord& coded) noexcept
    {
        const VertexId u = record_.parent;
        std::uint32_t i = 0;
        for (std::uint32_t place = coded.left + 1U; place < coded.fan_size(); ++place, ++i)
        {
            if (!step(coded.others[i], place, u, ring_.w[place], ring_.w[place + 1]))
            {
                return false;
            }
        }
        for (std::uint32_t place = coded.left; place-- > 0; ++i)
        {
            if (!step(coded.others[i], place, ring_.w[place + 1], u, ring_.w[place]))
            {
                return false;
            }
        }
        return true;
    }

    /// Crosses the directed edge from -> to into the next face, whose third corner is `third`.
    [[nodiscard]] bool step(const Owner& owner, std::uint32_t fan_place, VertexId from, VertexId to,
                            VertexId& third) noexcept
    {
        if (owner.kind == Owner::Kind::base)
        {
            const auto& corners = base_.faces[owner.value].corners;
            if (!has_edge(corners, from, to))
            {
                return false;
            }
            take(fan_place, FaceId{owner.value});
            third = opposite(corners, from, to);
            return true;
        }
        FaceState state = FaceState::base();
        if (owner.kind == Owner::Kind::derived)
        {
            state = derive(from, to);
        }
        else if (const LinkedStar star = find({owner.value}); star.record != nullptr)
        {
            const std::uint32_t place = place_with_edge(star, from, to);
            state = place == kNoPlace ? state : FaceState::after(star.id, place);
        }
        if (state.is_base() || !missing_.is_none())
        {
            return false;
        }
        const LinkedStar star = find(state.record());
        take(fan_place, star, state.place());
        third = opposite(corners(star, state.place()), from, to);
        return true;
    }

    [[nodiscard]] bool lay_out(RecordId id, const CodedRecord& coded) noexcept
    {
        std::uint32_t depth = 0;
        for (std::uint32_t i = 0; i < record_.fan_size; ++i)
        {
            const std::span<const FaceId> earlier = std::span(record_.star).subspan(2, i);
            if (std::ranges::find(earlier, record_.star[2 + i]) != earlier.end())
            {
                return false;
            }
            const VsplitRecord* owner = fan_owners_[i].record;
            depth = std::max<std::uint32_t>(depth, owner == nullptr ? 0U : owner->depth);
        }
        if (depth + 1 > fields_.max_depth)
        {
            return false;
        }
        record_.depth = static_cast<std::uint16_t>(depth + 1);
        record_.error = coded.error;
        for (std::uint32_t side = 0; side < 2; ++side)
        {
            record_.star[side] = coded.has_face(side) ? counts_.face_of(id, side) : FaceId{};
        }
        for (std::uint32_t place = 0; place < record_.star_end(); ++place)
        {
            if (!record_.star[place].is_none())
            {
                record_.next[place] = record_.error[place] == 0 ? kNextExact : kNextPending;
            }
        }
        return true;
    }

    [[nodiscard]] bool place_vertex(const CodedRecord& coded) noexcept
    {
        if (!find_position(record_.parent, ring_positions_[0]))
        {
            return false;
        }
        for (std::uint32_t i = 0; i <= record_.fan_size; ++i)
        {
            if (!find_position(ring_.w[i], ring_positions_[i + 1]))
            {
                return false;
            }
        }
        const GridPosition v = RingPrediction(ring_positions()).position_of(coded.residual);
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            if (v[axis] < 0 || std::cmp_greater(v[axis], fields_.extent_quanta[axis]))
            {
                return false;
            }
            record_.position_m[axis] = static_cast<float>(v[axis]) * quantum_m_;
        }
        record_.reach = star_reach(v, ring_positions(), largest_error());
        return true;
    }

    [[nodiscard]] ErrorCode largest_error() noexcept
    {
        ErrorCode largest = *std::ranges::max_element(record_.error);
        for (std::uint32_t i = 0; i < record_.fan_size; ++i)
        {
            const VsplitRecord* owner = fan_owners_[i].record;
            largest =
                std::max(largest, owner == nullptr ? base_.faces[record_.star[2 + i].value].error
                                                   : owner->error[record_.before[i].place()]);
        }
        return largest;
    }

    [[nodiscard]] bool place_buckets(const CodedRecord& coded) noexcept
    {
        std::uint32_t bucket = 0;
        if (!find_bucket(record_.star[2U + coded.left], bucket))
        {
            return false;
        }
        for (std::uint32_t side = 0; side < 2; ++side)
        {
            if (coded.has_face(side))
            {
                bucket += static_cast<std::uint32_t>(coded.bucket_step[side]);
                record_.bucket[side] = bucket;
            }
        }
        return true;
    }

    const Lookup& lookup_;
    ModelCounts counts_;
    BaseView base_;
    const HeaderFields& fields_;
    float quantum_m_;
    VsplitRecord record_;
    StarRing ring_;
    std::array<GridPosition, kMaxFanFaces + 2> ring_positions_{};
    std::array<LinkedStar, kMaxFanFaces> owners_{};     ///< Owners found, without base faces.
    std::array<LinkedStar, kMaxFanFaces> fan_owners_{}; ///< Fan places; null for base faces.
    std::uint32_t owner_count_{0};
    RecordId missing_{};
};

} // namespace tactus
